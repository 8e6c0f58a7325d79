#pragma once

#include "mesh/triangle.h"
#include "mesh/box_tree.h"

#include <cstddef>
#include <span>
#include <vector>

namespace kropla {

/// The place on many triangles nearest to a point.
struct NearestPlace {
    Vec3 point;
    double squared_distance = Extent::infinite;  // [m^2]; infinite where there is none, or the point is not finite
    std::size_t triangle = 0;
    TrianglePart part = TrianglePart::inside;
};

/// Triangles in space, each with an area, ready to be asked what of them is near: in time that grows with the logarithm
/// of their number. They need not bound anything.
class TriangleTree {
public:
    /// Corners are places of `points`.
    TriangleTree(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);

    [[nodiscard]] std::span<const Vec3> points() const { return points_; }
    [[nodiscard]] std::span<const std::array<int, 3>> triangles() const { return triangles_; }
    [[nodiscard]] Corners corners(std::size_t triangle) const;
    [[nodiscard]] const BoxTree& boxes() const { return boxes_; }  ///< of the triangles, by their numbers

    [[nodiscard]] NearestPlace nearest(const Vec3& x) const { return nearest(x, NearestPlace{x}); }
    /// The same, or `known`, a place on them, if none is nearer.
    [[nodiscard]] NearestPlace nearest(const Vec3& x, const NearestPlace& known) const;
    /// How far they reach along `direction`, from the origin, in its lengths.
    [[nodiscard]] double reach_along(const Vec3& direction) const;

private:
    std::vector<Vec3> points_;
    std::vector<std::array<int, 3>> triangles_;
    BoxTree boxes_;
};

/// The box that just holds the triangle.
[[nodiscard]] Extent extent(const Corners& triangle);

}  // namespace kropla
