// Linear tetrahedra, at a time and over a step.
//   [Lesoinne, Farhat 1996] Geometric conservation laws for flow problems with moving boundaries and
//     deformable meshes. CMAME 134. In three dimensions one configuration per step is not enough; two Gauss
//     points are.
#include "simulate/elements.h"

#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using Sides = std::array<Vec3, 3>;  // from corner 0 to 1, 2, 3

// The two Gauss points of the interval 0 ... 1, each of weight one half.
constexpr std::array<double, 2> gauss_points = {0.5 - 0.5 * std::numbers::inv_sqrt3,
                                                0.5 + 0.5 * std::numbers::inv_sqrt3};

Sides sides(const Corners& x) {
    return {x[1] - x[0], x[2] - x[0], x[3] - x[0]};
}

std::array<Vec3, 4> volume_gradient(const Sides& s) {
    const Vec3 g1 = cross(s[1], s[2]) / 6, g2 = cross(s[2], s[0]) / 6, g3 = cross(s[0], s[1]) / 6;
    return {-(g1 + g2 + g3), g1, g2, g3};
}

Vec3 between(const Vec3& a, const Vec3& b, double s) {
    return (1 - s) * a + s * b;
}

}  // namespace

Corners corners(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return {mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]};
}

LinearTet linear_tet(const Corners& x) {
    const Sides s = sides(x);
    return {determinant(s[0], s[1], s[2]) / 6, volume_gradient(s)};
}

std::array<Vec3, 4> mean_volume_gradient(const Corners& x0, const Corners& x1) {
    const Sides s0 = sides(x0), s1 = sides(x1);
    std::array<Vec3, 4> mean = {};
    for (double time : gauss_points) {
        const auto g = volume_gradient({between(s0[0], s1[0], time), between(s0[1], s1[1], time),
                                        between(s0[2], s1[2], time)});
        for (std::size_t i = 0; i < 4; ++i) mean[i] += 0.5 * g[i];
    }
    return mean;
}

Vec3 mean_area_vector(const std::array<Vec3, 3>& x0, const std::array<Vec3, 3>& x1) {
    Vec3 mean;
    for (double time : gauss_points) {
        const Vec3 a = between(x0[1] - x0[0], x1[1] - x1[0], time);
        const Vec3 b = between(x0[2] - x0[0], x1[2] - x1[0], time);
        mean += 0.25 * cross(a, b);
    }
    return mean;
}

}  // namespace kropla
