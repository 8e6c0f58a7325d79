// Linear tetrahedra and prisms, at a time and over a step.
//   [Lesoinne, Farhat 1996] Geometric conservation laws for flow problems with moving boundaries and
//     deformable meshes. CMAME 134. In three dimensions one configuration per step is not enough; two Gauss
//     points are: the cofactors of the Jacobian are quadratic in time, for prisms too.
//   [Strang, Fix 1973] An analysis of the finite element method: rules for triangles, the patch test.
#include "simulate/elements.h"

#include <cmath>

namespace kropla {
namespace {

Vec3 between(const Vec3& a, const Vec3& b, double s) {
    return (1 - s) * a + s * b;
}

}  // namespace

CellPoints<6> cell_points(const Corners<6>& x) {
    constexpr double weight = 1.0 / 12;  // the reference prism has volume one half
    CellPoints<6> points;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const PrismPoint at = prism_point(k);
        const Vec3 a = between(x[1] - x[0], x[4] - x[3], at.height);
        const Vec3 b = between(x[2] - x[0], x[5] - x[3], at.height);
        Vec3 up;
        for (std::size_t i = 0; i < 3; ++i) up += at.triangle[i] * (x[i + 3] - x[i]);
        const Vec3 g1 = weight * cross(b, up), g2 = weight * cross(up, a), rise = weight * cross(a, b);
        const std::array<Vec3, 3> in_triangle = {-(g1 + g2), g1, g2};
        points[k].volume = dot(up, rise);
        for (std::size_t i = 0; i < 3; ++i) {
            points[k].volume_gradient[i] = (1 - at.height) * in_triangle[i] - at.triangle[i] * rise;
            points[k].volume_gradient[i + 3] = at.height * in_triangle[i] + at.triangle[i] * rise;
        }
    }
    return points;
}

VolumeGradients<6> mean_volume_gradients(const Corners<6>& x0, const Corners<6>& x1) {
    VolumeGradients<6> mean = {};
    for (double time : gauss_points) {
        Corners<6> r;  // seen from corner 0
        for (std::size_t i = 0; i < r.size(); ++i) r[i] = between(x0[i] - x0[0], x1[i] - x1[0], time);
        const CellPoints<6> points = cell_points(r);
        for (std::size_t k = 0; k < points.size(); ++k)
            for (std::size_t i = 0; i < r.size(); ++i) mean[k][i] += 0.5 * points[k].volume_gradient[i];
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
