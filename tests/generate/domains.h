#pragma once

#include <kropla/domain/domain.h>

#include <initializer_list>
#include <string>

namespace kropla {

/// A box of 6 x 6 x 8 with bodies "0", "1", ... in it, coarse so that meshes are made in a fraction of a
/// second.
inline Domain small_domain(std::initializer_list<Shape> shapes) {
    Domain domain;
    domain.box = {{-3, -3, 0}, {3, 3, 8}};
    domain.size = {0.4, 0.2, 0.9};
    for (const Shape& shape : shapes) {
        Body body;
        body.name = std::to_string(domain.bodies.size());
        body.shape = shape;
        domain.bodies.push_back(body);
    }
    return domain;
}

inline Shape ball(const Vec3& centre, double radius) { return {centre, {radius, radius, radius}, {}}; }

inline Shape turned_ellipsoid(const Vec3& centre, const Vec3& semi_axes) {
    return {centre, semi_axes, rotation_about({1, 2, 3}, 0.7)};
}

/// The same domain with all lengths times `scale`.
inline Domain scaled(Domain domain, double scale) {
    domain.box.min *= scale;
    domain.box.max *= scale;
    domain.size.surface *= scale;
    domain.size.far *= scale;
    for (Body& body : domain.bodies) {
        body.shape.centre *= scale;
        body.shape.semi_axes *= scale;
    }
    return domain;
}

}  // namespace kropla
