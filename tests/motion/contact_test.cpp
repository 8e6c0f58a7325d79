// Free bodies that meet walls and each other, in laws of force that are known in closed form: without a flow.
#include "motion/contact.h"
#include "motion/facing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace kropla {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double size = 0.1;  // [m] of cells at surfaces
const ContactOptions dry{.lubrication = false, .restitution = 0, .gap = 0.25 * size, .reach = 0.5 * size};

Shape ball(const Vec3& centre, double radius) { return {centre, {radius, radius, radius}, {}}; }

/// Free bodies of one density in a box, and how they go on.
struct World {
    Domain domain{.box = {{-10, -10, 0}, {10, 10, 20}}, .bodies = {}, .size = {.surface = size}};
    std::vector<FreeState> states;
    double density = 2, time = 0;
    Vec3 gravity = {0, 0, -10};

    void add(const Shape& shape, const Vec3& velocity = {}, const Vec3& spin = {}) {
        domain.bodies.push_back({.name = std::to_string(states.size()), .shape = shape});
        states.push_back({.pose = {}, .velocity = velocity, .spin = spin});
    }
    [[nodiscard]] Weighed weigh(std::size_t body) const {
        const Shape shape = now(body);
        const double mass = density * volume(shape);
        const Vec3& a = shape.semi_axes;
        const Vec3 own = mass / 5 * Vec3{a.y * a.y + a.z * a.z, a.x * a.x + a.z * a.z, a.x * a.x + a.y * a.y};
        Weighed body_of{mass, shape.centre};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                for (std::size_t k = 0; k < 3; ++k)
                    body_of.inertia[static_cast<std::size_t>(i)][j] +=
                        shape.orientation.axes[k][i] * own[static_cast<int>(k)] * shape.orientation.axes[k][j];
        return body_of;
    }
    [[nodiscard]] Shape now(std::size_t body) const { return placed(domain.bodies[body].shape, states[body].pose); }

    /// `force` acts on a body that goes at that velocity. Returns what contacts did.
    ContactReport go(const ContactOptions& options, double dt, double viscosity = 0,
                     const std::function<Vec3(const Vec3&)>& force = [](const Vec3&) { return Vec3{}; }) {
        constexpr double agreed = 1e-10;
        FreeSteps steps;
        for (std::size_t body = 0; body < states.size(); ++body)
            steps.emplace_back(body, RigidStep({.density = density}, states[body], weigh(body), now(body).centre, gravity,
                                               time, dt));
        Contacts contacts(domain, options, viscosity, steps, time, dt);
        contacts.guess();
        for (rounds = 1;; ++rounds) {
            for (auto& [body, step] : steps) (void)step.take(force(step.end().velocity), {});
            if (contacts.settle() < agreed) break;
            if (rounds == 20) ADD_FAILURE() << "does not settle";
            if (rounds == 20) break;
            contacts.improve();
        }
        for (auto& [body, step] : steps) states[body] = step.end();
        time += dt;
        return contacts.report();
    }
    int rounds = 0;  // of the last step
};

TEST(Facing, OfSpheresAndEllipsoids) {
    const Facing spheres = facing(ball({0, 0, 3}, 1), ball({0, 0, 0}, 1.5));
    EXPECT_NEAR(spheres.gap, 0.5, 1e-15);
    EXPECT_NEAR(distance(spheres.on_a, {0, 0, 2}) + distance(spheres.on_b, {0, 0, 1.5}), 0, 1e-14);
    EXPECT_NEAR(spheres.squeezed, 0.6 * 0.6, 1e-14);  // 1 * 1.5 / 2.5
    EXPECT_NEAR(facing(ball({0, 0, 2}, 1), ball({0, 0, 0}, 1.5)).gap, -0.5, 1e-15);

    // At its tip an ellipsoid has the radii b^2/a and c^2/a, and so has the gap to a wall.
    const Shape egg{{0, 0, 5}, {1, 0.8, 2}, {}};
    const Facing on_floor = facing_wall(egg, {{-9, -9, 1}, {9, 9, 9}}, 4);
    EXPECT_NEAR(on_floor.gap, 2, 1e-15);
    const double r1 = 0.5, r2 = 0.32;
    EXPECT_NEAR(on_floor.squeezed, 2 * std::pow(r1 * r2, 1.5) / (r1 + r2), 1e-14);

    const Shape a{{0.3, 0.1, 5}, {1, 0.8, 2}, rotation_about({1, 2, 0}, 0.7)}, b{{-1, 0.4, 2}, {0.5, 1.5, 0.3}, rotation_about({0, 1, 3}, 2)};
    const Facing turned = facing(a, b);
    EXPECT_GT(turned.gap, 0.1);
    EXPECT_NEAR(turned.gap, gap_between(a, b), 1e-8 * turned.gap);
    EXPECT_NEAR(distance(turned.on_a, turned.on_b), turned.gap, 1e-12);
    EXPECT_NEAR(signed_distance(a, turned.on_a), 0, 1e-14);
    EXPECT_NEAR(distance(closest_point(a, turned.on_b), turned.on_a), 0, 1e-7);
}

TEST(Contact, WhatTheMeshDoesNotResolveOfLubrication) {
    EXPECT_EQ(unresolved_resistance(3, 4, 0.5, 0.5), 0);
    EXPECT_NEAR(unresolved_resistance(3, 4, 0.2, 0.5), 6 * pi * 3 * 4 * (5 - 2), 1e-11);
}

TEST(Contact, LubricationSlowsAFallAsTheFormulaSays) {
    ContactOptions options = dry;
    options.lubrication = true;
    options.gap = 1e-4;
    World world;
    world.add(ball({1, 2, 0.5 + 0.04}, 0.5));
    const double viscosity = 50, dt = 1e-3;
    for (int n = 0; n < 100; ++n) {
        const double before = world.states[0].velocity.z;
        const ContactReport report = world.go(options, dt, viscosity);
        ASSERT_EQ(report.contacts.size(), 1u);
        const double gap = report.gaps[0], velocity = world.states[0].velocity.z, mass = world.weigh(0).mass;
        const double force = -6 * pi * viscosity * 0.25 * (1 / gap - 1 / options.reach) * velocity;
        EXPECT_NEAR(report.forces[0].z, force, 1e-9 * force);
        EXPECT_NEAR(mass * (velocity - before) / dt, force - 10 * mass, 1e-8 * force);  // implicit: of the step's end
        EXPECT_FALSE(report.contacts[0].touches);
    }
    EXPECT_LT(world.states[0].velocity.z, 0);
    EXPECT_LT(world.now(0).centre.z, 0.54);
    EXPECT_GT(world.now(0).centre.z, 0.5 + options.gap);
}

TEST(Contact, LubricationAlsoHoldsBack) {
    ContactOptions options = dry;
    options.lubrication = true;
    World world;
    world.gravity = {};
    world.add(ball({1, 2, 0.5 + 0.03}, 0.5), {0, 0, 1});
    const ContactReport report = world.go(options, 1e-3, 50);
    EXPECT_LT(report.forces[0].z, 0);
    EXPECT_GT(world.states[0].velocity.z, 0);
    EXPECT_LT(world.states[0].velocity.z, 1);
}

TEST(Contact, ASphereComesToRestOnTheFloor) {
    for (const double dt : {0.003, 0.02, 0.11}) {
        World world;
        world.add(ball({1, 2, 1.2}, 0.5));
        bool touched = false;
        for (int n = 0; n * dt < 1.5; ++n) {
            const bool rested = touched;
            const ContactReport report = world.go(dry, dt);
            touched = touched || !report.contacts.empty();
            EXPECT_GE(report.gaps[0], dry.gap * (1 - 1e-12));
            if (!rested) continue;
            EXPECT_NEAR(report.gaps[0], dry.gap, 1e-14);
            EXPECT_NEAR(world.states[0].velocity.z, 0, 1e-14);
            EXPECT_NEAR(report.forces[0].z, 10 * world.weigh(0).mass, 1e-9);
            EXPECT_EQ(world.rounds, 1);
        }
        EXPECT_TRUE(touched);
    }
}

TEST(Contact, RestitutionKeepsItsShareOfTheEnergy) {
    for (const double restitution : {1.0, 0.5}) {
        ContactOptions options = dry;
        options.restitution = restitution;
        World world;
        world.gravity = {};
        world.add(ball({1, 2, 1.0}, 0.5), {0.3, 0, -2});
        for (int n = 0; n < 40; ++n) world.go(options, 0.0107);
        EXPECT_NEAR(world.states[0].velocity.z, restitution * 2, 1e-12);
        EXPECT_NEAR(world.states[0].velocity.x, 0.3, 1e-15);  // no friction
        const double until = (0.5 - options.gap) / 2;         // of the fall
        EXPECT_NEAR(world.now(0).centre.z, 0.5 + options.gap + restitution * 2 * (world.time - until), 1e-12);
    }
}

TEST(Contact, ABallBouncesLowerAndLowerUntilItRests) {
    ContactOptions options = dry;
    options.restitution = 0.5;
    World world;
    world.add(ball({1, 2, 1.2}, 0.5));
    for (int n = 0; n < 300; ++n) world.go(options, 0.01);
    EXPECT_NEAR(world.now(0).centre.z, 0.5 + options.gap, 1e-14);
    EXPECT_NEAR(world.states[0].velocity.z, 0, 1e-14);
}

TEST(Contact, TwoSpheresHeadOnKeepMomentum) {
    for (const double restitution : {0.0, 0.7, 1.0}) {
        ContactOptions options = dry;
        options.restitution = restitution;
        World world;
        world.gravity = {};
        world.add(ball({0, 0.02, 5}, 0.5), {2, 0, 0}, {0, 0, 3});
        world.add(ball({1.5, 0, 5}, 0.7), {-1, 0.1, 0});
        const auto momentum = [&] {
            return world.weigh(0).mass * world.states[0].velocity + world.weigh(1).mass * world.states[1].velocity;
        };
        const Vec3 before = momentum();
        int touches = 0;
        for (int n = 0; n < 30; ++n) {
            const ContactReport report = world.go(options, 0.007);
            touches += !report.contacts.empty();
            EXPECT_EQ(norm(report.forces[0] + report.forces[1]), 0);
            EXPECT_GT(report.gaps[0], options.gap * (1 - 1e-9));
            EXPECT_EQ(report.gaps[0], report.gaps[1]);
        }
        EXPECT_GE(touches, 1);
        EXPECT_NEAR(distance(momentum(), before), 0, 1e-14 * norm(before));
        EXPECT_NEAR(world.states[0].spin.z, 3, 1e-14);  // the force goes through the centres
        const double apart = world.states[1].velocity.x - world.states[0].velocity.x;
        EXPECT_NEAR(apart, restitution * 3, 0.02);  // the line of centres is a little aslant
    }
}

TEST(Contact, AStackRests) {
    World world;
    world.add(ball({0, 0, 0.5 + dry.gap}, 0.5));
    world.add(ball({0, 0, 1.3 + 2 * dry.gap}, 0.3));
    for (int n = 0; n < 20; ++n) {
        const ContactReport report = world.go(dry, 0.02);
        EXPECT_EQ(report.contacts.size(), 2u);
        EXPECT_NEAR(report.forces[1].z, 10 * world.weigh(1).mass, 1e-10);
        EXPECT_NEAR(report.forces[0].z, 10 * world.weigh(0).mass, 1e-10);
        for (std::size_t body = 0; body < 2; ++body) {
            EXPECT_NEAR(report.gaps[body], dry.gap, 1e-13);
            EXPECT_NEAR(norm(world.states[body].velocity), 0, 1e-13);
        }
    }
}

TEST(Contact, AnEllipsoidTipsOverOnTheFloor) {
    World world;
    const Shape egg{{0, 0, 0.9}, {0.4, 0.3, 0.6}, rotation_about({0, 1, 0}, 0.3)};
    world.add(egg);
    const double dt = 0.01;
    double most_spin = 0, least = 1;
    for (int n = 0; n < 100; ++n) {
        const ContactReport report = world.go(dry, dt);
        least = std::min(least, report.gaps[0]);
        most_spin = std::max(most_spin, norm(world.states[0].spin));
        EXPECT_NEAR(world.states[0].velocity.x, 0, 1e-12);  // without friction nothing pushes it aside
        EXPECT_TRUE(n < 40 || report.contacts.size() == 1);
    }
    EXPECT_GE(least, dry.gap * (1 - 1e-9));
    EXPECT_GT(most_spin, 1);
    EXPECT_NEAR(world.states[0].spin.x, 0, 1e-10);
    EXPECT_NEAR(world.states[0].spin.z, 0, 1e-10);
}

// The flow takes the one along with the other: their resistances to going apart are far above their masses.
TEST(Contact, BodiesThatAreNearLearnFromEachOther) {
    for (const double apart : {1.2, 3.0}) {  // near; and too far to be asked, where each takes for its own what both do
        World world;
        world.add(ball({0, 0, 5}, 0.5));
        world.add(ball({0.1, 0, 5 + apart}, 0.5));
        FreeSteps steps;
        for (std::size_t body = 0; body < 2; ++body) {
            steps.emplace_back(body, RigidStep({.density = 2}, world.states[body], world.weigh(body), world.now(body).centre,
                                               world.gravity, 0, 0.1));
            steps.back().second.guess_response(1, 0.1);
        }
        Contacts contacts(world.domain, dry, 0, steps, 0, 0.1);
        contacts.guess();
        int rounds = 1;
        for (;; ++rounds) {
            const auto velocity = [&](std::size_t body) { return steps[body].second.end().velocity; };
            const Vec3 slip = velocity(0) - velocity(1);
            (void)steps[0].second.take(Vec3{0, 0, 5} - 200 * slip - 2 * velocity(0), {});
            (void)steps[1].second.take(200 * slip - 3 * velocity(1), {});
            if (contacts.settle() < 1e-6 || rounds == 60) break;
            contacts.improve();
        }
        EXPECT_TRUE(apart < 2 ? rounds <= 8 : rounds == 60) << rounds;
    }
}

TEST(Contact, AWallThatComesPushes) {
    World world;
    world.gravity = {};
    world.add(ball({0, 0, 5}, 0.5));
    world.domain.bodies.push_back({.name = "ram", .shape = ball({0, 0, 2}, 0.5), .motion = [](double t) {
                                       return Pose{{0, 0, 3 * t}, {}};
                                   }});
    world.states.resize(1);
    for (int n = 0; n < 60; ++n) world.go(dry, 0.02);
    EXPECT_NEAR(world.states[0].velocity.z, 3, 1e-9);
    EXPECT_NEAR(world.now(0).centre.z, 2 + 3 * 1.2 + 1 + dry.gap, 1e-9);
}

}  // namespace
}  // namespace kropla
