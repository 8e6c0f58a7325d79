// What flows or conducts in pieces that do not meet: each is known by itself. A hollow body has gas around and within it.
#include "flow_problems.h"
#include "session.h"
#include "simulate/cells.h"
#include <kropla/base/error.h>
#include <kropla/simulate/heat.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace kropla {
namespace {

constexpr Region gas{0}, shell{1};

/// The unit cube of 12^3 cubes with a hollow cube in the middle, of half the width within and 2/3 without.
Mesh hollow_body() {
    const auto place = [](int i, int j, int k) { return Vec3{i / 12.0, j / 12.0, k / 12.0}; };
    return cube_grid(12, 12, 12, place, [](int i, int j, int k) {
        const int off = std::max({std::abs(2 * i - 11), std::abs(2 * j - 11), std::abs(2 * k - 11)});
        return off < 8 && off > 6 ? 1 : 0;
    });
}
constexpr double within = 0.5, without = 2.0 / 3;

bool is_within(const Vec3& x) {
    return std::max({std::abs(x.x - 0.5), std::abs(x.y - 0.5), std::abs(x.z - 0.5)}) < within / 2 + 1e-9;
}

/// The body goes by `by` and so does what is in it; the gas around makes way.
Mesh moved(const Mesh& start, const Vec3& by) {
    Mesh mesh = start;
    for (Vec3& x : mesh.position) {
        const double off = 2 * std::max({std::abs(x.x - 0.5), std::abs(x.y - 0.5), std::abs(x.z - 0.5)});
        x += std::clamp((1 - off) / (1 - without), 0.0, 1.0) * by;
    }
    return mesh;
}

/// Two bars side by side, each from x = 0 to 1, with a gap between them.
Mesh two_bars() {
    return cube_grid(8, 5, 2, [](int i, int j, int k) { return Vec3{i / 8.0, j / 8.0, k / 8.0}; },
                     [](int, int j, int) { return j == 2 ? -1 : 0; });
}
bool in_first_bar(const Vec3& x) { return x.y < 0.3; }

FlowOptions around_hollow_body() {
    FlowOptions options = fluid(2, 0.1, {});
    options.regions.emplace_back();
    options.tolerance = 1e-10;
    return options;
}

/// What CaseError says; empty if there is none.
template <class Deed>
std::string refusal(const Deed& deed) {
    try {
        deed();
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(Pieces, CellsThatShareAVertexAreOfOne) {
    const Mesh mesh = hollow_body();
    const Pieces all = pieces_of(mesh, living_cells(mesh)), of_gas = pieces_of(mesh, living_cells(mesh, gas)),
                 of_shell = pieces_of(mesh, living_cells(mesh, shell));
    EXPECT_EQ(all.count, 1);
    EXPECT_EQ(of_shell.count, 1);
    ASSERT_EQ(of_gas.count, 2);
    const Array<Vertex, char> in_gas = vertices_of(mesh, gas);
    for (Vertex v : mesh.position.indices())
        EXPECT_EQ(of_gas.of[v], in_gas[v] == 0 ? -1 : is_within(mesh.position[v]) ? 1 : 0);
}

TEST(Pieces, GasAtRestWithinABodyIsItsBurden) {
    const Mesh mesh = hollow_body();
    for (const FlowFace::Kind at_top : {FlowFace::Kind::wall, FlowFace::Kind::open}) {
        FlowOptions options = around_hollow_body();
        options.gravity = {0, 0, -9.81};
        options.faces[5].kind = at_top;
        FlowState state = still_flow(mesh);
        const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
        const double buoyancy = 2 * 9.81 * (std::pow(without, 3) - std::pow(within, 3));
        EXPECT_LT(norm(report.bodies[0].force - Vec3{0, 0, buoyancy}), 1e-7 * buoyancy);
        EXPECT_LT(norm(report.bodies[0].torque), 1e-7 * buoyancy);
        for (Vertex v : mesh.position.indices()) {
            EXPECT_LT(norm(state.velocity[v]), 1e-8);
            if (!is_within(mesh.position[v])) continue;
            EXPECT_NEAR(state.pressure[v], 2 * 9.81 * (0.5 - mesh.position[v].z), 1e-6);  // of the mean zero
        }
    }
}

TEST(Pieces, GasWithinABodyGoesWithIt) {
    const Mesh start = hollow_body(), end = moved(start, {0.01, 0, 0.02});
    FlowState state = still_flow(start);
    for (Vertex v : start.position.indices())
        if (is_within(start.position[v])) state.velocity[v] = {0.1, 0, 0.2};
    FlowOptions options = around_hollow_body();
    options.bodies.push_back([](double) { return RigidVelocity{{0.5, 0.5, 0.5}, {0.1, 0, 0.2}, {}}; });
    const FlowReport report = step_flow(petsc().all_ranks(), start, end, options, state, 0, 0.1);
    EXPECT_LT(std::abs(report.net_flux), 1e-14);
    for (Vertex v : start.position.indices()) {
        if (!is_within(start.position[v])) continue;
        EXPECT_LT(norm(state.velocity[v] - Vec3{0.1, 0, 0.2}), 1e-8);
        EXPECT_LT(std::abs(state.pressure[v]), 1e-7);
    }
}

TEST(Pieces, WhatFlowsInNeedsAWayOutOfItsOwn) {
    const Mesh mesh = two_bars();
    FlowOptions options = fluid(1, 1, {});
    options.faces.fill({.kind = FlowFace::Kind::slip});
    options.faces[0] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({1, 0, 0})};
    options.faces[3] = {.kind = FlowFace::Kind::open};  // of the second bar alone
    FlowState state = still_flow(mesh);
    const std::string said = refusal([&] { (void)step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1); });
    EXPECT_NE(said.find("flow in without a way out at t = 0.1 s, in the part at (0, "), std::string::npos) << said;
    options.faces[1].kind = FlowFace::Kind::open;
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    EXPECT_LT(std::abs(report.net_flux), 1e-14);
}

TEST(Pieces, WhatExpandsNeedsAWayOutOfItsOwn) {
    const Mesh mesh = hollow_body();
    FlowOptions options = around_hollow_body();
    options.regions[0]->density = Property({300, 600}, {1.0, 0.5});
    options.faces[5].kind = FlowFace::Kind::open;
    FlowState state = still_flow(mesh);
    const Array<Vertex, double> temperature(mesh.position.size(), 400.0);
    EXPECT_NE(refusal([&] { (void)step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1, temperature); })
                  .find("what expands at (0.25, 0.25, 0.25) m has no way out"),
              std::string::npos);
}

TEST(Pieces, GasWithinABodyThatMovesKeepsItsHeat) {
    const Mesh start = hollow_body(), end = moved(start, {0.01, 0, 0.02});
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0].material = {.conductivity = 1e-9, .density = 2, .specific_heat = 3};
    options.regions[1].material = {.conductivity = 1e-9, .density = 5, .specific_heat = 4};
    options.regions[0].initial = options.regions[1].initial = 300;
    options.regions[1].carried = Carried::with_mesh;
    NodalField field = initial_temperature(start, options);
    for (Vertex v : start.position.indices())
        if (is_within(start.position[v])) field.values[v] = 300 + 100 * start.position[v].z;
    const Array<Vertex, double> begin = field.values;
    const HeatReport report = step_heat(petsc().all_ranks(), start, end, options, field, 0, 0.1);
    EXPECT_NEAR(report.balance.error(), 0, 1e-12 * report.balance.after);
    for (Vertex v : start.position.indices()) EXPECT_NEAR(field.values[v], begin[v], 1e-6);
}

TEST(Pieces, EachComesToItsOwnTemperature) {
    const Mesh mesh = two_bars();
    HeatOptions options{.regions = std::vector<HeatRegion>(1)};
    options.regions[0].material = {.conductivity = 1, .density = 1, .specific_heat = 1};
    options.regions[0].initial.profile = [](const Vec3& x, double) { return 300 + (in_first_bar(x) ? 100 : 200) * x.x; };
    NodalField field = initial_temperature(mesh, options);
    (void)step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, 1e14);
    for (Vertex v : mesh.position.indices())
        EXPECT_NEAR(field.values[v], in_first_bar(mesh.position[v]) ? 350 : 400, 1e-9);
}

TEST(Pieces, ASteadyStateIsToBeKnownInEach) {
    const Mesh mesh = two_bars();
    HeatOptions options{.regions = std::vector<HeatRegion>(1)};
    options.regions[0].material = {.conductivity = 1, .density = 1, .specific_heat = 1};
    options.regions[0].initial.steady = true;
    options.faces[2] = {HeatFace::Kind::value, [](const Vec3&, double) { return 400.0; }};  // of the first alone
    EXPECT_NE(refusal([&] { (void)initial_temperature(petsc().all_ranks(), mesh, options); })
                  .find("no steady state, or more than one, in the part at (0, 0.375, 0) m"),
              std::string::npos);
    options.faces[0] = options.faces[2];
    EXPECT_LT(largest_difference(mesh, initial_temperature(petsc().all_ranks(), mesh, options), 400), 1e-6);
}

// A body that begins with a steady state in what is kept at a number: its surface is as warm as that.
TEST(Pieces, ASteadyBodyHasTheTemperatureAroundIt) {
    const Mesh mesh = unit_cube_with_body(8);
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    for (HeatRegion& region : options.regions) region.material = {.conductivity = 1, .density = 1, .specific_heat = 1};
    options.regions[0].initial = 300;
    options.regions[1].initial.steady = true;
    EXPECT_LT(largest_difference(mesh, initial_temperature(petsc().all_ranks(), mesh, options), 300), 1.7e-7);
}

// A gas that expands over a plate at rest, through which nothing flows.
TEST(Pieces, WhatExpandsMayBeBesideWhatRests) {
    const Mesh mesh = unit_cube_with_body(4);
    const Property density({300, 600}, {1.0, 0.5});
    FlowOptions options{.regions = {FlowRegion{.density = density, .viscosity = 0.1}, std::nullopt}};
    options.faces[5].kind = FlowFace::Kind::open;
    FlowState state = still_flow(mesh);
    const Array<Vertex, double> temperature(mesh.position.size(), 400.0), begin(mesh.position.size(), 1.0);
    state.density = begin;
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1, temperature);
    const MaterialFlow flow = material_flow(petsc().all_ranks(), mesh, mesh, {gas, shell}, 0.1,
                                            {state.velocity, begin, state.density, report.through});
    EXPECT_EQ(flow.by_mass, gas);
    EXPECT_TRUE(flow.potential[shell].empty());
    EXPECT_FALSE(flow.potential[gas].empty());
}

}  // namespace
}  // namespace kropla
