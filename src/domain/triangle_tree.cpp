#include "domain/triangle_tree.h"

#include <algorithm>
#include <utility>

namespace kropla {

namespace {

Corners corners_of(std::span<const Vec3> points, const std::array<int, 3>& triangle) {
    const auto corner = [&](std::size_t i) { return points[static_cast<std::size_t>(triangle[i])]; };
    return {corner(0), corner(1), corner(2)};
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

namespace {

/// How far at most what is in the box reaches along `direction`, from the origin, in its lengths.
double reach_of(const Extent& box, const Vec3& direction) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis) reach += std::max(direction[axis] * box.min[axis], direction[axis] * box.max[axis]);
    return reach;
}

}  // namespace

// Nothing behind the plane through the nearest place so far, across the way to it, is nearer: of a body that bulges that
// is nearly all, whose boxes alone would not tell.
NearestPlace TriangleTree::nearest(const Vec3& x, const NearestPlace& known) const {
    NearestPlace found = known;
    Vec3 back = x - known.point;  // from the nearest place to x
    double behind = known.squared_distance < Extent::infinite ? dot(back, known.point) : -Extent::infinite;  // along it, that place
    boxes_.least([&](const Extent& box) { return reach_of(box, back) <= behind ? Extent::infinite : box.squared_distance(x); },
                 [&](std::size_t triangle) {
                     const Corners c = corners(triangle);
                     if (std::max({dot(back, c[0]), dot(back, c[1]), dot(back, c[2])}) <= behind) return Extent::infinite;
                     const OnTriangle there = closest_on_triangle(c, x);
                     const double away = squared_norm(x - there.point);
                     if (away < found.squared_distance) {
                         found = {there.point, away, triangle, there.part};
                         back = x - there.point;
                         behind = dot(back, there.point);
                     }
                     return away;
                 },
                 known.squared_distance);
    return found;
}

double TriangleTree::reach_along(const Vec3& direction) const {
    return -boxes_.least([&](const Extent& box) { return -reach_of(box, direction); }, [&](std::size_t triangle) {
        const auto [a, b, c] = corners(triangle);
        return -std::max({dot(direction, a), dot(direction, b), dot(direction, c)});
    });
}

}  // namespace kropla
