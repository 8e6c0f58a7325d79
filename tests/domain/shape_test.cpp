#include <kropla/domain/shape.h>
#include "domain/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace kropla;

namespace {

/// sum (x_i / a_i)^2 - 1 in the shape's own axes: 0 on the surface, negative inside.
double level(const Shape& shape, const Vec3& x) {
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre);
    return squared_norm(Vec3{p.x / shape.semi_axes.x, p.y / shape.semi_axes.y, p.z / shape.semi_axes.z}) - 1;
}

/// The direction in which `level` rises.
Vec3 normal(const Shape& shape, const Vec3& x) {
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre), &a = shape.semi_axes;
    return normalised(rotated(shape.orientation, {p.x / (a.x * a.x), p.y / (a.y * a.y), p.z / (a.z * a.z)}));
}

Vec3 random_surface_point(const Shape& shape, Random& random) {
    const Vec3 n = normalised(random_vector(random, 1)), &a = shape.semi_axes;
    return shape.centre + rotated(shape.orientation, {a.x * n.x, a.y * n.y, a.z * n.z});
}

}  // namespace

TEST(Rotation, TurnsAboutItsAxis) {
    const Vec3 turned = rotated(rotation_about({0, 0, 5}, std::numbers::pi / 2), {1, 2, 3});
    EXPECT_NEAR(distance(turned, {-2, 1, 3}), 0, 1e-15);
}

TEST(Rotation, KeepsLengthsAnglesAndHandAndGoesBack) {
    Random random{1};
    for (int i = 0; i < 100; ++i) {
        const Vec3 axis = random_vector(random, 1), a = random_vector(random, 1),
                   b = random_vector(random, 1);
        const Rotation r = rotation_about(axis, random.uniform(-9, 9));
        EXPECT_NEAR(dot(rotated(r, a), rotated(r, b)), dot(a, b), 1e-14);
        EXPECT_NEAR(determinant(r.axes[0], r.axes[1], r.axes[2]), 1, 1e-14);
        EXPECT_NEAR(distance(rotated_back(r, rotated(r, a)), a), 0, 1e-14);
        EXPECT_NEAR(distance(rotated(r * r, a), rotated(r, rotated(r, a))), 0, 1e-14);
    }
}

TEST(Shape, APlacedPointKeepsItsPlaceInTheBody) {
    Random random{2};
    for (int i = 0; i < 100; ++i) {
        const Shape start = random_ellipsoid(random);
        const Pose pose{random_vector(random, 3), rotation_about({1, 2, 3}, random.uniform(0, 6))};
        const Vec3 x = random_vector(random, 2);
        EXPECT_NEAR(signed_distance(placed(start, pose), placed(start, pose, x)), signed_distance(start, x),
                    1e-13);
    }
}

TEST(Shape, IsBlownUpToPassThroughAPoint) {
    Random random{5};
    for (int i = 0; i < 100; ++i) {
        const Shape shape = random_ellipsoid(random);
        const Vec3 x = shape.centre + random_vector(random, 2);
        const Shape other = through(shape, x);
        EXPECT_NEAR(signed_distance(other, x), 0, 1e-13);
        EXPECT_EQ(other.centre, shape.centre);
        const double factor = other.semi_axes.x / shape.semi_axes.x;
        EXPECT_LE(distance(other.semi_axes, factor * shape.semi_axes), 1e-14 * factor);
        EXPECT_NEAR(std::cbrt(volume(other) / volume(shape)), factor, 1e-14 * factor);
    }
    EXPECT_DOUBLE_EQ(volume(ball({1, 2, 3}, 2)), 32 * std::numbers::pi / 3);
}

TEST(Shape, ClosestPointIsOnTheSurfaceAndSeenAlongTheNormal) {
    Random random{3};
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE("ellipsoid " + std::to_string(i) + " of seed 3");
        const Shape shape = random_ellipsoid(random);
        const Vec3 x = shape.centre + random_vector(random, i % 2 == 0 ? 0.5 : 5);
        const Vec3 closest = closest_point(shape, x);
        ASSERT_NEAR(level(shape, closest), 0, 1e-13);
        const Vec3 out = x - closest;
        ASSERT_NEAR(norm(cross(out, normal(shape, closest))), 0, 1e-12);
        ASSERT_NEAR(std::abs(signed_distance(shape, x)), norm(out), 1e-13);
        ASSERT_EQ(signed_distance(shape, x) < 0, level(shape, x) < 0);
    }
}

TEST(Shape, NoPointOfTheSurfaceIsNearerThanTheClosest) {
    Random random{4};
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("ellipsoid " + std::to_string(i) + " of seed 4");
        const Shape shape = random_ellipsoid(random);
        const Vec3 x = shape.centre + random_vector(random, 2);
        const double found = std::abs(signed_distance(shape, x));
        for (int k = 0; k < 300; ++k)
            ASSERT_LE(found, distance(x, random_surface_point(shape, random)) + 1e-13);
    }
}

TEST(Shape, ClosestPointOnThePlanesOfSymmetry) {
    const Shape shape{{0, 0, 0}, {1, 2, 3}, {}};
    EXPECT_NEAR(signed_distance(shape, {0, 0, 0}), -1, 1e-15);  // along the shortest axis
    EXPECT_NEAR(signed_distance(shape, {0, 1e-300, 0}), -1, 1e-15);
    EXPECT_NEAR(signed_distance(shape, {1e-300, 0, 0}), -1, 1e-15);
    EXPECT_NEAR(signed_distance(shape, {0, 0, 5}), 2, 1e-15);
    EXPECT_NEAR(signed_distance(shape, {0, 0, 3}), 0, 1e-15);
    // On the longest axis, within the surface's focal sheet: the nearest point is off the axis (Lagrange's
    // equations give z = 9 p / 8 and x^2 = 1 - z^2 / 9).
    EXPECT_NEAR(std::abs(closest_point(shape, {0, 0, 2}).z), 9 * 2.0 / 8, 1e-14);
    EXPECT_NEAR(std::abs(closest_point(shape, {0, 0, 2}).x), std::sqrt(1 - 2.25 * 2.25 / 9), 1e-14);
    EXPECT_NEAR(signed_distance(ball({1, 1, 1}, 2), {1, 1, 1}), -2, 1e-15);
    EXPECT_NEAR(distance(closest_point(ball({1, 1, 1}, 2), {1, 1, 1}), {1, 1, 1}), 2, 1e-15);
}

TEST(Shape, AnEllipsoidThatIsNearlyASphereIsMeasuredAsOne) {
    Random random{5};
    const Shape sphere = ball({0, 0, 0}, 1);
    Shape nearly = sphere;
    nearly.semi_axes.y = 1 + 1e-14;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x = random_vector(random, 2);
        EXPECT_NEAR(signed_distance(nearly, x), signed_distance(sphere, x), 1e-13);
    }
}

TEST(Shape, DistanceScalesFromMicrometresToKilometres) {
    Random random{6};
    for (double scale : {1e-6, 1e3, 1e6}) {
        Shape shape = random_ellipsoid(random), scaled = shape;
        scaled.centre *= scale;
        scaled.semi_axes *= scale;
        const Vec3 x = random_vector(random, 3);
        EXPECT_NEAR(signed_distance(scaled, scale * x), scale * signed_distance(shape, x), 1e-13 * scale);
    }
}

TEST(Shape, BoundsJustHoldIt) {
    Random random{7};
    const Shape shape = random_ellipsoid(random);
    const Bounds held = bounds(shape);
    Bounds seen{shape.centre, shape.centre};
    for (int i = 0; i < 100000; ++i) {
        const Vec3 x = random_surface_point(shape, random);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_TRUE(held.min[axis] - 1e-14 <= x[axis] && x[axis] <= held.max[axis] + 1e-14);
            seen.min[axis] = std::min(seen.min[axis], x[axis]);
            seen.max[axis] = std::max(seen.max[axis], x[axis]);
        }
    }
    EXPECT_NEAR(distance(seen.min, held.min) + distance(seen.max, held.max), 0, 1.1e-4);
}

TEST(Shape, LeastCurvatureRadiusIsThatOfTheSharpestEnd) {
    EXPECT_DOUBLE_EQ(least_curvature_radius(ball({0, 0, 0}, 3)), 3);
    EXPECT_DOUBLE_EQ(least_curvature_radius({{0, 0, 0}, {1, 2, 4}, {}}),
                     0.25);  // b^2 / a at the long axis' end
}
