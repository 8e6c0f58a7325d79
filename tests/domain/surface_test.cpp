// Shapes that triangles bound.
#include <kropla/base/error.h>
#include "domain/shapes.h"
#include "domain/surfaces.h"
#include "domain/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace kropla;

namespace {

/// From the box of half extents `h` about the origin, by formula.
double distance_from_box(const Vec3& h, const Vec3& x) {
    Vec3 out;
    double inside = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        out[i] = std::max(std::abs(x[i]) - h[i], 0.0);
        inside = std::max(inside, std::abs(x[i]) - h[i]);
    }
    return inside < 0 ? inside : norm(out);
}

Shape turned_box(const Vec3& h, const Vec3& centre, Random& random) {
    const Vec3 axis = random_vector(random, 1);
    return shape_within(surface_of(box_of_triangles(-h, h)), centre, rotation_about(axis, random.uniform(0, 6)));
}

std::string refusal_of(const Triangles& t) {
    try {
        (void)surface_of(t);
    } catch (const DomainError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(SurfaceShape, ABoxHasItsDistancesAlsoAtEdgesAndCorners) {
    Random random{1};
    const Vec3 h = {1, 0.5, 2};
    for (int round = 0; round < 20; ++round) {
        const Shape box = turned_box(h, random_vector(random, 3), random);
        for (int i = 0; i < 200; ++i) {
            Vec3 p = random_vector(random, 3);
            // Opposite edges and corners, and on the planes through them.
            for (int axis = 0; axis < 3 && i % 2 == 0; ++axis)
                if (random.uniform() < 0.3) p[axis] = random.uniform() < 0.5 ? h[axis] : -1.5 * h[axis];
            const Vec3 x = box.centre + rotated(box.orientation, p);
            EXPECT_NEAR(signed_distance(box, x), distance_from_box(h, p), 1e-14 * 10);
            EXPECT_NEAR(distance(closest_point(box, x), x), std::abs(distance_from_box(h, p)), 1e-13);
        }
    }
}

TEST(TriangleTree, FindsTheNearestOfAllTriangles) {
    constexpr std::uint64_t seed = 5;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    Triangles soup = sphere_of_triangles(3);  // and triangles anywhere
    for (int i = 0; i < 300; ++i) {
        const auto first = static_cast<int>(soup.points.size());
        const Vec3 at = random_vector(random, 2);
        for (int corner = 0; corner < 3; ++corner) soup.points.push_back(at + random_vector(random, 0.3));
        soup.triangles.push_back({first, first + 1, first + 2});
    }
    const TriangleTree tree(soup.points, soup.triangles);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 x = random_vector(random, i % 2 == 0 ? 1.2 : 20);
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t t = 0; t < soup.triangles.size(); ++t)
            least = std::min(least, distance(closest_on_triangle(tree.corners(t), x).point, x));
        const NearestPlace found = tree.nearest(x);
        ASSERT_NEAR(std::sqrt(found.squared_distance), least, 1e-14 * 20) << i;
        ASSERT_NEAR(distance(found.point, x), least, 1e-14 * 20) << i;
    }
}

TEST(SurfaceShape, IsInsideWhereThePolyhedronIsThoughItIsNotConvex) {
    // A star: every second corner of a sphere is drawn in. Inside is told by the solid angle.
    Triangles star = sphere_of_triangles(2);
    for (std::size_t i = 0; i < star.points.size(); i += 2) star.points[i] *= 0.4;
    const TriangulatedSurface surface = surface_of(star);
    Random random{2};
    int inside = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 x = random_vector(random, 1.1);
        double angle = 0;
        for (std::size_t t = 0; t < star.triangles.size(); ++t) {
            const auto corners = surface.tree().corners(t);
            const Vec3 a = corners[0] - x, b = corners[1] - x, c = corners[2] - x;
            angle += 2 * std::atan2(determinant(a, b, c), norm(a) * norm(b) * norm(c) + dot(a, b) * norm(c) +
                                                              dot(b, c) * norm(a) + dot(c, a) * norm(b));
        }
        const bool is_inside = angle > 2 * std::numbers::pi;
        EXPECT_EQ(surface.signed_distance(x) < 0, is_inside) << i;
        inside += is_inside;
    }
    EXPECT_GT(inside, 100);
}

TEST(SurfaceShape, AFineSphereIsNearlyTheSphere) {
    const Shape fine = shape_within(surface_of(sphere_of_triangles(4)), {0.1, 0.2, 0.3}), exact = ball({0.1, 0.2, 0.3}, 1);
    constexpr double sagitta = 0.005;  // an edge of 0.1 is below the sphere by 0.1^2 / 8, the middle of a triangle by more
    EXPECT_NEAR(volume(fine), volume(exact), 3 * sagitta * volume(exact));
    EXPECT_NEAR(fine.surface->area(), 4 * std::numbers::pi, 0.1);
    EXPECT_NEAR(outer_radius(fine), 1, 1e-15);
    EXPECT_NEAR(bounds(fine).max.x, 1.1, 1e-14);
    Random random{3};
    for (int i = 0; i < 500; ++i) {
        const Vec3 x = random_vector(random, 2);
        EXPECT_GE(signed_distance(fine, x), signed_distance(exact, x) - 1e-14);
        EXPECT_LE(signed_distance(fine, x), signed_distance(exact, x) + sagitta);
    }
}

/// A ring about z: a tube of radius 0.3 about a circle of radius 1.
Triangles ring_of_triangles(int along, int around) {
    Triangles ring;
    for (int i = 0; i < along; ++i)
        for (int k = 0; k < around; ++k) {
            const double a = 2 * std::numbers::pi * i / along, b = 2 * std::numbers::pi * k / around;
            const double radius = 1 + 0.3 * std::cos(b);
            ring.points.push_back({radius * std::cos(a), radius * std::sin(a), 0.3 * std::sin(b)});
            const auto at = [&](int di, int dk) { return (i + di) % along * around + (k + dk) % around; };
            ring.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
            ring.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
        }
    return ring;
}

TEST(SurfaceShape, IsAsThickAsTheBallThatTouchesItFromInside) {
    const Vec3 centre{3, 0, 1};
    const Shape sphere = shape_within(surface_of(sphere_of_triangles(4)), centre);
    EXPECT_NEAR(thickness_at(sphere, centre + Vec3{0, 0, 1.2}), 2, 0.01);
    EXPECT_NEAR(neck_at(sphere, centre + Vec3{0, 0, 1.2}, true, 3), 2, 0.03);
    EXPECT_TRUE(std::isinf(neck_at(sphere, centre + Vec3{0, 0, 1.2}, true, 1.9)));
    EXPECT_TRUE(std::isinf(neck_at(sphere, centre + Vec3{0, 0, 1.2}, false, 9)));
    Triangles flat = sphere_of_triangles(5);
    for (Vec3& x : flat.points) x.z *= 0.5;
    const Shape flattened = shape_within(surface_of(flat), centre), ellipsoid{centre, {1, 1, 0.5}, {}};
    for (const double angle : {0.1, 0.7, 1.5}) {
        const Vec3 x = centre + Vec3{std::sin(angle), 0, 0.5 * std::cos(angle)};
        EXPECT_NEAR(thickness_at(flattened, x) / thickness_at(ellipsoid, x), 1, 0.1) << angle;
    }
    const Shape ring = shape_within(surface_of(ring_of_triangles(160, 48)), centre);
    EXPECT_NEAR(neck_at(ring, centre + Vec3{1, 0, 0.3}, true, 3), 0.6, 0.01);
    EXPECT_NEAR(neck_at(ring, centre + Vec3{0.7, 0, 0}, false, 3), 1.4, 0.02) << "the hole";
}

TEST(SurfaceShape, MovesAsOne) {
    Random random{4};
    const Shape start = shape_within(surface_of(sphere_of_triangles(1)), random_vector(random, 1));
    for (int i = 0; i < 100; ++i) {
        const Pose pose{random_vector(random, 3), rotation_about({1, 2, 3}, random.uniform(0, 6))};
        const Vec3 x = random_vector(random, 2);
        EXPECT_NEAR(signed_distance(placed(start, pose), placed(start, pose, x)), signed_distance(start, x), 1e-13);
        const Bounds held = bounds(placed(start, pose));
        Vec3 highest = placed(start, pose, start.centre + start.surface->points()[0]);
        for (const Vec3& p : start.surface->points())
            for (int axis = 0; axis < 3; ++axis)
                highest[axis] = std::max(highest[axis], placed(start, pose, start.centre + p)[axis]);
        EXPECT_NEAR(distance(held.max, highest), 0, 1e-14);
    }
    EXPECT_EQ(outward_shift(start, 0.3), 0);  // its triangles are the mesh's
}

TEST(SurfaceShape, IsMadeAboutItsCentroidAndTurnedRound) {
    const Triangles box = box_of_triangles({1, 2, 3}, {2, 4, 6});
    for (const Triangles& t : {box, turned_round(box)}) {
        const Shape shape = shape_within(t.points, t.triangles);
        EXPECT_NEAR(distance(shape.centre, {1.5, 3, 4.5}), 0, 1e-14);
        EXPECT_NEAR(distance(shape.semi_axes, {0.5, 1, 1.5}), 0, 1e-14);
        EXPECT_NEAR(volume(shape), 6, 1e-14);
        EXPECT_NEAR(signed_distance(shape, {1.5, 3, 6.25}), 0.25, 1e-14);
        EXPECT_NEAR(signed_distance(shape, {1.75, 3, 4.5}), -0.25, 1e-14);
    }
}

TEST(SurfaceShape, MayHaveAHollowAndParts) {
    const Triangles hollow = together(box_of_triangles({-2, -2, -2}, {2, 2, 2}),
                                      turned_round(box_of_triangles({-1, -1, -1}, {1, 1, 1})));
    const Triangles both = together(hollow, box_of_triangles({3, 0, 0}, {4, 1, 1}));
    for (const Triangles& t : {both, turned_round(both)}) {
        const TriangulatedSurface surface = surface_of(t);
        EXPECT_NEAR(surface.volume(), 64 - 8 + 1, 1e-12);
        EXPECT_EQ(surface.point_of_parts().size(), 3u);
        EXPECT_NEAR(surface.signed_distance({0, 0, 0.5}), 0.5, 1e-15);
        EXPECT_NEAR(surface.signed_distance({0, 0, 1.25}), -0.25, 1e-15);
        EXPECT_NEAR(surface.signed_distance({3.5, 0.5, 0.9}), -0.1, 1e-15);
    }
}

TEST(SurfaceShape, RefusesWhatBoundsNothingAndSaysWhere) {
    const Triangles box = box_of_triangles({0, 0, 0}, {1, 1, 1});
    Triangles t = box;
    t.triangles.pop_back();
    EXPECT_EQ(refusal_of(t), "the surface is not closed: the edge from point 3 at (1, 1, 0) m to point 5 at (1, 0, 1) m has "
                             "but one triangle, 10; of such edges there are 3");
    t = box;
    std::swap(t.triangles[3][0], t.triangles[3][1]);
    EXPECT_NE(refusal_of(t).find("turned against each other: 2 and 3 at the edge from point 5"), std::string::npos);
    t = box;
    t.triangles.insert(t.triangles.end(), {{0, 1, 7}, {1, 0, 7}});
    EXPECT_NE(refusal_of(t).find("is not a manifold: the edge from point 0"), std::string::npos);
    t = box;
    t.points[7] = {1, 0.5, std::nan("")};
    EXPECT_EQ(refusal_of(t), "the surface has a point that is not finite: point 7");
    t = box;
    t.points[3] = {0.5, 0.5, 0};  // on the edge across
    EXPECT_NE(refusal_of(t).find("has a triangle of no area: triangle 1 at (0.5, 0.5, 0) m"), std::string::npos);
    t = box;
    t.triangles[4][1] = 8;
    EXPECT_NE(refusal_of(t).find("triangle 4 with a point 8, which does not exist"), std::string::npos);
    EXPECT_EQ(refusal_of({}), "the surface has no triangles");
    EXPECT_NE(refusal_of(together(box, box_of_triangles({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}))).find("lies within another"),
              std::string::npos);
    EXPECT_NE(refusal_of(together(box, turned_round(box_of_triangles({2, 2, 2}, {2.5, 2.5, 2.5})))).find("is inside out"),
              std::string::npos);
    EXPECT_NE(refusal_of(together(box, box_of_triangles({0.4, 0.5, 0.6}, {2, 2, 2}))).find("cuts itself"), std::string::npos);
    for (const Triangles& other : {box_of_triangles({0.5, 0.5, 0.5}, {2, 2, 2}),   // edges through the diagonals of sides
                                   box_of_triangles({1, 0.25, 0.25}, {2, 0.75, 0.75}),  // side on side
                                   box_of_triangles({1, 1, 0.25}, {2, 2, 0.75})})       // edge on edge
        EXPECT_NE(refusal_of(together(box, other)).find("cuts or touches itself"), std::string::npos);
    t = together(box, box_of_triangles({1, 1, 1}, {2, 2, 2}));
    for (auto& triangle : t.triangles)
        for (int& corner : triangle)
            if (corner == 8) corner = 7;  // a corner in common
    EXPECT_EQ(refusal_of(t), "the surface touches itself at point 7 at (1, 1, 1) m");
}

TEST(Gap, OfBoxesIsThatOfTheirNearestCornersEdgesAndSides) {
    const auto box = [](const Vec3& a, const Vec3& b) {
        const Triangles t = box_of_triangles(a, b);
        return shape_within(t.points, t.triangles);
    };
    const Shape a = box({0, 0, 0}, {1, 1, 1});
    EXPECT_NEAR(gap_between(a, box({1.5, 0.2, 0.2}, {2, 0.8, 0.8})), 0.5, 1e-14);          // side, corners within it
    EXPECT_NEAR(gap_between(a, box({1.3, 1.4, 0}, {2, 2, 1})), 0.5, 1e-14);                // edges
    EXPECT_NEAR(gap_between(a, box({1.2, 1.3, 1.6}, {2, 2, 2})), 0.7, 1e-14);              // corners
    EXPECT_EQ(gap_between(a, box({0.5, 0.5, 0.5}, {2, 2, 2})), 0);                         // they cut
    EXPECT_EQ(gap_between(a, box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})), 0);                   // one in the other
    EXPECT_EQ(gap_between(box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}), a), 0);
    EXPECT_EQ(gap_between(a, ball({0.5, 0.5, 0.5}, 0.1)), 0);
    EXPECT_EQ(gap_between(ball({0.5, 0.5, 0.5}, 3), a), 0);
    EXPECT_NEAR(gap_between(a, ball({2, 2, 2}, 0.5)), std::sqrt(3.0) - 0.5, 1e-14);
    EXPECT_NEAR(gap_between({{2, 0.5, 0.5}, {0.5, 0.3, 0.2}, {}}, a), 0.5, 1e-8);
}

TEST(Gap, IsLeastOverAllPlacesOfTurnedSurfaces) {
    Random random{5};
    for (int round = 0; round < 30; ++round) {
        const Shape a = turned_box({0.5, 0.4, 0.3}, {}, random);
        Shape b = shape_within(surface_of(sphere_of_triangles(1)), {2, 0.5, -0.3}, rotation_about({1, 2, 3}, round));
        Shape e = random_ellipsoid(random);
        e.centre = {3, 1, 1};
        const double gap = gap_between(a, b), to_ellipsoid = gap_between(a, e);
        EXPECT_NEAR(gap_between(b, a), gap, 1e-13);
        double least = 1e9, least_to_ellipsoid = 1e9;
        for (int i = 0; i < 4000; ++i) {  // places of the one, projected to and fro: never nearer, and once that near
            const Vec3 on_a = closest_point(a, random_vector(random, 1));
            least = std::min(least, std::abs(signed_distance(b, closest_point(a, closest_point(b, on_a)))));
            least_to_ellipsoid = std::min(least_to_ellipsoid, signed_distance(e, closest_point(a, closest_point(e, on_a))));
        }
        EXPECT_LE(gap, least + 1e-13);
        EXPECT_NEAR(gap, least, 0.02);
        if (to_ellipsoid == 0) continue;
        EXPECT_LE(to_ellipsoid, least_to_ellipsoid * (1 + 1e-8));
        EXPECT_NEAR(to_ellipsoid, least_to_ellipsoid, 0.02);
    }
}
