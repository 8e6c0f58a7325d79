#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace kropla {

/// Coordinates from elsewhere as the predicates take them: 0 for what is below 1e-30 in size.
[[nodiscard]] inline Vec3 without_underflow(Vec3 x) {
    constexpr double least = 1e-30;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(x[axis]) < least) x[axis] = 0;
    return x;
}

/// The sign of det(b-a, c-a, d-a), exact: +1 if the tet (a, b, c, d) is positively oriented, 0 if the four
/// points are coplanar. Coordinates are finite, and zero or between 1e-50 and 1e50 in size (no under- or
/// overflow). After [Shewchuk 1997]: a filter with a proven error bound, then floating-point expansions.
[[nodiscard]] int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The sign that tells where `e` lies, exact: +1 inside, -1 outside, 0 on the sphere through a, b, c, d,
/// which are positively oriented. Coordinates as for orient3d, here between 1e-30 and 1e30 in size.
[[nodiscard]] int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e);

/// As insphere, but never 0: points are raised by symbolic amounts, the more the larger their rank, so that a
/// set of cospherical points has one Delaunay triangulation. Ranks are distinct. The points' places are not
/// perturbed, so no tet of that triangulation is flat. After [Devillers, Teillaud 2011].
[[nodiscard]] int insphere_perturbed(const std::array<const Vec3*, 5>& points,
                                     const std::array<std::int64_t, 5>& ranks);

}  // namespace kropla
