#include "base/random.h"
#include "generate/box.h"
#include "generate/clearance.h"
#include "generate/domains.h"
#include <kropla/generate/generate.h>
#include "generate/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace kropla;

namespace {

double nearest_distance(const std::vector<Vec3>& points, const Vec3& x) {
    double nearest = 1e300;
    for (const Vec3& p : points)
        if (p != x) nearest = std::min(nearest, distance(p, x));
    return nearest;
}

/// A spacing that varies tenfold across the unit cube.
SampleRule graded_rule() {
    SampleRule rule;
    rule.spacing = [](const Vec3& x) { return 0.03 + 0.27 * x.x; };
    rule.spacing_slope = 0.27;
    rule.clearance = [](const Vec3& x) { return 0.45 - distance(x, {0.5, 0.5, 0.5}); };
    return rule;
}

Vec3 random_point(const Box& room, Random& random) {
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(room.min[axis], room.max[axis]);
    return x;
}

}  // namespace

TEST(PointGrid, SeesWhatALookAtAllPointsSees) {
    Random random{1};
    PointGrid grid;
    std::vector<Vec3> points;
    const Box cube{{-1, -1, -1}, {1, 1, 1}};
    for (int i = 0; i < 500; ++i) {
        points.push_back(random_point(cube, random));
        grid.insert(points.back(), std::exp2(random.uniform(-8, 2)));  // filed over ten levels
    }
    for (int i = 0; i < 500; ++i) {
        const Vec3 x = random_point(cube, random);
        const double radius = random.uniform(0, 0.5);
        EXPECT_EQ(grid.any_within(x, radius, 1e-9, 9), nearest_distance(points, x) < radius);
    }
}

TEST(Sampling, KeepsItsRule) {
    const SampleRule rule = graded_rule();
    Random random{3};
    PointGrid taken;
    const std::vector<Vec3> points = fill_room({{0, 0, 0}, {1, 1, 1}}, rule, taken, random);
    ASSERT_GT(points.size(), 190u);
    for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_GE(rule.clearance(points[i]), 0);
        for (std::size_t k = 0; k < i; ++k)  // of two points, the later one was held against its own spacing
            EXPECT_GE(distance(points[k], points[i]), rule.spacing(points[i]));
    }
}

TEST(Sampling, LeavesNoPlaceForAnother) {
    const SampleRule rule = graded_rule();
    for (const Box& room :
         {Box{{0, 0, 0}, {1, 1, 1}}, Box{{0, 0, 0.4}, {1, 1, 0.4}}}) {  // the second is flat
        Random random{3};
        PointGrid taken;
        const std::vector<Vec3> points = fill_room(room, rule, taken, random);
        for (int i = 0; i < 20000; ++i) {
            const Vec3 x = random_point(room, random);
            if (rule.clearance(x) < 0) continue;
            EXPECT_LE(nearest_distance(points, x), rule.spacing(x)) << x.x << " " << x.y << " " << x.z;
        }
    }
}

TEST(Sampling, StaysInAFlatRoomAndCountsWhatIsTaken) {
    SampleRule rule = graded_rule();
    Random random{1};
    PointGrid taken;
    const Box face{{0, 0, 0.4}, {1, 1, 0.4}};
    const std::vector<Vec3> points = fill_room(face, rule, taken, random);
    ASSERT_GT(points.size(), 27u);
    for (const Vec3& x : points) EXPECT_EQ(x.z, 0.4);
    EXPECT_TRUE(fill_room(face, rule, taken, random).empty());  // it is full
}

TEST(Points, BoxEdgesAreDividedByTheSizeField) {
    Domain domain = small_domain({ball({2, 2, 2}, 0.6)});
    domain.size = {0.1, 0.3, 0.8};
    const Snapshot at = snapshot(domain, 0);
    std::vector<Vec3> points = box_corners(at.box);
    const std::vector<Vec3> inner = sample_box_edges(at);
    points.insert(points.end(), inner.begin(), inner.end());
    for (int axis = 0; axis < 3; ++axis) {  // the edges at the corner x max, y max, z min
        const Vec3 corner{3, 3, 0};
        std::vector<double> places;
        for (const Vec3& x : points)
            if (x[(axis + 1) % 3] == corner[(axis + 1) % 3] && x[(axis + 2) % 3] == corner[(axis + 2) % 3])
                places.push_back(x[axis]);
        std::ranges::sort(places);
        ASSERT_GT(places.size(), 5u);
        for (std::size_t i = 1; i < places.size(); ++i) {
            Vec3 middle = corner;
            middle[axis] = 0.5 * (places[i] + places[i - 1]);
            EXPECT_NEAR((places[i] - places[i - 1]) / target_size(at, middle), 1, 0.0584);
        }
    }
}

TEST(Points, LieOnTheirBoundariesOrClearOfThem) {
    const Snapshot at =
        snapshot(small_domain({ball({0, 0, 2}, 1), turned_ellipsoid({0, 0, 5.5}, {1, 1.4, 1.2})}), 0);
    const PointSet set = sample_points(at, 1);
    ASSERT_EQ(set.surfaces.size(), 2u);
    std::size_t fixed = 0;
    for (std::size_t body = 0; body < 2; ++body) {
        EXPECT_EQ(set.first_of_surface[body], static_cast<int>(fixed));
        for (const Vec3& x : set.surfaces[body].points) EXPECT_EQ(set.points[fixed++], x);
    }
    std::array<int, 6> on_face = {};
    for (std::size_t i = fixed; i < set.points.size(); ++i) {
        const Patch face = shared_face(at.box, {set.points[i]});
        if (face.exists()) ++on_face[static_cast<std::size_t>(face.value)];
        else EXPECT_GE(clearance(at, set.points[i]), 0);
    }
    for (int count : on_face)
        EXPECT_GT(count, 30);  // some 10 x 10 points on the largest, half on the smallest
}

TEST(Points, FarAndSurfaceSizesMayDifferFiftyfold) {
    Domain domain = small_domain({ball({1, 0, 4}, 0.1)});
    domain.size = {0.02, 0.3, 1};
    const PointSet set = sample_points(snapshot(domain, 0), 1);
    EXPECT_GT(set.points.size(), 3000u);
    EXPECT_LT(set.points.size(), 8000u);  // evenly at the surface's size there would be 7e7
}

TEST(Points, AreTheSameForTheSameSeedAndOthersForAnother) {
    const Snapshot at = snapshot(small_domain({ball({0, 0, 4}, 1)}), 0);
    EXPECT_EQ(sample_points(at, 7).points, sample_points(at, 7).points);
    EXPECT_NE(sample_points(at, 7).points, sample_points(at, 8).points);
}
