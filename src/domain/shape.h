#pragma once

#include "base/vec3.h"

#include <array>

namespace kropla {

/// A rotation, by the images of the three axes (orthonormal, right-handed).
struct Rotation {
    std::array<Vec3, 3> axes = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
};
/// By `angle` [rad] about `axis`, which need not be of unit length but is not zero (Rodrigues' formula).
[[nodiscard]] Rotation rotation_about(const Vec3& axis, double angle);
[[nodiscard]] Vec3 rotated(const Rotation& r, const Vec3& a);
[[nodiscard]] Vec3 rotated_back(const Rotation& r, const Vec3& a);
[[nodiscard]] Rotation operator*(const Rotation& second, const Rotation& first);

/// Where a body is, against its start: rotated about its start's centre, then displaced.
struct Pose {
    Vec3 displacement;  // [m]
    Rotation rotation;
};

/// The shape of a body: an ellipsoid; a sphere is one with equal semi-axes.
struct Shape {
    Vec3 centre;            // [m]
    Vec3 semi_axes;         // [m], each positive
    Rotation orientation;
};

[[nodiscard]] inline bool is_sphere(const Shape& s) {
    return s.semi_axes.x == s.semi_axes.y && s.semi_axes.y == s.semi_axes.z;
}

/// The shape as it stands at `pose`.
[[nodiscard]] Shape placed(const Shape& start, const Pose& pose);
/// A point of the body, given where it was at the start.
[[nodiscard]] Vec3 placed(const Shape& start, const Pose& pose, const Vec3& at_start);

/// The volume inside [m^3].
[[nodiscard]] double volume(const Shape& shape);
/// The shape blown up, or shrunk, about its centre until `x`, which is not the centre, is on its surface.
[[nodiscard]] Shape through(const Shape& shape, const Vec3& x);
/// The distance from `x` to the surface [m], negative inside. Exact to rounding.
[[nodiscard]] double signed_distance(const Shape& shape, const Vec3& x);
/// The point of the surface nearest to `x`.
[[nodiscard]] Vec3 closest_point(const Shape& shape, const Vec3& x);
/// The least radius of curvature of the surface [m].
[[nodiscard]] double least_curvature_radius(const Shape& shape);
/// The distance between two surfaces [m], of spheres exact, else to 1e-9 and not above; 0 if the shapes
/// overlap.
[[nodiscard]] double gap_between(const Shape& a, const Shape& b);
/// The corners of the axis-parallel box that just holds the shape.
struct Bounds { Vec3 min, max; };
[[nodiscard]] Bounds bounds(const Shape& shape);

}  // namespace kropla
