// A mesh from elsewhere, a cube in a cylinder, with the cube moved along the axis and turned a little: prints for each
// step how many cells there are, how bad the worst is (R/r: 3 is perfect) and how many the step touched.
#include <kropla/domain/of_mesh.h>
#include <kropla/mesh/quality.h>
#include <kropla/step/advance.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <map>

using namespace kropla;

constexpr int rings = 4, layers = 14;                     // of cells: around the axis, the first in the cube; along it
constexpr double half = 0.25, radius = 1, height = 0.25;  // [m] of the cube; of the cylinder; of a layer

/// A square grid, straight in the cube, whose outline becomes a circle outwards.
Vec3 place(int i, int j, int k) {
    const int ring = std::max({std::abs(i), std::abs(j), 1});
    const double x = double(i) / ring, y = double(j) / ring, out = double(ring - 1) / (rings - 1);
    const double factor = (1 - out) * half + out * radius / std::max(std::hypot(x, y), half);
    return {factor * x, factor * y, height * k};
}

/// The mesh, of plain arrays as mesh generators give them: vertices, cells and their regions (0 around the body, which
/// is 1), triangles of the boundary and their patches (4, 5: planes, z min and z max; 6 stays as it is).
Mesh cube_in_a_cylinder() {
    constexpr int width = 2 * rings + 1, up = width * width;
    Array<Vertex, Vec3> vertices;
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> regions;
    std::map<std::array<Vertex, 3>, int> cells_at;  // a triangle
    for (int n = 0; n < up * (layers + 1); ++n)
        vertices.push_back(place(n % width - rings, n / width % width - rings, n / up));
    const auto add_tet = [&](std::array<Vertex, 4> t, bool in_cube) {
        for (auto f : {std::array{t[0], t[1], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[3]}, {t[1], t[2], t[3]}})
            ++cells_at[f];
        const Vec3& a = vertices[t[0]];
        if (determinant(vertices[t[1]] - a, vertices[t[2]] - a, vertices[t[3]] - a) < 0) std::swap(t[0], t[1]);
        tets.push_back(t);
        regions.push_back(Region(in_cube ? 1 : 0));
    };
    for (int n = 0; n < up * layers; ++n) {
        const int i = n % width - rings, j = n / width % width - rings, k = n / up;
        if (i == rings || j == rings) continue;
        const bool in_cube = std::max({-i, i + 1, -j, j + 1}) == 1 && k >= 10 && k < 12;
        const bool rises = (i < 0) == (j < 0);  // the diagonal that points at the axis
        for (auto [p, q, r] : {std::array{n, n + 1, rises ? n + width + 1 : n + width},
                               {rises ? n : n + 1, n + width, n + width + 1}}) {  // two prisms, of three tets each
            add_tet({Vertex(p), Vertex(q), Vertex(r), Vertex(r + up)}, in_cube);
            add_tet({Vertex(p), Vertex(q), Vertex(q + up), Vertex(r + up)}, in_cube);
            add_tet({Vertex(p), Vertex(p + up), Vertex(q + up), Vertex(r + up)}, in_cube);
        }
    }
    std::vector<BoundaryFacet> boundary;
    for (const auto& [f, cells] : cells_at) {
        const auto all_at = [&, &f = f](double z) {
            return std::ranges::all_of(f, [&](Vertex v) { return vertices[v].z == z; });
        };
        if (cells == 1) boundary.push_back({f, Patch(all_at(0) ? 4 : all_at(height * layers) ? 5 : 6)});
    }
    return make_mesh(vertices, tets, regions, boundary);
}

int main() try {
    Mesh mesh = cube_in_a_cylinder();
    Domain domain = domain_of(mesh, {.surface = 0.25, .growth = 0.2, .far = 0.4});
    domain.bodies.push_back({"cube", shape_of_region(mesh, Region(1)), [](double t) {
        return Pose{{0, 0, -2 * t}, rotation_about({1, 1, 2}, 0.6 * t)};
    }});
    improve(mesh, all_tets(mesh), snapshot(domain, 0));
    MovingMesh moving(domain, std::move(mesh), 0);
    Fields fields;  // none are carried here
    std::printf("time   tets  worst R/r  touched\n");
    const double wanted = 1.0 / 30;
    for (double dt = wanted; moving.time() < 1 - 1e-9;) {
        const Advanced step = advance(moving, fields, std::min(dt, 1 - moving.time()), {});
        dt = std::min(wanted, next_dt(step, dt));
        const auto now = summarise_quality(moving.reference());
        std::printf("%4.2f %6d %10.2f %8d\n", moving.time(), now.tets, now.max_aspect_ratio, step.cells_touched);
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
