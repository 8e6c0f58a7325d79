#include "domain/triangle_tree.h"

#include <algorithm>
#include <utility>

namespace kropla {

namespace {

Corners corners_of(std::span<const Vec3> points, const std::array<int, 3>& triangle) {
    const auto at = [&](std::size_t i) { return points[static_cast<std::size_t>(triangle[i])]; };
    return {at(0), at(1), at(2)};
}

std::vector<Extent> extents(std::span<const Vec3> points, std::span<const std::array<int, 3>> triangles) {
    std::vector<Extent> found;
    for (const auto& triangle : triangles) found.push_back(extent(corners_of(points, triangle)));
    return found;
}

}  // namespace

Extent extent(const Corners& triangle) {
    Extent box;
    for (const Vec3& x : triangle) box.take_in(x);
    return box;
}

TriangleTree::TriangleTree(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles)
    : points_(std::move(points)), triangles_(std::move(triangles)), boxes_(extents(points_, triangles_)) {}

Corners TriangleTree::corners(std::size_t triangle) const { return corners_of(points_, triangles_[triangle]); }

NearestPlace TriangleTree::nearest(const Vec3& x) const {
    NearestPlace found{x};
    boxes_.least([&](const Extent& box) { return box.squared_distance(x); },
                 [&](std::size_t triangle) {
                     const OnTriangle there = closest_on_triangle(corners(triangle), x);
                     const double away = squared_norm(x - there.point);
                     if (away < found.squared_distance) found = {there.point, away, triangle, there.part};
                     return away;
                 });
    return found;
}

double TriangleTree::reach_along(const Vec3& direction) const {
    const auto nearest_corner = [&](const Extent& box) {
        double reach = 0;
        for (int axis = 0; axis < 3; ++axis)
            reach += std::max(direction[axis] * box.min[axis], direction[axis] * box.max[axis]);
        return -reach;
    };
    return -boxes_.least(nearest_corner, [&](std::size_t triangle) {
        const auto [a, b, c] = corners(triangle);
        return -std::max({dot(direction, a), dot(direction, b), dot(direction, c)});
    });
}

}  // namespace kropla
