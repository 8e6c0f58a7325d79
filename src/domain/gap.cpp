// The distance between two ellipsoids.
//
// It is found by alternating projections [Cheney, Goldstein 1959, "Proximity maps for convex sets"]: from a
// point of one to the nearest of the other and back. Planes across the way found bound the distance from
// below, so that it is known when that is near enough.

#include "domain/shape.h"

#include <algorithm>

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

}  // namespace

double gap_between(const Shape& a, const Shape& b) {
    if (is_sphere(a) && is_sphere(b))
        return std::max(0.0, distance(a.centre, b.centre) - a.semi_axes.x - b.semi_axes.x);
    return alternating_distance(a, b);
}

}  // namespace kropla
