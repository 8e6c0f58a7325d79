// Heat in a flow that is known: gas that enters and leaves the box, around a body that moves.
#include "meshes.h"
#include "session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr Region surroundings{0};

/// The body is moved, and its surroundings up to the box with it.
Mesh moved(const Mesh& start, const Vec3& by) {
    Mesh mesh = start;
    for (Vec3& x : mesh.position) {
        const Vec3 r = x - Vec3{0.5, 0.5, 0.5};
        const double off = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
        x += std::clamp((0.5 - off) / 0.25, 0.0, 1.0) * by;
    }
    return mesh;
}

/// Along x, in layers: solenoidal, and zero within the body. What its finite elements lack of that is to be made good.
Array<Vertex, Vec3> shear(const Mesh& mesh) {
    Array<Vertex, Vec3> velocity;
    for (const Vec3& x : mesh.position) velocity.push_back({1 + 0.5 * std::sin(2 * pi * x.y) * x.z, 0, 0});
    return velocity;
}

HeatOptions gas_and_body() {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0].material = {.conductivity = 1e-3, .density = 2, .specific_heat = 3};
    options.regions[1].material = {.conductivity = 1, .density = 5, .specific_heat = 4};
    options.regions[1].carried = Carried::with_mesh;
    return options;
}

HeatReport step(const Mesh& before, const Mesh& current, const HeatOptions& options, NodalField& field, double dt) {
    const Ranks ranks = petsc().all_ranks();
    const MaterialFlow flow =
        material_flow(ranks, before, current, regions_that(Carried::with_flow, options), dt, {.velocity = shear(current)});
    return step_heat(ranks, before, current, options, flow, field, 0, dt);
}

TEST(HeatFlow, AConstantStaysOne) {
    for (const Mesh& start : {unit_cube_with_body(8), with_layer(unit_cube_with_body(8), {0.5, 0.5, 0.5}, surroundings, 2, 0.3)}) {
        HeatOptions options = gas_and_body();
        options.regions[0].initial = options.regions[1].initial = 500;
        options.faces[0] = {HeatFace::Kind::value, [](const Vec3&, double) { return 500.0; }};
        NodalField field = initial_temperature(start, options);
        const HeatReport report = step(start, moved(start, {0.04, -0.02, 0.01}), options, field, 0.1);
        EXPECT_LT(largest_difference(start, field, 500), 5e-10);
        EXPECT_NEAR(report.balance.error(), 0, 1e-12 * report.balance.after);
    }
}

TEST(HeatFlow, WhatComesInPassesThrough) {
    const Mesh start = unit_cube(8);
    HeatOptions options = gas_and_body();
    options.regions.resize(1);
    options.regions[0].initial = 300;
    options.faces[0] = {HeatFace::Kind::value, [](const Vec3&, double) { return 1000.0; }};
    NodalField field = initial_temperature(start, options);
    double before = energy(start, options, field.values);
    for (int n = 0; n < 30; ++n) {
        const HeatReport report = step(start, start, options, field, 0.1);
        EXPECT_NEAR(report.balance.error(), 0, 1e-12 * report.balance.after);
        EXPECT_NEAR(report.balance.before, before, 1e-12 * before);
        before = report.balance.after;
        const auto [least, most] = std::ranges::minmax(field.values);
        EXPECT_GE(least, 300 - 1e-7);
        EXPECT_LE(most, 1000 + 1e-7);
        if (n > 0) {
            EXPECT_GT(report.balance.faces[0], 0);
            EXPECT_LT(report.balance.faces[1], 0);
        }
    }
    for (Vertex v : start.position.indices())  // three seconds, at one half to one and a half metres a second
        EXPECT_GT(field.values[v], 990);
}

TEST(HeatFlow, ConservesWhatTablesMake) {
    const Mesh start = unit_cube_with_body(8);
    HeatOptions options = gas_and_body();
    options.regions[0].material.specific_heat = Property({300, 600, 1200}, {3, 5, 2});
    options.regions[0].initial = HeatStart([](const Vec3& x, double) { return 400 + 600 * x.x * x.y; });
    options.regions[1].initial = 800;
    NodalField field = initial_temperature(start, options);
    for (int n = 1; n <= 3; ++n) {
        const HeatReport report = step(moved(start, {0.02 * (n - 1), 0, 0}), moved(start, {0.02 * n, 0, 0}), options, field, 0.05);
        EXPECT_NEAR(report.balance.error(), 0, 1e-12 * report.balance.after);
    }
}

}  // namespace
}  // namespace kropla
