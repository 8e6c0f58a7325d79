#include <kropla/base/error.h>
#include <kropla/domain/domain.h>
#include "domain/layer_room.h"
#include "domain/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace kropla;

namespace {

/// A box of 8 x 8 x 16 with a ball of radius 1 at height 13, as the default case in millimetres.
Domain one_ball() {
    Domain domain;
    domain.box = {{-4, -4, 0}, {4, 4, 16}};
    domain.size = {0.2, 0.1, 0.8};
    domain.bodies = {body("droplet", ball({0, 0, 13}, 1))};
    return domain;
}

template <class Check>
std::string refusal(Check check) {
    try {
        check();
    } catch (const DomainError& error) {
        return error.what();
    }
    return "";
}

std::string placement(const Domain& domain) {
    return refusal([&] { check_placement(domain, 0, 0.5); });
}

}  // namespace

TEST(SizeField, RisesFromTheNearestBodyAndIsCapped) {
    Domain domain = one_ball();
    domain.bodies.push_back(body("second", ball({0, 0, 5}, 1)));
    const Snapshot at = snapshot(domain, 0);
    EXPECT_DOUBLE_EQ(target_size(at, {1, 0, 13}), 0.2);
    EXPECT_DOUBLE_EQ(target_size(at, {0, 0, 13}), 0.3);  // inside, one off the surface
    EXPECT_DOUBLE_EQ(target_size(at, {0, 0, 8}), 0.4);   // two off the second, three off the first
    EXPECT_DOUBLE_EQ(target_size(at, {-4, -4, 0}), std::min(0.8, 0.2 + 0.1 * (std::sqrt(57.0) - 1)));
    EXPECT_DOUBLE_EQ(target_size(Snapshot{at.box, at.size, {}}, {0, 0, 0}), 0.8);
    EXPECT_DOUBLE_EQ(target_size(Snapshot{at.box, {0.2, 0, 0.8}, at.shapes}, {0, 0, 0}), 0.2);
}

TEST(SizeField, RisesFromTheShellInsideABody) {
    Domain domain = one_ball();
    domain.bodies[0].layer = LayerOptions{.count = 2, .first_height = 0.1, .growth = 2};
    const auto size = [&](LayerOptions::Side side, double from_centre) {
        domain.bodies[0].layer->side = side;
        return target_size(snapshot(domain, 0), {0, 0, 13 - from_centre});
    };
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::outside, 1.5), 0.25);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::outside, 0.5), 0.25);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::inside, 0.5), 0.22);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::inside, 0.8), 0.2);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::inside, 1.5), 0.25);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::both, 0.5), 0.22);
    EXPECT_DOUBLE_EQ(size(LayerOptions::Side::both, 1.5), 0.25);
}

TEST(SizeField, RisesNoSteeperThanTetrahedraCan) {
    Domain domain = one_ball();
    domain.size.growth = 1;
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {0, 0, 11}), 0.2 + steepest_growth);
    domain.size.growth = 0.4;
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {0, 0, 11}), 0.2 + 0.4);
}

TEST(SizeField, IsThatOfTheNearestPlaceOfASurfaceWhereSizesAreLocal) {
    Domain domain = one_ball();
    domain.size.least = 0.05;
    domain.size.local = [](const Vec3& x) { return 0.1 + 0.1 * (x.z - 13); };
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {0, 0, 16}), 0.2 + 0.2);
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {3, 0, 13}), 0.1 + 0.2);
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {0, 0, 10}), 0.05 + 0.2);  // no less than `least`
    domain.bodies[0].motion = [](double t) { return Pose{{0, 0, t}, {}}; };
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 2), {0, 0, 17}), 0.2 + 0.1);  // no more than `surface`
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0.5), {0, 0, 11.5}), 0.05 + 0.1);  // at 12.5
    domain.bodies[0].size = 0.3;  // its own
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {0, 0, 16}), 0.3 + 0.2);
    domain.bodies[0].local_size = [](const Vec3& x) { return 0.25 - 0.1 * x.x; };
    EXPECT_DOUBLE_EQ(target_size(snapshot(domain, 0), {2, 0, 13}), 0.15 + 0.1);
}

TEST(SizeField, OfManyBodiesIsTheSameByTheirTreeWhereSizesAreLocal) {
    Domain domain{{{0, 0, 0}, {10, 10, 10}}, {}, {.surface = 0.3, .growth = 0.2, .far = 0.8, .least = 0.02}};
    for (int i = 0; i < 27; ++i)
        domain.bodies.push_back(body("ball " + std::to_string(i), ball({1.5 + 3 * (i % 3), 1.5 + 3 * (i / 3 % 3), 1.5 + i / 9 * 3}, 0.7)));
    domain.size.local = [](const Vec3& x) { return 0.3 * std::abs(std::sin(x.x + 2 * x.y - x.z)) + 1e-3; };
    const Snapshot at = snapshot(domain, 0);
    ASSERT_TRUE(at.tree);
    Snapshot without = at;
    without.tree = {};
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x{i % 10 + 0.5, i / 10 % 10 + 0.3, i / 100 + 0.1};
        ASSERT_EQ(target_size(at, x), target_size(without, x)) << i;
    }
}

TEST(LayerRoom, OfManyBodiesIsTheSameByTheirTreeAndBelowABound) {
    Domain domain{{{0, 0, 0}, {10, 10, 10}}, {}, {.surface = 0.3, .growth = 0.2, .far = 0.8}};
    for (int i = 0; i < 27; ++i) {
        const Vec3 centre{1.5 + 3 * (i % 3), 1.5 + 3 * (i / 3 % 3), 1.5 + i / 9 * 3};
        domain.bodies.push_back(body("ball " + std::to_string(i), ball(centre, 0.5 + 0.03 * i)));
        if (i % 2 == 0) domain.bodies.back().layer = LayerOptions{.count = 2, .first_height = 0.02};
    }
    const Snapshot at = snapshot(domain, 0);
    ASSERT_TRUE(at.tree);
    Snapshot without = at;
    without.tree = {};
    int beside_walls = 0, beside_bodies = 0;
    for (int i = 0; i < 27 * 20; ++i) {
        const std::size_t of = static_cast<std::size_t>(i / 20);
        const double turn = 0.3 * i;
        const Vec3 x = at.shapes[of].centre + at.shapes[of].semi_axes.x * Vec3{std::cos(turn), std::sin(turn) * 0.6, std::sin(turn) * 0.8};
        const Gap gap = nearest_gap(at, of, x), expected = nearest_gap(without, of, x);
        ASSERT_EQ(gap.room, expected.room) << i;
        ASSERT_EQ(gap.distance, expected.distance) << i;
        ASSERT_EQ(gap.wall, expected.wall) << i;
        ASSERT_EQ(gap.body, expected.body) << i;
        ++(gap.wall < 0 ? beside_bodies : beside_walls);
        ASSERT_EQ(nearest_gap(at, of, x, gap.room + 0.1).distance, gap.distance);
        ASSERT_EQ(nearest_gap(at, of, x, gap.room).distance, std::numeric_limits<double>::infinity());
    }
    EXPECT_GT(beside_walls, 50);
    EXPECT_GT(beside_bodies, 50);
}

TEST(Snapshot, TakesBodiesAlongTheirMotion) {
    Domain domain = one_ball();
    domain.bodies[0].motion = [](double t) { return Pose{{0, 0, -1000 * t}, {}}; };
    EXPECT_EQ(snapshot(domain, 0.003).shapes[0].centre, (Vec3{0, 0, 10}));
}

TEST(Placement, AcceptsWhatFits) {
    Domain domain = one_ball();
    domain.bodies.push_back(body("second", ball({0, 0, 10.8}, 1)));
    EXPECT_EQ(placement(domain), "");
}

TEST(Placement, RefusesABodyThatIsNotInside) {
    Domain domain = one_ball();
    domain.bodies[0].shape.centre.z = 0.75;
    EXPECT_EQ(placement(domain),
              "body \"droplet\" is not inside the box: its lowest z is -0.25 m, the box begins at 0 m");
    domain.bodies[0].shape.centre = {3.25, 0, 8};
    EXPECT_EQ(placement(domain),
              "body \"droplet\" is not inside the box: its highest x is 4.25 m, the box ends at 4 m");
}

TEST(Placement, RefusesABodyTooCloseToAWall) {
    Domain domain = one_ball();
    domain.bodies[0].shape.centre.y = -2.9375;
    EXPECT_EQ(placement(domain),
              "body \"droplet\" is 0.0625 m from the wall y min, too close for size.surface = 0.2 m; at most "
              "0.12 m "
              "would do");
    domain.size.surface = 0.12;
    EXPECT_EQ(placement(domain), "");
}

TEST(Placement, RefusesBodiesTooCloseOrOverlapping) {
    Domain domain = one_ball();
    domain.bodies.push_back(body("drop2", ball({0, 0, 10.9375}, 1)));
    EXPECT_EQ(
        placement(domain),
        "body \"droplet\" and body \"drop2\" are 0.0625 m apart, too close for size.surface = 0.2 m; at most "
        "0.11 m would do");  // 0.5 h + 2 * 0.15 h^2 = 0.0625
    domain.size.surface = 0.11;
    EXPECT_EQ(placement(domain), "");
    domain.size.surface = 0.2;
    domain.bodies[1].shape.centre.z = 11.5;
    EXPECT_EQ(placement(domain), "body \"droplet\" and body \"drop2\" touch or overlap");
    domain.bodies[1].shape = ball({0, 0.2, 13}, 0.3);  // one within the other
    EXPECT_EQ(placement(domain), "body \"droplet\" and body \"drop2\" touch or overlap");
}

TEST(Placement, RefusesASizeTooCoarseForTheCurvature) {
    Domain domain = one_ball();
    domain.bodies[0].shape.semi_axes = {1, 0.4, 1};
    EXPECT_EQ(placement(domain),
              "body \"droplet\" is curved with a radius of 0.16 m, too little for size.surface = 0.2 m; at "
              "most 0.16 m "
              "would do");
}

TEST(Placement, FindsTheDistanceOfEllipsoids) {
    // Two ellipsoids of which `gap` is known: tangent planes across a line, the gap between them.
    Random random{1};
    for (int i = 0; i < 30; ++i) {
        SCOPED_TRACE("pair " + std::to_string(i) + " of seed 1");
        Domain domain = one_ball();
        domain.box = {{-20, -20, -20}, {20, 20, 20}};
        Shape a = random_ellipsoid(random), b = random_ellipsoid(random);
        const Vec3 to = normalised(random_vector(random, 1));
        const auto extreme = [](const Shape& s, Vec3 direction) {  // the surface's point farthest along it
            const Vec3 d = rotated_back(s.orientation, direction), &r = s.semi_axes;
            const Vec3 p = {r.x * r.x * d.x, r.y * r.y * d.y, r.z * r.z * d.z};
            return s.centre + rotated(s.orientation, p / norm({r.x * d.x, r.y * d.y, r.z * d.z}));
        };
        const double gap = 0.01;
        b.centre += extreme(a, to) + gap * to - extreme(b, -to);
        domain.bodies = {body("a", a), body("b", b)};
        const double size = 0.02;
        domain.size.surface = size;
        const double sizes = (gap - outward_shift(a, size) - outward_shift(b, size)) / size;
        EXPECT_EQ(refusal([&] { check_placement(domain, 0, sizes - 0.001); }), "");
        EXPECT_NE(refusal([&] { check_placement(domain, 0, sizes + 0.001); }).find("are 0.01 m apart"),
                  std::string::npos);
        domain.bodies[1].shape.centre -= 1.001 * gap * to;
        EXPECT_EQ(refusal([&] { check_placement(domain, 0, 0.501); }), "body \"a\" and body \"b\" touch or overlap");
    }
}

TEST(Placement, AdvisesASizeThatDoesForAllBodies) {
    Domain domain = one_ball();
    domain.bodies.push_back(body("dust", ball({0, 0, 3}, 0.15)));
    domain.bodies.push_back(body("drop2", ball({0, 0, 10.96875}, 1)));
    EXPECT_EQ(placement(domain),
              "body \"droplet\" and body \"drop2\" are 0.0312 m apart, too close for size.surface = 0.2 m; at most "
              "0.06 m would do");
    domain.size.surface = 0.06;
    EXPECT_EQ(placement(domain), "");
}
