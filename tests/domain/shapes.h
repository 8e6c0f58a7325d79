#pragma once

#include "base/random.h"
#include <kropla/domain/domain.h>

#include <string>
#include <utility>

namespace kropla {

inline Vec3 random_vector(Random& random, double size) {
    const double x = random.uniform(-size, size), y = random.uniform(-size, size);
    return {x, y, random.uniform(-size, size)};
}

inline Shape ball(const Vec3& centre, double radius) { return {centre, {radius, radius, radius}, {}}; }

/// An ellipsoid of any proportions up to 10 : 1, turned somehow, near the origin.
inline Shape random_ellipsoid(Random& random) {
    Shape shape;
    shape.centre = random_vector(random, 1);
    for (int i = 0; i < 3; ++i) shape.semi_axes[i] = random.uniform(0.2, 2);
    const Vec3 axis = random_vector(random, 1);
    shape.orientation = rotation_about(axis, random.uniform(0, 6));
    return shape;
}

inline Body body(std::string name, const Shape& shape) {
    Body made;
    made.name = std::move(name);
    made.shape = shape;
    return made;
}

}  // namespace kropla
