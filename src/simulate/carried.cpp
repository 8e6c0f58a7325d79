// The motion of a body as a whole, from the two places of its interface's vertices: with both clouds centred,
// the affine map is (sum x1 x0^T) (sum x0 x0^T)^-1, by linear least squares. A rigid motion is affine, so it
// is found to rounding.
#include "simulate/carried.h"

#include "mesh/cells.h"
#include "mesh/topology.h"

#include <algorithm>

namespace kropla {
namespace {

using Matrix = std::array<Vec3, 3>;  // rows

constexpr double rounding = 1e-12;      // [-] of the body's extent: nobody moves a vertex by so little
constexpr double least_extent = 1e-9;  // [-] a flatter cloud, by its determinant, tells nothing of a rotation

std::vector<Vertex> interface_vertices(const Mesh& mesh, Region body) {
    std::vector<Vertex> vertices;
    for (Tet t : all_tets(mesh, body)) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Tet other = mesh.neighbour[t][corner];
            if (!other.exists() || mesh.region[other] == body) continue;
            for (int k : tet_facets[corner]) vertices.push_back(mesh.tets[t][static_cast<std::size_t>(k)]);
        }
    }
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);
    vertices.erase(repeated.begin(), repeated.end());
    return vertices;
}

Vec3 mean_place(const Mesh& mesh, const std::vector<Vertex>& vertices) {
    Vec3 sum;
    for (Vertex v : vertices) sum += mesh.position[v];
    return sum / static_cast<double>(vertices.size());
}

struct WholeMotion {
    Vec3 from, to;  // the middle of the interface [m]
    Matrix turn = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    double extent = 0;  // of the interface [m]

    Vec3 operator()(const Vec3& x) const {
        const Vec3 r = x - from;
        return to + Vec3{dot(turn[0], r), dot(turn[1], r), dot(turn[2], r)};
    }
};

WholeMotion whole_motion(const Mesh& before, const Mesh& current, const std::vector<Vertex>& vertices) {
    WholeMotion motion{mean_place(before, vertices), mean_place(current, vertices)};
    Matrix spread = {}, mixed = {};
    for (Vertex v : vertices) {
        const Vec3 x0 = before.position[v] - motion.from, x1 = current.position[v] - motion.to;
        motion.extent = std::max(motion.extent, norm(x0));
        for (std::size_t row = 0; row < 3; ++row) {
            spread[row] += x0[static_cast<int>(row)] * x0;
            mixed[row] += x1[static_cast<int>(row)] * x0;
        }
    }
    const double size = (spread[0].x + spread[1].y + spread[2].z) / 3;
    const double determinant_of_spread = determinant(spread[0], spread[1], spread[2]);
    if (determinant_of_spread <= least_extent * size * size * size) return motion;
    const Matrix inverse = {cross(spread[1], spread[2]) / determinant_of_spread,  // symmetric, as spread is
                            cross(spread[2], spread[0]) / determinant_of_spread,
                            cross(spread[0], spread[1]) / determinant_of_spread};
    for (std::size_t row = 0; row < 3; ++row) {
        motion.turn[row] = {dot(mixed[row], inverse[0]), dot(mixed[row], inverse[1]),
                            dot(mixed[row], inverse[2])};
    }
    return motion;
}

}  // namespace

Array<Vertex, Vec3> carried_along(const Mesh& before, const Mesh& current, Region body) {
    const std::vector<Vertex> interface = interface_vertices(current, body);
    if (interface.empty()) return before.position;
    const WholeMotion motion = whole_motion(before, current, interface);
    Array<Vertex, Vec3> place = current.position;
    for (Tet t : all_tets(current, body)) {
        for (Vertex v : current.tets[t]) {
            const Vec3 carried = motion(before.position[v]);
            if (distance(carried, current.position[v]) > rounding * motion.extent) place[v] = carried;
        }
    }
    for (Vertex v : interface) place[v] = current.position[v];
    return place;
}

}  // namespace kropla
