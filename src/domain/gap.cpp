// The distance between two shapes.
//
// Of two ellipsoids, or of an ellipsoid and a triangle, it is found by alternating projections [Cheney, Goldstein
// 1959, "Proximity maps for convex sets"]: from a point of one to the nearest of the other and back. Planes across the
// way found bound the distance from below, so that it is known when that is near enough. Among many triangles the nearest are found by trees of boxes,
// two at once where both are triangles [Gottschalk, Lin, Manocha 1996, "OBBTree", for the descent].

#include <kropla/domain/shape.h>
#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>

namespace kropla {

namespace {

/// How far the shape reaches from its centre along the unit vector `direction` [m].
double reach_along(const Shape& shape, const Vec3& direction) {
    const Vec3 d = rotated_back(shape.orientation, direction);
    return norm({shape.semi_axes.x * d.x, shape.semi_axes.y * d.y, shape.semi_axes.z * d.z});
}

/// The gap as two parallel planes see it that touch the shapes from between; never more than the true one
/// [m].
double gap_along(const Shape& a, const Shape& b, const Vec3& direction) {
    return dot(direction, b.centre - a.centre) - reach_along(a, direction) - reach_along(b, direction);
}

/// Projects from shape to shape until planes across the way found confirm its length [m]; 0 if the shapes
/// overlap. The limit of rounds bounds the work for shapes that all but touch: their gap is found too small
/// then, or 0.
double alternating_distance(const Shape& a, const Shape& b) {
    constexpr int rounds = 2000;
    constexpr double accuracy = 1e-9;  // relative
    Vec3 on_a = a.centre;
    double confirmed = 0;
    for (int i = 0; i < rounds; ++i) {
        if (signed_distance(b, on_a) <= 0) return 0;
        const Vec3 on_b = closest_point(b, on_a);
        if (signed_distance(a, on_b) <= 0) return 0;
        on_a = closest_point(a, on_b);
        const double found = distance(on_a, on_b);
        if (found == 0) return 0;
        confirmed = std::max(confirmed, gap_along(a, b, (on_b - on_a) / found));
        if (confirmed >= found * (1 - accuracy)) break;
    }
    return confirmed;
}

/// Of an ellipsoid and a triangle, both convex, as above [m].
double alternating_distance(const Shape& ellipsoid, const Corners& triangle) {
    constexpr int rounds = 2000;
    constexpr double accuracy = 1e-9;  // relative
    Vec3 on_triangle = closest_on_triangle(triangle, ellipsoid.centre).point;
    double confirmed = 0;
    for (int i = 0; i < rounds; ++i) {
        if (signed_distance(ellipsoid, on_triangle) <= 0) return 0;
        const Vec3 on_ellipsoid = closest_point(ellipsoid, on_triangle);
        on_triangle = closest_on_triangle(triangle, on_ellipsoid).point;
        const double found = distance(on_triangle, on_ellipsoid);
        if (found == 0) return 0;
        const Vec3 direction = (on_triangle - on_ellipsoid) / found;
        const auto along = [&](const Vec3& x) { return dot(direction, x - ellipsoid.centre); };
        const double nearest = std::min({along(triangle[0]), along(triangle[1]), along(triangle[2])});
        confirmed = std::max(confirmed, nearest - reach_along(ellipsoid, direction));
        if (confirmed >= found * (1 - accuracy)) break;
    }
    return confirmed;
}

/// Where triangles stand: their origin and axes.
struct Frame {
    Vec3 origin;
    Rotation axes;

    [[nodiscard]] Vec3 out_of(const Vec3& x) const { return origin + rotated(axes, x); }
    [[nodiscard]] Vec3 into(const Vec3& x) const { return rotated_back(axes, x - origin); }
};
Frame frame_of(const Shape& shape) { return {shape.centre, shape.orientation}; }

/// The ellipsoid is given in the triangles' frame.
double gap_to_triangles(const Shape& ellipsoid, const TriangleTree& triangles) {
    if (is_sphere(ellipsoid))
        return std::max(0.0, std::sqrt(triangles.nearest(ellipsoid.centre).squared_distance) - ellipsoid.semi_axes.x);
    const auto at_least = [&](const Extent& box) {
        const Vec3 middle = 0.5 * (box.min + box.max);
        return std::max(0.0, signed_distance(ellipsoid, middle) - distance(middle, box.max));
    };
    return triangles.boxes().least(at_least, [&](std::size_t triangle) {
        return alternating_distance(ellipsoid, triangles.corners(triangle));
    });
}

/// `b` stands in the frame of `a` as told.
double gap_of_triangles(const TriangleTree& a, const TriangleTree& b, const Frame& frame) {
    const auto held = [&](const Extent& box) {
        const Vec3 middle = frame.out_of(0.5 * (box.min + box.max)), half = 0.5 * (box.max - box.min);
        Vec3 reach;
        for (int i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) reach[i] += std::abs(frame.axes.axes[k][i]) * half[static_cast<int>(k)];
        return Extent{middle - reach, middle + reach};
    };
    const auto between = [&](std::size_t i, std::size_t j) {
        Corners other = b.corners(j);
        for (Vec3& x : other) x = frame.out_of(x);
        return squared_distance(a.corners(i), other);
    };
    const auto at_least = [&](const Extent& of_a, const Extent& of_b) { return of_a.squared_distance(held(of_b)); };
    return std::sqrt(a.boxes().least_pair(b.boxes(), at_least, between));
}

Shape seen_from(const Frame& frame, const Shape& shape) {
    const auto& axes = shape.orientation.axes;
    const auto turned = [&](const Vec3& axis) { return rotated_back(frame.axes, axis); };
    return {frame.into(shape.centre), shape.semi_axes, {{turned(axes[0]), turned(axes[1]), turned(axes[2])}},
            shape.surface};
}

/// Is a part of `a` within `b`, whose surfaces do not meet?
bool is_within(const Shape& a, const Shape& b) {
    const auto inside = [&](const Vec3& x) { return signed_distance(b, x) < 0; };
    if (!a.surface) return inside(a.centre);
    return std::ranges::any_of(a.surface->point_of_parts(), inside,
                               [&](const Vec3& x) { return frame_of(a).out_of(x); });
}

}  // namespace

double gap_between(const Shape& shape, const TriangleTree& triangles) {
    return shape.surface ? gap_of_triangles(triangles, shape.surface->tree(), frame_of(shape))
                         : gap_to_triangles(shape, triangles);
}

double gap_between(const Shape& a, const Shape& b) {
    if (is_sphere(a) && is_sphere(b))
        return std::max(0.0, distance(a.centre, b.centre) - a.semi_axes.x - b.semi_axes.x);
    if (!a.surface && !b.surface) return alternating_distance(a, b);
    const Shape &of_triangles = a.surface ? a : b, &other = a.surface ? b : a;
    const double gap = gap_between(seen_from(frame_of(of_triangles), other), of_triangles.surface->tree());
    return is_within(a, b) || is_within(b, a) ? 0 : gap;
}

}  // namespace kropla
