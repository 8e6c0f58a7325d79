// Blocks, cylinders, and what faces of a box leave of bodies.
#include "base/random.h"
#include "domain/cut.h"
#include "domain/surfaces.h"
#include <kropla/base/error.h>
#include <kropla/domain/solids.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace kropla;

namespace {

const Box box = {{0, 0, 0}, {4, 3, 2}};

/// How far outside of an axis-parallel block [m], negative inside.
double distance_to_block(const Vec3& min, const Vec3& max, const Vec3& x) {
    Vec3 out;
    double most = -1e9;
    for (int axis = 0; axis < 3; ++axis) {
        const double d = std::max(min[axis] - x[axis], x[axis] - max[axis]);
        out[axis] = std::max(0.0, d);
        most = std::max(most, d);
    }
    return most > 0 ? norm(out) : most;
}

Vec3 in_box(Random& random) {
    return {random.uniform(0, 4), random.uniform(0, 3), random.uniform(0, 2)};
}

Shape unit_ball_at(const Vec3& centre) {
    const Triangles t = sphere_of_triangles(4);
    return shape_within(make_surface(t.points, t.triangles), centre);
}

}  // namespace

TEST(Solids, SlabWithinTheBox) {
    const Shape block = slab(box, {1, 1, 0.5}, {2, 2.5, 1.5});
    EXPECT_EQ(reached_faces(block), 0u);
    EXPECT_NEAR(volume(block), 1.5, 1e-14);
    EXPECT_LT(distance(block.centre, {1.5, 1.75, 1}), 1e-14);
}

TEST(Solids, PoolThroughFiveFaces) {
    const Shape pool = slab(box, {-1, -7, 0}, {4, 3, 0.75});  // as far out, or just to the face
    EXPECT_EQ(reached_faces(pool), 0b011111u);
    EXPECT_NEAR(volume(pool), 4 * 3 * 0.75, 1e-13);
    EXPECT_LT(distance(pool.centre, {2, 1.5, 0.375}), 1e-13);
    EXPECT_NEAR(pool.surface->area(), 12, 1e-13);  // only the top is there
    Random random{7};
    for (int i = 0; i < 200; ++i) {
        const Vec3 x = in_box(random);
        EXPECT_NEAR(signed_distance(pool, x), x.z - 0.75, 1e-14) << "seed 7, place " << i;
    }
    EXPECT_NEAR(signed_distance(pool, {0, 0, 0}), -0.75, 1e-15);
    EXPECT_NEAR(signed_distance(pool, {4, 1, 2}), 1.25, 1e-15);
}

TEST(Solids, BlockAtAnEdgeOfTheBox) {
    const Shape block = slab(box, {2.5, 1, 1.25}, {9, 2, 9});  // through x max and z max
    EXPECT_EQ(reached_faces(block), 0b100010u);
    EXPECT_NEAR(volume(block), 1.5 * 1 * 0.75, 1e-14);
    Random random{8};
    for (int i = 0; i < 500; ++i) {
        const Vec3 x = in_box(random);
        EXPECT_NEAR(signed_distance(block, x), distance_to_block({2.5, 1, 1.25}, {9, 2, 9}, x), 1e-14) << "seed 8, " << i;
    }
}

TEST(Solids, CylinderThroughAFace) {
    const Shape wire = cylinder(box, {1, 1, 1.2}, {1, 1, 2}, 0.3);
    EXPECT_EQ(reached_faces(wire), 0b100000u);
    EXPECT_NEAR(volume(wire), std::numbers::pi * 0.09 * 0.8, 1e-13);
    EXPECT_LT(distance(wire.centre, {1, 1, 1.6}), 1e-13);
    EXPECT_NEAR(signed_distance(wire, {1, 1, 2}), -0.3, 1.5e-4);
    EXPECT_NEAR(signed_distance(wire, {1.5, 1, 2}), 0.2, 1.5e-4);
    // Slanted, its end's middle on the face: all of the end is beyond.
    const Shape slanted = cylinder(box, {1.5, 1.5, 1}, {2, 1.5, 2}, 0.3);
    EXPECT_EQ(reached_faces(slanted), 0b100000u);
    const double length = std::sqrt(1.25);  // the cut is symmetric about the axis
    EXPECT_NEAR(volume(slanted), std::numbers::pi * 0.09 * length, 1e-6);
    EXPECT_EQ(reached_faces(cylinder(box, {1, 1, 0.5}, {2, 2, 1.5}, 0.3)), 0u);
}

TEST(Solids, BallCutByFaces) {
    const Shape whole = unit_ball_at({0, 0, 0}), eighth = cut_by(box, whole);
    EXPECT_EQ(reached_faces(eighth), 0b010101u);
    EXPECT_NEAR(volume(eighth), volume(whole) / 8, 1e-14);
    EXPECT_LT(distance(eighth.centre, Vec3{0.375, 0.375, 0.375}), 2e-3);
    const Shape cap = cut_by(box, unit_ball_at({2, 1.5, -0.4}));
    EXPECT_NEAR(volume(cap), std::numbers::pi / 3 * 0.36 * (3 - 0.6), 8.5e-3);
    EXPECT_NEAR(signed_distance(cap, {2, 1.5, 0}), -0.6, 1.6e-3);
    EXPECT_NEAR(signed_distance(cap, {2, 0, 0}), 1.5 - std::sqrt(1 - 0.16), 1e-3);
}

TEST(Solids, WhatCannotBe) {
    const auto why = [](const auto& make) {
        try {
            (void)make();
        } catch (const DomainError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(why([] { return slab(box, {1, 2, 0}, {2, 2, 1}); }), "its min is not below its max along y: 2 m and 2 m");
    EXPECT_EQ(why([] { return slab(box, {-1, -1, -1}, {5, 5, 5}); }), "nothing of its surface is in the box");
    EXPECT_EQ(why([] { return cylinder(box, {1, 1, 1}, {1, 1, 1}, 1); }), "its two ends are in one place: (1, 1, 1) m");
    EXPECT_EQ(why([] { return cut_by(box, unit_ball_at({9, 9, 9})); }), "nothing of its surface is in the box");
    const Triangles block = box_of_triangles({1, 1, 0}, {5, 2, 1});
    EXPECT_EQ(why([&] { return cut_by(box, shape_within(block.points, block.triangles)); }),
              "a part of its surface lies in the wall z min, at (1, 1, 0) m; it is to end before, or to reach through");
}
