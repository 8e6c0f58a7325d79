#pragma once

#include <kropla/base/vec3.h>

namespace kropla {

/// The centre of the circle through the three points, which are not collinear.
inline Vec3 triangle_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = b - a, v = c - a, normal = cross(u, v);
    return a + (squared_norm(u) * cross(v, normal) + squared_norm(v) * cross(normal, u)) /
                   (2 * squared_norm(normal));
}

}  // namespace kropla
