#include "meshes.h"

#include <kropla/mesh/cells.h>
#include "simulate/elements.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

struct Grid {
    std::array<int, 3> n;

    Vertex vertex(const std::array<int, 3>& at) const {
        return Vertex((at[2] * (n[1] + 1) + at[1]) * (n[0] + 1) + at[0]);
    }
    std::array<int, 3> at(Vertex v) const {
        const int row = v.value / (n[0] + 1);
        return {v.value % (n[0] + 1), row % (n[1] + 1), row / (n[1] + 1)};
    }
};

/// The tets of a cube: from the corner nearest to the grid's middle along the axes, in each of the six
/// orders.
void add_cube(const Grid& grid, const std::array<int, 3>& cube, const Array<Vertex, Vec3>& position,
              Array<Tet, std::array<Vertex, 4>>& tets) {
    for (const auto& order : orders) {
        std::array<int, 3> corner, step;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool upper = 2 * cube[axis] + 1 >= grid.n[axis];
            corner[axis] = cube[axis] + (upper ? 0 : 1);
            step[axis] = upper ? 1 : -1;
        }
        std::array<Vertex, 4> tet = {grid.vertex(corner)};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<std::size_t>(order[k]);
            corner[axis] += step[axis];
            tet[k + 1] = grid.vertex(corner);
        }
        const Corners<4> x = {position[tet[0]], position[tet[1]], position[tet[2]], position[tet[3]]};
        if (linear_tet(x).volume < 0) std::swap(tet[2], tet[3]);
        tets.push_back(tet);
    }
}

/// The face of the grid that a facet lies on, or -1.
int face_of(const Grid& grid, const std::array<Vertex, 3>& facet) {
    for (int face = 0; face < 6; ++face) {
        const auto axis = static_cast<std::size_t>(face / 2);
        const int plane = face % 2 == 0 ? 0 : grid.n[axis];
        if (std::ranges::all_of(facet, [&](Vertex v) { return grid.at(v)[axis] == plane; })) return face;
    }
    return -1;
}

std::vector<BoundaryFacet> faces(const Grid& grid, const Array<Tet, std::array<Vertex, 4>>& tets) {
    std::vector<BoundaryFacet> boundary;
    for (const auto& tet : tets) {
        for (const auto& f : tet_facets) {
            const std::array<Vertex, 3> facet = {tet[static_cast<std::size_t>(f[0])],
                                                 tet[static_cast<std::size_t>(f[1])],
                                                 tet[static_cast<std::size_t>(f[2])]};
            if (const int face = face_of(grid, facet); face >= 0) boundary.push_back({facet, Patch(face)});
        }
    }
    return boundary;
}

/// A mesh whose body's surface was opened: the tets of the body have vertices of their own there.
struct Opened {
    Array<Vertex, Vec3> position;
    Array<Tet, std::array<Vertex, 4>> tets;
    std::vector<Vertex> outer, inner;           // per column
    std::vector<std::array<int, 3>> triangles;  // columns, normals out of the body

    /// The old boundary and the two sides of the gap.
    std::vector<BoundaryFacet> boundary(const Mesh& before, bool outside) const {
        const Layer layer(before.layers.size());
        std::vector<BoundaryFacet> facets;
        for (Tet t : before.tets.indices())
            for (std::size_t corner = 0; corner < 4; ++corner)
                if (before.patch[t][corner].exists())
                    facets.push_back({facet_vertices({t, corner}), before.patch[t][corner]});
        for (const auto& [a, b, c] : triangles) {
            const auto of = [a, b, c](const std::vector<Vertex>& side) {
                return std::array{side[std::size_t(a)], side[std::size_t(b)], side[std::size_t(c)]};
            };
            facets.push_back({of(outer), outside ? shell_patch(layer) : wall_patch(layer)});
            facets.push_back({of(inner), outside ? wall_patch(layer) : shell_patch(layer)});
        }
        return facets;
    }
    std::array<Vertex, 3> facet_vertices(std::pair<Tet, std::size_t> facet) const {
        const auto& [i, j, k] = tet_facets[facet.second];
        const auto& v = tets[facet.first];
        return {v[std::size_t(i)], v[std::size_t(j)], v[std::size_t(k)]};
    }
};

Opened open_surface(const Mesh& mesh, Region body, const Vec3& middle, double depth) {
    Opened opened{mesh.position, mesh.tets, {}, {}, {}};
    const auto of_body = vertices_of(mesh, body);
    Array<Vertex, int> column(mesh.position.size(), -1);
    const auto shrunk = [&](const Vec3& x) { return middle + (1 - depth) * (x - middle); };
    for (const auto& facet : region_surface(mesh, body).interface) {
        std::array<int, 3> triangle = {};
        for (std::size_t k = 0; k < 3; ++k) {
            if (column[facet[k]] < 0) {
                column[facet[k]] = static_cast<int>(opened.outer.size());
                opened.outer.push_back(facet[k]);
                opened.inner.push_back(opened.position.push_back(shrunk(mesh.position[facet[k]])));
            }
            triangle[k] = column[facet[k]];
        }
        opened.triangles.push_back(triangle);
    }
    for (Vertex v : mesh.position.indices())
        if (of_body[v] && column[v] < 0) opened.position[v] = shrunk(mesh.position[v]);
    for (Tet t : mesh.tets.indices())
        for (Vertex& v : opened.tets[t])
            if (mesh.region[t] == body && column[v] >= 0) v = opened.inner[std::size_t(column[v])];
    return opened;
}

}  // namespace

Mesh cube_grid(int nx, int ny, int nz, const Place& place, const RegionOfCube& region) {
    const Grid grid{{nx, ny, nz}};
    Array<Vertex, Vec3> position;
    for (int k = 0; k <= nz; ++k) {
        for (int j = 0; j <= ny; ++j) {
            for (int i = 0; i <= nx; ++i) position.push_back(place(i, j, k));
        }
    }
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> regions;
    for (int k = 0; k < nz; ++k) {
        for (int j = 0; j < ny; ++j) {
            for (int i = 0; i < nx; ++i) {
                if (region(i, j, k) < 0) continue;
                add_cube(grid, {i, j, k}, position, tets);
                regions.resize(tets.size(), Region(region(i, j, k)));
            }
        }
    }
    const auto boundary = faces(grid, tets);
    return make_mesh(std::move(position), std::move(tets), std::move(regions), boundary);
}

Mesh unit_cube(int n) {
    const auto place = [n](int i, int j, int k) { return Vec3{1.0 * i / n, 1.0 * j / n, 1.0 * k / n}; };
    return cube_grid(n, n, n, place, [](int, int, int) { return 0; });
}

Mesh unit_cube_with_body(int n) {
    const auto place = [n](int i, int j, int k) { return Vec3{1.0 * i / n, 1.0 * j / n, 1.0 * k / n}; };
    const auto inside = [n](int i) { return i >= n / 4 && i < n - n / 4; };
    return cube_grid(n, n, n, place,
                     [&](int i, int j, int k) { return inside(i) && inside(j) && inside(k) ? 1 : 0; });
}

Place on_spheres(std::vector<double> radii) {
    const int m = static_cast<int>(radii.size()) - 1;
    return [radii = std::move(radii), m](int i, int j, int k) {
        const Vec3 p{1.0 * (i - m), 1.0 * (j - m), 1.0 * (k - m)};
        const int shell = std::max({std::abs(i - m), std::abs(j - m), std::abs(k - m)});
        return shell == 0 ? Vec3{} : radii[static_cast<std::size_t>(shell)] * normalised(p);
    };
}

Mesh ball_of_shells(const std::vector<double>& radii, const std::function<int(int shell)>& region) {
    const int m = static_cast<int>(radii.size()) - 1;
    const Place place = on_spheres(radii);
    const auto ring = [m](int i) { return i < m ? m - 1 - i : i - m; };
    return cube_grid(2 * m, 2 * m, 2 * m, place, [&](int i, int j, int k) {
        return region(std::max({ring(i), ring(j), ring(k)}));
    });
}

Mesh with_layer(const Mesh& mesh, const Vec3& middle, Region of, int count, double depth) {
    const Region body{1};
    const bool outside = of != body;
    Opened opened = open_surface(mesh, body, middle, depth);
    PrismLayer layer{.region = of, .body = body, .count = count, .triangles = {}, .columns = {}};
    for (std::size_t c = 0; c < opened.outer.size(); ++c) {
        const Vec3 inner = opened.position[opened.inner[c]], outer = opened.position[opened.outer[c]];
        layer.columns.push_back(outside ? opened.inner[c] : opened.outer[c]);
        for (int k = 1; k < count; ++k) {
            const double s = 1.0 * k / count;
            layer.columns.push_back(opened.position.push_back(
                outside ? (1 - s) * inner + s * outer : (1 - s) * outer + s * inner));
        }
        layer.columns.push_back(outside ? opened.outer[c] : opened.inner[c]);
    }
    for (const auto& [a, b, c] : opened.triangles)
        layer.triangles.push_back(outside ? std::array{a, b, c} : std::array{a, c, b});
    Mesh result = make_mesh(opened.position, opened.tets, mesh.region, opened.boundary(mesh, outside));
    for (const PrismLayer& other : mesh.layers) add_layer(result, other);
    add_layer(result, layer);
    return result;
}

Array<Vertex, char> vertices_of(const Mesh& mesh, Region region) {
    Array<Vertex, char> of_region(mesh.position.size(), 0);
    for_each_cell(living_cells(mesh, region), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) of_region[v] = 1;
    });
    return of_region;
}

double l2_error(const Mesh& mesh, const NodalField& field, const std::function<double(const Vec3&)>& exact) {
    const double near = 0.5854101966249685, far = 0.1381966011250105;  // (5 + 3 sqrt 5)/20, (5 - sqrt 5)/20
    const Cells cells = living_cells(mesh);
    double sum = 0;
    for (Tet t : cells.tets) {
        const Corners<4> x = corners(mesh, t);
        for (std::size_t point = 0; point < 4; ++point) {
            Vec3 place;
            double value = 0;
            for (std::size_t i = 0; i < 4; ++i) {
                const double weight = i == point ? near : far;
                place += weight * x[i];
                value += weight * field.values[mesh.tets[t][i]];
            }
            const double error = value - exact(place);
            sum += linear_tet(x).volume / 4 * error * error;
        }
    }
    for (const Prism& prism : cells.prisms) {
        const Corners<6> x = corners(mesh, prism);
        const auto values = at_corners(field.values, cell_vertices(mesh, prism));
        const CellPoints<6> points = cell_points(x);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const double error = mean_value(k, values) - exact(mean_value(k, x));
            sum += points[k].volume * error * error;
        }
    }
    return std::sqrt(sum);
}

double largest_difference(const Mesh& mesh, const NodalField& field, double value) {
    double largest = 0;
    for (Vertex v : mesh.position.indices()) {
        if (alive(mesh, v)) largest = std::max(largest, std::abs(field.values[v] - value));
    }
    return largest;
}

}  // namespace kropla
