#pragma once

#include <kropla/base/vec3.h>

#include <array>

namespace kropla {

/// A triangle in space, by its corners [m].
using Corners = std::array<Vec3, 3>;

/// What of a triangle is nearest: its inside, the edge from corner i to the next, or corner i.
enum class TrianglePart { inside, edge_0, edge_1, edge_2, corner_0, corner_1, corner_2 };

struct OnTriangle {
    Vec3 point;
    TrianglePart part;
};
/// The point of the triangle nearest to `x`. It has an area, or is a segment {a, b, b}.
[[nodiscard]] OnTriangle closest_on_triangle(const Corners& triangle, const Vec3& x);

[[nodiscard]] Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& x);

/// As orient3d (base/predicates.h), at once where the points lie in a plane across an axis.
[[nodiscard]] int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x);
/// Does an edge of one go through the inside of the other? Exact; where they only touch, no.
[[nodiscard]] bool pierce(const Corners& a, const Corners& b);
/// Have the segment and the triangle a point in common, ends and edges included? Exact. `apex` is any point off its plane.
[[nodiscard]] bool meets(const Vec3& p, const Vec3& q, const Corners& triangle, const Vec3& apex);
/// Have the triangles, which have areas? Exact.
[[nodiscard]] bool meet(const Corners& a, const Corners& b);
/// The squared distance between two triangles [m^2]; 0 where they pierce each other.
[[nodiscard]] double squared_distance(const Corners& a, const Corners& b);

}  // namespace kropla
