#include "motion/facing.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kropla {
namespace {

/// Symmetric, of a plane with two axes.
struct Plane {
    Vec3 e1, e2;
};
struct Symmetric {
    double a = 0, b = 0, c = 0;  // rows (a, b), (b, c)

    [[nodiscard]] double determinant() const { return a * c - b * b; }
    [[nodiscard]] Symmetric inverse() const { return {c / determinant(), -b / determinant(), a / determinant()}; }
    [[nodiscard]] Symmetric plus(const Symmetric& other) const { return {a + other.a, b + other.b, c + other.c}; }
};

Plane across(const Vec3& n) {
    const double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    const Vec3 other = x <= y && x <= z ? Vec3{1, 0, 0} : y <= z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    const Vec3 e1 = normalised(cross(n, other));
    return {e1, cross(n, e1)};
}

/// Q n, of which h^2 = n . Q n.
Vec3 squared(const Shape& shape, const Vec3& n) {
    const Vec3 d = rotated_back(shape.orientation, n);
    const Vec3& a = shape.semi_axes;
    return rotated(shape.orientation, {a.x * a.x * d.x, a.y * a.y * d.y, a.z * a.z * d.z});
}

/// The outermost point of an ellipsoid along n.
struct Outermost {
    Vec3 point;         // [m]
    Symmetric radii;    // [m] of curvature there
};
Outermost outermost(const Shape& shape, const Vec3& n, const Plane& plane) {
    const Vec3 q = squared(shape, n), q1 = squared(shape, plane.e1), q2 = squared(shape, plane.e2);
    const double h = std::sqrt(dot(n, q)), p1 = dot(plane.e1, q) / h, p2 = dot(plane.e2, q) / h;
    return {shape.centre + q / h,
            {(dot(plane.e1, q1) - p1 * p1) / h, (dot(plane.e1, q2) - p1 * p2) / h, (dot(plane.e2, q2) - p2 * p2) / h}};
}

double squeezed(const Symmetric& curvature) {
    return 2 / (std::sqrt(curvature.determinant()) * (curvature.a + curvature.c));
}

double separation(const Shape& a, const Shape& b, const Vec3& n) {
    return dot(n, a.centre - b.centre) - std::sqrt(dot(n, squared(a, n))) - std::sqrt(dot(n, squared(b, n)));
}

Facing seen_along(const Shape& a, const Shape& b, const Vec3& n, const Outermost& of_a, const Outermost& of_b) {
    return {.on_a = of_a.point,
            .on_b = of_b.point,
            .normal = n,
            .gap = separation(a, b, n),
            .squeezed = squeezed(of_a.radii.inverse().plus(of_b.radii.inverse()))};
}

}  // namespace

Facing facing(const Shape& a, const Shape& b) {
    constexpr int rounds = 100;        // quadratic: some five are enough
    constexpr double rounding = 1e-15;  // [-] radians
    const Vec3 between = a.centre - b.centre;
    Vec3 n = norm(between) > 0 ? normalised(between) : Vec3{0, 0, 1};
    for (int round = 0;; ++round) {
        const Plane plane = across(n);
        const Outermost of_a = outermost(a, -n, plane), of_b = outermost(b, n, plane);
        const double gap = separation(a, b, n);
        const Symmetric slope = of_a.radii.plus(of_b.radii).plus({std::max(gap, 0.0), 0, std::max(gap, 0.0)});
        const Vec3 rise = of_a.point - of_b.point;
        const double r1 = dot(plane.e1, rise), r2 = dot(plane.e2, rise);
        const Symmetric inverse = slope.inverse();
        double turn1 = inverse.a * r1 + inverse.b * r2, turn2 = inverse.b * r1 + inverse.c * r2;
        const double turn = std::hypot(turn1, turn2);
        if (turn <= rounding || round == rounds) return seen_along(a, b, n, of_a, of_b);
        // As far as it rises; where rounding hides that, it is there.
        double part = std::min(1.0, 0.5 / turn);
        const auto turned = [&] { return normalised(n + part * (turn1 * plane.e1 + turn2 * plane.e2)); };
        while (part * turn > rounding && separation(a, b, turned()) < gap) part /= 2;
        if (part * turn <= rounding) return seen_along(a, b, n, of_a, of_b);
        n = turned();
    }
}

Facing facing_wall(const Shape& a, const Box& box, int wall) {
    const int axis = wall / 2;
    const bool low = wall % 2 == 0;
    Vec3 n;
    n[axis] = low ? 1 : -1;
    const Outermost of_a = outermost(a, -n, across(n));
    Facing found{.on_a = of_a.point, .on_b = of_a.point, .normal = n, .squeezed = squeezed(of_a.radii.inverse())};
    found.on_b[axis] = low ? box.min[axis] : box.max[axis];
    found.gap = dot(n, found.on_a - found.on_b);
    return found;
}

double least_gap_between(const Shape& a, const Shape& b) {
    return distance(a.centre, b.centre) - outer_radius(a) - outer_radius(b);
}

}  // namespace kropla
