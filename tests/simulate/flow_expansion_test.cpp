// A gas whose density depends on the temperature: it makes room where it is heated, and its mass is kept.
#include "flow_problems.h"
#include "session.h"
#include <kropla/base/error.h>
#include <kropla/simulate/heat.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

namespace kropla {
namespace {

const Property thinning({300, 600}, {1.0, 0.25});  // [kg/m^3]
double density_at(double temperature) { return thinning(temperature); }

/// In a shaft along z with slipping walls that is open at its upper end, and has this velocity at the lower one.
FlowOptions in_a_shaft(double inflow) {
    FlowOptions options{.regions = {FlowRegion{.density = thinning, .viscosity = 0.01}}};
    options.faces.fill({.kind = FlowFace::Kind::slip});
    options.faces[4] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({0, 0, inflow})};
    options.faces[5] = {.kind = FlowFace::Kind::open};
    options.tolerance = 1e-10;
    return options;
}

Array<Vertex, double> temperatures(const Mesh& mesh, const std::function<double(const Vec3&)>& at) {
    Array<Vertex, double> temperature(mesh.position.size(), 300.0);
    for (Vertex v : mesh.position.indices()) temperature[v] = at(mesh.position[v]);
    return temperature;
}

double sum_of(const std::vector<FaceMass>& through) {
    return std::accumulate(through.begin(), through.end(), 0.0, [](double sum, const FaceMass& part) { return sum + part.rate; });
}

/// Along a shaft in which the temperature rises evenly, from 300 to 500 K; the error of the velocity.
double through_a_shaft(int n) {
    const Mesh mesh = unit_cube(n);
    const auto temperature = [](const Vec3& x) { return 300 + 200 * x.z; };
    FlowOptions options = in_a_shaft(2);
    options.scheme = FlowScheme::steady;
    FlowState state = still_flow(mesh);
    const FlowReport report =
        step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1, temperatures(mesh, temperature));
    EXPECT_LT(std::abs(sum_of(report.through)), 1e-9);
    EXPECT_LT(std::abs(report.mass_error), 1e-9);
    return velocity_error(mesh, state, [&](const Vec3& x) { return Vec3{0, 0, 2 / density_at(temperature(x))}; });
}

TEST(FlowExpansion, ASteadyFlowGoesFasterWhereItIsHot) {
    const double coarse = through_a_shaft(6), fine = through_a_shaft(12);
    RecordProperty("errors", std::to_string(coarse) + " " + std::to_string(fine));
    EXPECT_LT(fine, 9.9e-4);
    EXPECT_GT(std::log2(coarse / fine), 1.8);
}

/// A gas at rest at the shaft's lower end that is heated evenly, 100 K/s, on a mesh that is shaken: the error at the end.
double heated_evenly(int n, double shake, FlowScheme scheme, double& mass_error) {
    FlowOptions options = in_a_shaft(0);
    options.scheme = scheme;
    const Mesh start = unit_cube(8);
    FlowState state = still_flow(start);
    const double dt = 1.0 / n;
    const auto temperature = [&](double t) { return 300 + 100 * t; };
    const auto rise = [&](double t) { return 100 * (1.0 - 0.25) / 300 / density_at(temperature(t)); };
    for (Vertex v : start.position.indices()) state.velocity[v] = {0, 0, rise(0) * start.position[v].z};
    state.density = Array<Vertex, double>(start.position.size(), density_at(300));
    Mesh before = start;
    for (int step = 1; step <= n; ++step) {
        const Mesh current = moved(start, {}, 0, shake, 10u + unsigned(step));
        const FlowReport report = step_flow(petsc().all_ranks(), before, current, options, state, (step - 1) * dt, dt,
                                            temperatures(current, [&](const Vec3&) { return temperature(step * dt); }));
        mass_error = std::max(mass_error, std::abs(report.mass_error));
        before = current;
    }
    return velocity_error(before, state, [&](const Vec3& x) { return Vec3{0, 0, rise(1) * x.z}; });
}

TEST(FlowExpansion, AGasThatIsHeatedMakesRoom) {
    double mass_error = 0;
    const double resting = heated_evenly(8, 0, FlowScheme::second_order, mass_error),
                 shaken_errors[] = {heated_evenly(4, 0.01, FlowScheme::second_order, mass_error),
                                    heated_evenly(8, 0.01, FlowScheme::second_order, mass_error)};
    RecordProperty("errors", std::to_string(resting) + " " + std::to_string(shaken_errors[0]) + " " +
                                 std::to_string(shaken_errors[1]));
    RecordProperty("mass_error", std::to_string(mass_error));
    EXPECT_LT(resting, 5.2e-5);
    EXPECT_LT(shaken_errors[1], 6.2e-5);
    EXPECT_LT(mass_error, 1e-10);
}

/// A body that moves, with prisms around it, in a gas whose faces across x are open: densities by temperatures that are
/// given, waves that travel, so that mass flows in and out of each vertex.
class AroundABody : public testing::Test {
protected:
    FlowOptions flow{.regions = {FlowRegion{.density = thinning, .viscosity = 0.02}, {}}};
    FlowState state;
    Mesh before, current;
    FlowReport report;

    void SetUp() override {
        flow.faces[0].kind = flow.faces[1].kind = FlowFace::Kind::open;
        flow.tolerance = 1e-11;
        before = place(0);
        state = still_flow(before);
        for (double temperature : wave(before, 0)) state.density.push_back(density_at(temperature));
    }

    static Mesh place(int step) {
        return moved(cube_with_layers(8, false), {0.02 * step, 0, -0.01 * step}, 0.03 * step, 0.004, 7u + unsigned(step));
    }
    static Array<Vertex, double> wave(const Mesh& mesh, int step) {
        return temperatures(mesh, [&](const Vec3& x) { return 450 + 100 * std::sin(3 * x.x - 2 * x.y + x.z + 0.3 * step); });
    }

    SolvedFlow step_to(int step, const Array<Vertex, double>& temperature) {
        SolvedFlow solved{.density_before = state.density};
        current = place(step);
        report = step_flow(petsc().all_ranks(), before, current, flow, state, 0.1 * step, 0.1, temperature);
        solved.velocity = state.velocity;
        solved.density = state.density;
        solved.through = report.through;
        return solved;
    }
};

TEST_F(AroundABody, MassIsKeptHoweverWellItIsSolved) {
    flow.tolerance = 1e-2;
    const auto mass = [&](const Mesh& mesh) {
        return energy(mesh, {.regions = std::vector<HeatRegion>(2)}, state.density, Region(0));
    };
    double held = mass(before);
    for (int step = 1; step <= 3; ++step) {
        step_to(step, wave(place(step), step));
        EXPECT_LT(std::abs(report.mass_error), 1e-15);
        const double now = mass(current);
        EXPECT_NEAR(now - held, -0.1 * sum_of(report.through), 1e-14);
        EXPECT_GT(std::abs(now - held), 1e-3);
        held = now;
        before = current;
    }
}

TEST_F(AroundABody, WhatIsConstantPerMassStaysConstant) {
    HeatOptions heat{.regions = std::vector<HeatRegion>(2)};
    heat.regions[0].material = {.conductivity = 1e-3, .density = thinning, .specific_heat = Property({300, 600}, {1000, 1500})};
    heat.regions[1].material = {.conductivity = 1, .density = 5, .specific_heat = 4};
    heat.regions[1].carried = Carried::with_mesh;
    NodalField field{"temperature", "K", temperatures(before, [](const Vec3&) { return 500; })};
    for (int step = 1; step <= 3; ++step) {
        const SolvedFlow solved = step_to(step, wave(place(step), step));
        const MaterialFlow carries = material_flow(petsc().all_ranks(), before, current, {Region(0)}, 0.1, solved);
        const HeatReport found = step_heat(petsc().all_ranks(), before, current, heat, carries, field, 0, 0.1);
        EXPECT_LT(largest_difference(current, field, 500), 1e-8);
        EXPECT_LT(std::abs(found.balance.error()), 1e-11 * found.balance.after);
        before = current;
    }
}

// A hot spot in it, with what it takes along: no new extremum.
TEST_F(AroundABody, EnergyIsKeptWithinBounds) {
    HeatOptions heat{.regions = std::vector<HeatRegion>(2)};
    heat.regions[0].material = {.conductivity = 1e-3, .density = thinning, .specific_heat = Property({300, 600}, {1000, 1500})};
    heat.regions[1].material = {.conductivity = 1, .density = 5, .specific_heat = 4};
    heat.regions[1].carried = Carried::with_mesh;
    NodalField field{"temperature", "K", temperatures(before, [](const Vec3& x) { return x.x + x.z < 0.4 ? 600 : 300; })};
    for (Vertex v : state.density.indices()) state.density[v] = density_at(field.values[v]);
    for (int step = 1; step <= 2; ++step) {
        const FlowState begin = state;
        const NodalField old = field;
        Array<Vertex, double> guess = field.values;
        HeatReport found;
        for (int round = 0; round < 2; ++round) {
            state = begin;
            const SolvedFlow solved = step_to(step, guess);
            const MaterialFlow carries = material_flow(petsc().all_ranks(), before, current, {Region(0)}, 0.1, solved);
            field = old;
            found = step_heat(petsc().all_ranks(), before, current, heat, carries, field, 0, 0.1);
            guess = field.values;
        }
        EXPECT_LT(std::abs(found.balance.error()), 1e-11 * found.balance.after);
        const auto [least, most] = std::ranges::minmax(field.values);
        EXPECT_GE(least, 300 - 1e-7);
        EXPECT_LE(most, 600 + 1e-7);
        before = current;
    }
}

TEST(FlowExpansion, NeedsAWayOutAndOneRegion) {
    FlowOptions options = in_a_shaft(0);
    options.faces[5].kind = FlowFace::Kind::slip;
    EXPECT_THROW(check_flow(options, unit_cube(2)), CaseError);
}

}  // namespace
}  // namespace kropla
