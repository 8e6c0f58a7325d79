// Ellipsoids, what triangles bound, and their rigid motion.
//
// The closest point follows [Eberly 2013, "Distance from a Point to an Ellipse, an Ellipsoid, or a
// Hyperellipsoid"]: the largest root of one convex, falling function of one variable. Changed against it: the
// variable is the distance from the function's last pole, so that nothing cancels near it, and Newton starts
// at a point that is surely left of the root and near it, so that no bisection is needed.

#include <kropla/domain/shape.h>

#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace kropla {

Rotation rotation_about(const Vec3& axis, double angle) {
    assert(squared_norm(axis) > 0);
    const Vec3 k = normalised(axis);
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turned = [&](const Vec3& a) { return c * a + s * cross(k, a) + (1 - c) * dot(k, a) * k; };
    return {{turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})}};
}

Vec3 rotated(const Rotation& r, const Vec3& a) { return a.x * r.axes[0] + a.y * r.axes[1] + a.z * r.axes[2]; }

Vec3 rotated_back(const Rotation& r, const Vec3& a) {
    return {dot(r.axes[0], a), dot(r.axes[1], a), dot(r.axes[2], a)};
}

Rotation operator*(const Rotation& second, const Rotation& first) {
    return {{rotated(second, first.axes[0]), rotated(second, first.axes[1]), rotated(second, first.axes[2])}};
}

Shape shape_within(TriangulatedSurface surface, const Vec3& centre, const Rotation& orientation) {
    const Vec3 half = 0.5 * (surface.extent().max - surface.extent().min);
    return {centre, half, orientation, std::make_shared<const TriangulatedSurface>(std::move(surface))};
}

Shape shape_within(std::vector<Vec3> points, const std::vector<std::array<int, 3>>& triangles) {
    const Vec3 centre = make_surface(points, triangles).centroid();
    for (Vec3& x : points) x -= centre;
    return shape_within(make_surface(std::move(points), triangles), centre);
}

unsigned reached_faces(const Shape& shape) { return shape.surface ? shape.surface->reached() : 0; }

Shape placed(const Shape& start, const Pose& pose) {
    return {start.centre + pose.displacement, start.semi_axes, pose.rotation * start.orientation, start.surface, start.cut, start.resolved};
}

Vec3 placed(const Shape& start, const Pose& pose, const Vec3& at_start) {
    return start.centre + pose.displacement + rotated(pose.rotation, at_start - start.centre);
}

namespace {

double least(const Vec3& a) { return std::min({a.x, a.y, a.z}); }
double greatest(const Vec3& a) { return std::max({a.x, a.y, a.z}); }

/// The root u >= 0 of sum (r_i z_i / (u + r_i - 1))^2 = 1, where r_i = (a_i / a_min)^2 and z_i = |p_i| / a_i;
/// 0 if the sum is below 1 everywhere. Each term alone is at most 1 at the start, so the sum is at most 3
/// there; it is convex and falling, so Newton's steps rise to the root without passing it.
double multiplier(const Vec3& r, const Vec3& z) {
    double u = 0;
    for (int i = 0; i < 3; ++i) u = std::max(u, r[i] * z[i] - (r[i] - 1));
    for (;;) {
        double sum = 0, slope = 0;
        for (int i = 0; i < 3; ++i) {
            if (z[i] == 0) continue;
            const double pole_distance = u + (r[i] - 1), term = r[i] * z[i] / pole_distance;
            sum += term * term;
            slope += 2 * term * term / pole_distance;
        }
        const double next = sum > 1 ? u + (sum - 1) / slope : u;
        if (!(next > u)) return u;
        u = next;
    }
}

/// The point of the axis-parallel ellipsoid about the origin nearest to `p`.
Vec3 closest_on_ellipsoid(const Vec3& semi_axes, const Vec3& p) {
    const double a_min = least(semi_axes);
    Vec3 r, z;
    for (int i = 0; i < 3; ++i) {
        r[i] = (semi_axes[i] / a_min) * (semi_axes[i] / a_min);
        z[i] = std::abs(p[i]) / semi_axes[i];
    }
    const double u = multiplier(r, z);
    Vec3 closest;
    double rest = 1;  // of the equation sum (x_i / a_i)^2 = 1
    int shortest = 0;
    for (int i = 0; i < 3; ++i) {
        if (semi_axes[i] == a_min) shortest = i;
        const double pole_distance = u + (r[i] - 1);
        closest[i] = pole_distance > 0 ? r[i] * p[i] / pole_distance : 0;
        rest -= (closest[i] / semi_axes[i]) * (closest[i] / semi_axes[i]);
    }
    // Inside, on the plane of symmetry across the shortest axis: the nearest points are two, off the plane.
    if (u == 0) closest[shortest] = a_min * std::sqrt(std::max(0.0, rest));
    return closest;
}

Vec3 closest_on_sphere(const Shape& sphere, const Vec3& x) {
    const Vec3 out = x - sphere.centre;
    const double far = norm(out);
    if (far == 0) return sphere.centre + Vec3{sphere.semi_axes.x, 0, 0};
    return sphere.centre + (sphere.semi_axes.x / far) * out;
}

}  // namespace

double volume(const Shape& shape) {
    if (shape.surface) return shape.surface->volume();
    return 4 * std::numbers::pi / 3 * shape.semi_axes.x * shape.semi_axes.y * shape.semi_axes.z;
}

Shape through(const Shape& ellipsoid, const Vec3& x) {
    assert(!ellipsoid.surface);
    const Vec3 p = rotated_back(ellipsoid.orientation, x - ellipsoid.centre);
    const Vec3& a = ellipsoid.semi_axes;
    return {ellipsoid.centre, norm({p.x / a.x, p.y / a.y, p.z / a.z}) * a, ellipsoid.orientation};
}

double signed_distance(const Shape& shape, const Vec3& x) {
    if (is_sphere(shape)) return distance(x, shape.centre) - shape.semi_axes.x;
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre);
    if (shape.surface) return shape.surface->signed_distance(p);
    const double far = distance(p, closest_on_ellipsoid(shape.semi_axes, p));
    const Vec3 scaled = {p.x / shape.semi_axes.x, p.y / shape.semi_axes.y, p.z / shape.semi_axes.z};
    return squared_norm(scaled) < 1 ? -far : far;
}

Vec3 closest_point(const Shape& shape, const Vec3& x) {
    if (is_sphere(shape)) return closest_on_sphere(shape, x);
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre);
    const Vec3 closest = shape.surface ? shape.surface->closest_point(p) : closest_on_ellipsoid(shape.semi_axes, p);
    return shape.centre + rotated(shape.orientation, closest);
}

SurfacePlace nearest_on_surface(const Shape& shape, const Vec3& x) {
    if (!shape.surface) return {closest_point(shape, x), signed_distance(shape, x)};
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre);
    const NearestPlace nearest = shape.surface->tree().nearest(p);
    return {shape.centre + rotated(shape.orientation, nearest.point), shape.surface->signed_distance(p, nearest)};
}

double thickness_at(const Shape& shape, const Vec3& x) {
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre);
    if (shape.surface) return 2 * shape.surface->touching_ball(p, true, shape.surface->farthest());
    // The medial surface of an ellipsoid lies in the plane across its shortest axis c: the ball's centre is there, and its
    // radius c^2 / d, d the distance from the ellipsoid's centre to the tangent plane.
    const Vec3& a = shape.semi_axes;
    const double tangent_plane = 1 / norm({p.x / (a.x * a.x), p.y / (a.y * a.y), p.z / (a.z * a.z)});
    const double shortest = std::min({a.x, a.y, a.z});
    return 2 * shortest * (shortest / tangent_plane);
}

double neck_at(const Shape& shape, const Vec3& x, bool inside, double most) {
    if (!shape.surface) return std::numeric_limits<double>::infinity();
    return shape.surface->across(rotated_back(shape.orientation, x - shape.centre), inside, most);
}

double outer_radius(const Shape& shape) {
    return shape.surface ? shape.surface->farthest() : greatest(shape.semi_axes);
}

double least_curvature_radius(const Shape& shape) {
    if (shape.surface) return shape.resolved;
    return least(shape.semi_axes) * (least(shape.semi_axes) / greatest(shape.semi_axes));
}

namespace {

/// How far the triangles reach along the axis of space, from the centre, to either side.
Bounds bounds_of_surface(const Shape& shape) {
    if (reached_faces(shape) != 0)  // as it stands
        return {shape.centre + shape.surface->extent().min, shape.centre + shape.surface->extent().max};
    Bounds held{shape.centre, shape.centre};
    for (int i = 0; i < 3; ++i) {
        const auto& axes = shape.orientation.axes;
        const Vec3 axis = {axes[0][i], axes[1][i], axes[2][i]};
        held.min[i] -= shape.surface->tree().reach_along(-axis);
        held.max[i] += shape.surface->tree().reach_along(axis);
    }
    return held;
}

}  // namespace

Bounds bounds(const Shape& shape) {
    if (shape.surface) return bounds_of_surface(shape);
    Vec3 half;
    for (int i = 0; i < 3; ++i) {
        const auto& axes = shape.orientation.axes;
        const Vec3& a = shape.semi_axes;
        half[i] = norm({a.x * axes[0][i], a.y * axes[1][i], a.z * axes[2][i]});
    }
    return {shape.centre - half, shape.centre + half};
}

}  // namespace kropla
