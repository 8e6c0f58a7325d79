// Bodies that go where forces take them, in laws of force that are known in closed form.
#include "../io/examples.h"
#include "motion/rigid_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

Weighed ball(double mass, double radius) {
    const double moment = 0.4 * mass * radius * radius;
    return {mass, {1, 2, 3}, {Vec3{moment, 0, 0}, Vec3{0, moment, 0}, Vec3{0, 0, moment}}};
}

TEST(RigidMotion, ABoxIsWeighed) {
    Mesh mesh = cube_of_tets(2);  // of 2 mm
    for (Vec3& x : mesh.position) x = {500 * x.x, 1000 * x.y, 1500 * x.z};
    const Weighed box = weighed(mesh, Region(0), 5);
    EXPECT_NEAR(box.mass, 30, 1e-12);
    EXPECT_NEAR(distance(box.centre, {0.5, 1, 1.5}), 0, 1e-13);
    const double m12 = 30.0 / 12;
    EXPECT_NEAR(box.inertia[0].x, m12 * (4 + 9), 1e-11);
    EXPECT_NEAR(box.inertia[1].y, m12 * (1 + 9), 1e-11);
    EXPECT_NEAR(box.inertia[2].z, m12 * (1 + 4), 1e-11);
    EXPECT_NEAR(box.inertia[0].y, 0, 1e-11);
}

/// Steps through a law of force: minus an added mass times the rate, minus a drag times the velocity at the end, and
/// buoyancy. Returns the velocity, and the most rounds that a step took.
struct Fall {
    double velocity;
    int rounds;
};
Fall fall(double density, double added, double drag, double buoyancy, double dt, int steps) {
    FreeMotion motion{.density = density};
    FreeState state;
    const double volume = 4.0 / 3 * std::acos(-1.0) * 1e-3;  // of a radius of 0.1
    const Weighed body = ball(density * volume, 0.1);
    int most = 0;
    for (int n = 0; n < steps; ++n) {
        RigidStep step(motion, state, body, body.centre, {0, 0, -10}, n * dt, dt);
        step.guess_response(1000, 1e-3);
        for (int round = 1;; ++round) {
            most = std::max(most, round);
            const double end = step.end().velocity.z;
            const double missed = step.take({0, 0, buoyancy - added * step.end().rate[2] - drag * end}, {});
            if (missed < 1e-9) break;
            if (round == 50) return {NAN, round};
            step.improve();
        }
        state = step.end();
    }
    return {state.velocity.z, most};
}

TEST(RigidMotion, FallsAsBackwardEulerSaysAtAnyDensity) {
    const double volume = 4.0 / 3 * std::acos(-1.0) * 1e-3, added = 0.5 * 1000 * volume, drag = 3, dt = 0.01;
    for (const double density : {0.1, 100.0, 500.0, 1000.0, 8000.0}) {
        SCOPED_TRACE(density);
        const double buoyancy = 1000 * volume * 10, mass = density * volume;
        double exact = 0;
        for (int n = 0; n < 20; ++n)
            exact = ((mass + added) * exact + dt * (buoyancy - 10 * mass)) / (mass + added + dt * drag);
        const Fall found = fall(density, added, drag, buoyancy, dt, 20);
        EXPECT_NEAR(found.velocity, exact, 1e-7 * std::abs(exact));
        EXPECT_LE(found.rounds, 3);
    }
}

TEST(RigidMotion, AResponseThatIsNotAsGuessedIsLearnt) {
    const Fall found = fall(50, 40, 20, 41.9, 0.01, 20);  // ten times the added mass of a sphere that is alone
    EXPECT_TRUE(std::isfinite(found.velocity));
    EXPECT_LE(found.rounds, 4);
}

TEST(RigidMotion, SpinsAndFliesWithoutForces) {
    FreeState state{.pose = {}, .velocity = {1, 2, 3}, .spin = {0, 0, 2}};
    const Weighed body = ball(2, 0.1);
    RigidStep step({.density = 1}, state, body, body.centre + Vec3{0.05, 0, 0}, {}, 5, 0.1);
    EXPECT_EQ(step.take({}, {}), 0);
    const Pose pose = step.pose();
    const Vec3 arm{0.05 * std::cos(0.2), 0.05 * std::sin(0.2), 0};  // of the shape's centre, about that of mass
    EXPECT_NEAR(distance(pose.displacement, Vec3{0.1, 0.2, 0.3} + arm - Vec3{0.05, 0, 0}), 0, 2e-15);
    EXPECT_NEAR(distance(rotated(pose.rotation, {1, 0, 0}), {std::cos(0.2), std::sin(0.2), 0}), 0, 1e-15);
}

TEST(RigidMotion, WhatIsHeldStays) {
    const Weighed body = ball(2, 0.1);
    RigidStep step({.density = 1, .free = {0, 1, 1, 0, 0, 0}}, {}, body, body.centre, {0, 0, -10}, 0, 0.1);
    step.guess_response(1, 1);
    EXPECT_GT(step.take({1, 1, 0}, {1, 0, 0}), 0);
    step.improve();
    const FreeState end = step.end();
    EXPECT_EQ(end.velocity.x, 0);
    EXPECT_GT(end.velocity.y, 0);
    EXPECT_LT(end.velocity.z, 0);
    EXPECT_EQ(norm(end.spin), 0);
}

}  // namespace
}  // namespace kropla
