#include "meshes.h"

#include "mesh/cells.h"
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

Mesh ball_of_shells(const std::vector<double>& radii, const std::function<int(int shell)>& region) {
    const int m = static_cast<int>(radii.size()) - 1;
    const auto place = [&](int i, int j, int k) {
        const Vec3 p{1.0 * (i - m), 1.0 * (j - m), 1.0 * (k - m)};
        const int shell = std::max({std::abs(i - m), std::abs(j - m), std::abs(k - m)});
        return shell == 0 ? Vec3{} : radii[static_cast<std::size_t>(shell)] * normalised(p);
    };
    const auto ring = [m](int i) { return i < m ? m - 1 - i : i - m; };
    return cube_grid(2 * m, 2 * m, 2 * m, place, [&](int i, int j, int k) {
        return region(std::max({ring(i), ring(j), ring(k)}));
    });
}

Array<Vertex, char> vertices_of(const Mesh& mesh, Region region) {
    Array<Vertex, char> of_region(mesh.position.size(), 0);
    for (Tet t : mesh.tets.indices()) {
        if (mesh.region[t] != region) continue;
        for (Vertex v : mesh.tets[t]) of_region[v] = 1;
    }
    return of_region;
}

double l2_error(const Mesh& mesh, const NodalField& field, const std::function<double(const Vec3&)>& exact) {
    const double near = 0.5854101966249685, far = 0.1381966011250105;  // (5 + 3 sqrt 5)/20, (5 - sqrt 5)/20
    double sum = 0;
    for (Tet t : mesh.tets.indices()) {
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
