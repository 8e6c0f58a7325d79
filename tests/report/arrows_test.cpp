#include "report/arrows.h"

#include "tiny_run.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// Five cubes by one by five; the middle one of the section is a body.
struct Cut {
    Mesh mesh = grid_of_cubes({5, 1, 5}, [](int i, int, int k) { return Region(i == 2 && k == 2 ? 1 : 0); });
    CutPlane plane = plane_across(1, {0, 0.4, 0});
    std::vector<CutPolygon> flowing, solid;
    Cut() {
        for (const CutPolygon& polygon : cut_mesh(mesh, plane))
            (polygon.region == surroundings ? flowing : solid).push_back(polygon);
    }
};

Array<Vertex, Vec3> velocities(const Mesh& mesh, auto of) {
    Array<Vertex, Vec3> all(mesh.position.size());
    for (const Vertex v : all.indices()) all[v] = of(mesh.position[v]);
    return all;
}

TEST(Arrows, ShowALinearVelocityExactly) {
    const Cut cut;
    const auto velocity = velocities(cut.mesh, [](const Vec3& x) { return Vec3{1 + x.x, 7 * x.y, 2 * x.z}; });
    const auto all = arrows(cut.flowing, {}, cut.plane, velocity, {.spacing = 0.37, .most = 12});
    EXPECT_GT(all.size(), 150u);  // 14 rows of 13 or 14, without the body
    for (const Arrow& arrow : all) {
        const double u = 1 + arrow.place.x, w = 2 * arrow.place.y, speed = std::hypot(u, w);
        EXPECT_NEAR(arrow.direction.x, u / speed, 1e-12);
        EXPECT_NEAR(arrow.direction.y, w / speed, 1e-12);
        EXPECT_NEAR(arrow.length, 0.37 * std::sqrt(speed / 12), 1e-12);
    }
}

TEST(Arrows, StayOutOfSolids) {
    const Cut cut;
    const auto velocity = velocities(cut.mesh, [](const Vec3&) { return Vec3{1, 0, 0}; });
    const ArrowOptions options{.spacing = 0.37, .most = 1};
    const auto near = arrows(cut.flowing, {}, cut.plane, velocity, options),
               far = arrows(cut.flowing, cut.solid, cut.plane, velocity, options);
    const auto reaches = [](const Arrow& arrow) {
        const double tip = arrow.place.x + arrow.length / 2, tail = arrow.place.x - arrow.length / 2;
        return tip > 2 && tail < 3 && arrow.place.y > 2 && arrow.place.y < 3;
    };
    EXPECT_TRUE(std::ranges::any_of(near, reaches));
    EXPECT_TRUE(std::ranges::none_of(far, reaches));
    EXPECT_LT(far.size(), near.size());
}

TEST(Arrows, AreOfTheWindowAlone) {
    const Cut cut;
    const auto velocity = velocities(cut.mesh, [](const Vec3&) { return Vec3{1, 0, 0}; });
    const auto few = arrows(cut.flowing, {}, cut.plane, velocity, {.spacing = 0.001, .most = 1, .window = {{1, 1}, {1.01, 1.01}}});
    EXPECT_GE(few.size(), 80u);
    EXPECT_LE(few.size(), 155u);  // in all of the cut there are millions
}

TEST(Arrows, AreNotDrawnOfRest) {
    const Cut cut;
    const auto across = velocities(cut.mesh, [](const Vec3&) { return Vec3{0, 1, 0}; });
    EXPECT_TRUE(arrows(cut.flowing, {}, cut.plane, across, {.spacing = 0.37, .most = 1}).empty());
}

}  // namespace
}  // namespace kropla
