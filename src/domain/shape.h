#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <limits>
#include <memory>
#include <vector>

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

class TriangulatedSurface;  // triangulated_surface.h
struct CutSurface;          // cut.h
class TriangleTree;         // triangle_tree.h

/// The shape of a body: an ellipsoid, of which a sphere is one with equal semi-axes; or what a surface of triangles
/// bounds, which is shared by all copies: see `shape_within`.
struct Shape {
    Vec3 centre;            // [m]
    Vec3 semi_axes;         // [m], each positive; of a surface: half the extents along its own axes
    Rotation orientation;
    std::shared_ptr<const TriangulatedSurface> surface = {};  // about the centre, by its own axes; none: an ellipsoid
    std::shared_ptr<const CutSurface> cut = {};  // what that is a part of, where faces of the box cut the body (solids.h)
    double resolved = std::numeric_limits<double>::infinity();  // [m] radius that triangles on such a surface have to resolve
};

[[nodiscard]] inline bool is_sphere(const Shape& s) {
    return s.semi_axes.x == s.semi_axes.y && s.semi_axes.y == s.semi_axes.z && !s.surface;
}

/// The faces of the box, as bits, that the shape reaches through: its surface ends there, or leaves the whole face to it.
[[nodiscard]] unsigned reached_faces(const Shape& shape);
[[nodiscard]] inline bool reaches(unsigned faces, int face) { return (faces >> face & 1u) != 0; }

/// What the surface bounds, its origin at `centre` and its axes turned by `orientation`.
[[nodiscard]] Shape shape_within(TriangulatedSurface surface, const Vec3& centre = {},
                                 const Rotation& orientation = {});
/// What these triangles bound where they are [m], its centre its centroid. Throws DomainError as `make_surface`.
[[nodiscard]] Shape shape_within(std::vector<Vec3> points, const std::vector<std::array<int, 3>>& triangles);

/// The shape as it stands at `pose`.
[[nodiscard]] Shape placed(const Shape& start, const Pose& pose);
/// A point of the body, given where it was at the start.
[[nodiscard]] Vec3 placed(const Shape& start, const Pose& pose, const Vec3& at_start);

/// The volume inside [m^3].
[[nodiscard]] double volume(const Shape& shape);
/// The ellipsoid blown up, or shrunk, about its centre until `x`, which is not the centre, is on its surface.
[[nodiscard]] Shape through(const Shape& ellipsoid, const Vec3& x);
/// The distance from `x` to the surface [m], negative inside. Exact to rounding.
[[nodiscard]] double signed_distance(const Shape& shape, const Vec3& x);
/// The point of the surface nearest to `x`.
[[nodiscard]] Vec3 closest_point(const Shape& shape, const Vec3& x);
/// Both, for little more than one of them.
struct SurfacePlace {
    Vec3 point;              // nearest to x
    double signed_distance;  // [m]
};
[[nodiscard]] SurfacePlace nearest_on_surface(const Shape& shape, const Vec3& x);
/// How thick the shape is at the place of its surface that is nearest to `x`, of an ellipsoid `x` itself: the diameter of
/// the largest ball that touches there from inside [m].
[[nodiscard]] double thickness_at(const Shape& shape, const Vec3& x);
/// How wide a neck of the shape is there, or outwards a notch: along the normal to the other side, or through the shape
/// to a face of the box, if that is parallel to within 40 degrees [m]. Infinite if not within `most`, and of an ellipsoid.
[[nodiscard]] double neck_at(const Shape& shape, const Vec3& x, bool inside, double most);
/// The radius of the smallest ball about the centre that holds the shape [m].
[[nodiscard]] double outer_radius(const Shape& shape);
/// The least radius of curvature that triangles on the surface have to resolve [m]: of a surface of triangles infinite,
/// edges or not, unless its maker knows of one (a cylinder).
[[nodiscard]] double least_curvature_radius(const Shape& shape);
/// The distance between two surfaces [m]; 0 if the shapes overlap. Of spheres exact; with an ellipsoid to 1e-9 and not
/// above; of triangles exact to rounding, in a time that grows with the logarithm of their number where few are near.
[[nodiscard]] double gap_between(const Shape& a, const Shape& b);
/// The same between a shape and triangles that need not bound anything; 0 if the shape meets them. What they may
/// enclose is not asked.
[[nodiscard]] double gap_between(const Shape& shape, const TriangleTree& triangles);
/// The corners of the axis-parallel box that just holds the shape.
struct Bounds { Vec3 min, max; };
[[nodiscard]] Bounds bounds(const Shape& shape);

}  // namespace kropla
