#include "mesh/meshes.h"

#include "base/random.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <map>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace kropla {
namespace {

using Corners = std::array<Vertex, 4>;

Corners corners(int a, int b, int c, int d) { return {Vertex(a), Vertex(b), Vertex(c), Vertex(d)}; }

Mesh mesh_of(Array<Vertex, Vec3> position, Array<Tet, Corners> tets,
             std::span<const BoundaryFacet> boundary = {}) {
    const Array<Tet, Region> region(tets.size(), surroundings);
    return make_mesh(std::move(position), std::move(tets), region, boundary);
}

/// Place i of n around the z axis, n >= 3, on the unit circle of the plane z = 0.
Vec3 on_circle(int i, int n) {
    const double angle = 2 * std::numbers::pi * i / n;
    return {std::cos(angle), std::sin(angle), 0};
}

Vec3 grid_point(int i, int j, int k, int n) { return Vec3{double(i), double(j), double(k)} / n; }

/// The patch of the unit cube's face that holds all three points; none if they lie on no common face.
Patch face_of_unit_cube(const Vec3& a, const Vec3& b, const Vec3& c) {
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            if (a[axis] == side && b[axis] == side && c[axis] == side) return Patch(2 * axis + side);
    return Patch{};
}

std::vector<BoundaryFacet> faces_of_unit_cube(const Array<Vertex, Vec3>& position,
                                              const Array<Tet, Corners>& tets) {
    std::vector<BoundaryFacet> facets;
    for (const Corners& v : tets)
        for (const auto& [a, b, c] : tet_facets) {
            const std::array<Vertex, 3> f = {v[std::size_t(a)], v[std::size_t(b)], v[std::size_t(c)]};
            const Patch patch = face_of_unit_cube(position[f[0]], position[f[1]], position[f[2]]);
            if (patch.exists()) facets.push_back({f, patch});
        }
    return facets;
}

}  // namespace

Mesh one_tet() {
    const std::vector<BoundaryFacet> facets = {{{Vertex(1), Vertex(2), Vertex(3)}, Patch(0)},
                                               {{Vertex(0), Vertex(2), Vertex(3)}, Patch(1)},
                                               {{Vertex(0), Vertex(1), Vertex(3)}, Patch(2)},
                                               {{Vertex(0), Vertex(1), Vertex(2)}, Patch(3)}};
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {corners(0, 1, 2, 3)}, facets);
}

Mesh regular_tet() {
    return mesh_of({{1, 1, 1}, {1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}}, {corners(0, 1, 2, 3)});
}

Mesh two_tets() {
    return mesh_of({{1, 0, 0}, {0, 1, 0}, {-1, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                   {corners(0, 1, 2, 3), corners(0, 2, 1, 4)});
}

Mesh shell_of_edge(int n) {
    Array<Vertex, Vec3> position = {{0, 0, -1}, {0, 0, 1}};
    Array<Tet, Corners> tets;
    for (int i = 0; i < n; ++i) {
        position.push_back(on_circle(i, n));
        tets.push_back(corners(0, 1, 2 + i, 2 + (i + 1) % n));
    }
    return mesh_of(std::move(position), std::move(tets));
}

Mesh open_shell_of_edge(int n) {
    Array<Vertex, Vec3> position = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}};
    Array<Tet, Corners> tets;
    std::vector<BoundaryFacet> facets = {{{Vertex(0), Vertex(1), Vertex(2)}, Patch(2)},
                                         {{Vertex(0), Vertex(1), Vertex(n + 2)}, Patch(2)}};
    for (int i = 0; i < n; ++i) {
        position.push_back(i + 1 < n ? on_circle(i + 1, 2 * n) : Vec3{-1, 0, 0});
        tets.push_back(corners(0, 1, 2 + i, 3 + i));
        facets.push_back({{Vertex(0), Vertex(2 + i), Vertex(3 + i)}, Patch(4)});
        facets.push_back({{Vertex(1), Vertex(2 + i), Vertex(3 + i)}, Patch(5)});
    }
    return mesh_of(std::move(position), std::move(tets), facets);
}

Mesh ball_of_vertex() {
    Array<Tet, Corners> tets;
    for (int x : {1, 2})
        for (int y : {3, 4})
            for (int z : {5, 6})
                tets.push_back((x + y + z) % 2 != 0 ? corners(0, x, y, z) : corners(0, y, x, z));
    return mesh_of({{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                   std::move(tets));
}

Mesh cube_of_tets(int n) {
    // the way from the least to the largest corner of a cube, along the axes in each order; `odd` ones turn
    // left
    struct Way {
        std::array<int, 3> axes;
        bool odd;
    };
    static constexpr Way ways[] = {{{0, 1, 2}, false}, {{1, 2, 0}, false}, {{2, 0, 1}, false},
                                   {{0, 2, 1}, true},  {{2, 1, 0}, true},  {{1, 0, 2}, true}};
    Array<Vertex, Vec3> position;
    Array<Tet, Corners> tets;
    const std::array<int, 3> step = {1, n + 1, (n + 1) * (n + 1)};
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const int a = position.push_back(grid_point(i, j, k, n)).value;
                if (i == n || j == n || k == n) continue;
                for (const auto& [axes, odd] : ways) {
                    const int b = a + step[std::size_t(axes[0])];
                    const int c = b + step[std::size_t(axes[1])];
                    const int d = c + step[std::size_t(axes[2])];
                    tets.push_back(odd ? corners(a, c, b, d) : corners(a, b, c, d));
                }
            }
    const auto facets = faces_of_unit_cube(position, tets);
    return mesh_of(std::move(position), std::move(tets), facets);
}

Mesh cube_in_cube(int n) {
    Mesh mesh = cube_of_tets(n);
    for (Tet t : mesh.tets.indices()) {
        Vec3 centre;
        for (Vertex v : mesh.tets[t]) centre += mesh.position[v] / 4;
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis) inside &= centre[axis] > 1.0 / n && centre[axis] < 1 - 1.0 / n;
        if (inside) mesh.region[t] = Region(1);
    }
    return mesh;
}

namespace {

/// The facets of the body's tets towards the surroundings, their normals out of the body.
std::vector<std::array<Vertex, 3>> interface_facets(const Mesh& mesh) {
    std::vector<std::array<Vertex, 3>> facets;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[t][static_cast<std::size_t>(i)];
            if (mesh.region[t] == Region(1) && mesh.region[n] == surroundings)
                facets.push_back(facet_vertices(mesh, {t, i}));
        }
    return facets;
}

std::vector<BoundaryFacet> boundary_facets(const Mesh& mesh) {
    std::vector<BoundaryFacet> facets;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i)
            if (const Patch patch = mesh.patch[t][static_cast<std::size_t>(i)]; patch.exists())
                facets.push_back({facet_vertices(mesh, {t, i}), patch});
    return facets;
}

/// Columns from a copy of each of the grid's vertices on the interface, half as far from the centre, to that
/// vertex.
PrismLayer columns_on(Array<Vertex, Vec3>& position, std::span<const std::array<Vertex, 3>> facets,
                      int count) {
    const Vec3 centre = {0.5, 0.5, 0.5};
    PrismLayer layer{surroundings, Region(1), count, {}, {}};
    std::map<Vertex, int> column;
    for (const auto& facet : facets) {
        for (Vertex v : facet) {
            if (!column.emplace(v, static_cast<int>(column.size())).second) continue;
            const Vec3 out = position[v] - centre;
            for (int k = 0; k < count; ++k)
                layer.columns.push_back(position.push_back(centre + (0.5 + 0.5 * k / count) * out));
            layer.columns.push_back(v);
        }
        layer.triangles.push_back({column[facet[0]], column[facet[1]], column[facet[2]]});
    }
    return layer;
}

}  // namespace

Mesh layered_cube(int count) {
    const Mesh grid = cube_in_cube(3);
    const auto facets = interface_facets(grid);
    auto boundary = boundary_facets(grid);
    auto position = grid.position;
    auto tets = grid.tets;
    const PrismLayer layer = columns_on(position, facets, count);
    Array<Vertex, Vertex> wall_below(position.size());
    for (int column = 0; column < count_columns(layer); ++column)
        wall_below[column_vertex(layer, column, count)] = column_vertex(layer, column, 0);
    for (Tet t : tets.indices())
        for (Vertex& v : tets[t])
            if (grid.region[t] == Region(1)) v = wall_below[v];
    for (const auto& [a, b, c] : facets) {
        boundary.push_back({{a, b, c}, shell_patch(Layer(0))});
        boundary.push_back({{wall_below[a], wall_below[b], wall_below[c]}, wall_patch(Layer(0))});
    }
    Mesh mesh = make_mesh(position, tets, grid.region, boundary);
    add_layer(mesh, layer);
    return mesh;
}

void jiggle(Mesh& mesh, double amount, std::uint64_t seed) {
    Random random{seed};
    for (Vertex v : mesh.position.indices()) {
        if (!alive(mesh, v) || constraint(mesh, v, ball(mesh, v)).patches != 0) continue;
        for (int axis = 0; axis < 3; ++axis) mesh.position[v][axis] += random.uniform(-amount, amount);
    }
}

}  // namespace kropla
