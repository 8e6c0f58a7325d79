// What the method has exactly: uniform flows and linear pressures, on meshes of tets and prisms that move
// anyhow.
#include "flow_problems.h"
#include "session.h"
#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// `on` its way, 0 to 5, all but the body's surface shaken.
Mesh place_at(const Mesh& start, double on, std::uint64_t seed) {
    const double s = std::sin(1.3 * on);
    return moved(start, {0.06 * s, -0.03 * on / 4, 0.08 * s * s}, 0.05 * on, 0.004, seed);
}
Mesh place_at_step(const Mesh& start, int step) { return place_at(start, step, 100u + unsigned(step)); }

double largest_difference(const Mesh& mesh, const FlowState& state, const Vec3& velocity) {
    double largest = 0;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v)) largest = std::max(largest, distance(state.velocity[v], velocity));
    return largest;
}

void set_velocity(FlowState& state, const Vec3& velocity) {
    for (Vec3& u : state.velocity) u = velocity;
}

TEST(FlowExact, AUniformFlowIsKeptOnAnyMovingMesh) {
    const Vec3 wind{3, -1, 2};
    const Mesh start = cube_with_layers(8, true);
    FlowOptions options = fluid(1.6, 2e-3, uniform(wind));
    options.regions.push_back(FlowRegion{.density = 7000, .viscosity = 5e-3});
    options.tolerance = 1e-12;
    for (FlowScheme scheme : {FlowScheme::second_order, FlowScheme::first_order}) {
        options.scheme = scheme;
        FlowState state = still_flow(start);
        set_velocity(state, wind);
        Mesh before = place_at_step(start, 0);
        for (int step = 1; step <= 3; ++step) {
            const Mesh current = place_at_step(start, step);
            const FlowReport report =
                step_flow(petsc().all_ranks(), before, current, options, state, 0.01 * step, 0.01);
            EXPECT_LT(largest_difference(current, state, wind) / norm(wind), 1e-12) << "step " << step;
            EXPECT_LT(std::abs(report.net_flux), 1e-13 * norm(wind));
            EXPECT_NEAR(report.face_flux[1], 3, 1e-12);
            EXPECT_GT(report.largest_courant, 0.1);
            before = current;
        }
    }
}

TEST(FlowExact, MomentumOfAUniformFlowIsBalancedOnAMovingMesh) {
    const Vec3 wind{3, -1, 2};
    const Mesh start = cube_with_layers(8, true);
    FlowOptions options = fluid(1.6, 2e-3, uniform(wind));
    options.regions.push_back(FlowRegion{.density = 1.6, .viscosity = 2e-3});
    options.tolerance = 1e-12;
    FlowState state = still_flow(start);
    set_velocity(state, wind);
    const FlowReport report = step_flow(petsc().all_ranks(), place_at_step(start, 0), place_at_step(start, 1), options, state, 0, 0.01);
    EXPECT_LT(norm(report.momentum - 1.6 * wind), 1e-12);
    EXPECT_LT(norm(report.momentum_error), 2e-14);
}

// Against it: what is left of a wind that is not there at the start, by the same steps.
TEST(FlowExact, AUniformFlowIsFoundFromRest) {
    const Vec3 wind{3, -1, 2};
    const Mesh mesh = cube_with_layers(8, true);
    FlowOptions options = fluid(1, 1, uniform(wind));
    options.regions.push_back(options.regions[0]);
    options.scheme = FlowScheme::steady;
    options.tolerance = 1e-11;
    FlowState state = still_flow(mesh);
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1);
    EXPECT_LT(largest_difference(mesh, state, wind) / norm(wind), 1e-9);
    RecordProperty("iterations", report.iterations);
}

TEST(FlowExact, HydrostaticPressureIsLinear) {
    const Mesh start = cube_with_layers(8, false);
    FlowOptions options{.regions = {FlowRegion{.density = 1000, .viscosity = 1e-3}, {}}};
    options.gravity = {1, 2, -9.81};
    options.tolerance = 1e-12;
    FlowState state = still_flow(start);
    const Mesh mesh = place_at_step(start, 0);
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    const double top = 1000 * norm(options.gravity);
    const auto exact = [&](const Vec3& x) { return 1000 * dot(options.gravity, x - Vec3{0.5, 0.5, 0.5}); };
    EXPECT_LT(largest_difference(mesh, state, {}), 1e-9);
    const double shift = state.pressure[Vertex{0}] - exact(mesh.position[Vertex{0}]);
    EXPECT_LT(pressure_error(mesh, state, [&](const Vec3& x) { return exact(x) + shift; }) / top, 1e-9);
    ASSERT_EQ(report.bodies.size(), 1u);
    const Vec3 buoyancy =
        -1000 * 0.35 * 0.35 * 0.35 * options.gravity;  // what the body displaces, after its layer
    EXPECT_LT(distance(report.bodies[0].force, buoyancy) / norm(buoyancy), 1e-8);
    EXPECT_LT(norm(report.bodies[0].torque) / norm(buoyancy), 1e-8);
    Vec3 on_all = report.bodies[0].force;  // the weight of the liquid
    for (const Vec3& force : report.face_force) on_all += force;
    EXPECT_LT(distance(on_all, 1000 * options.gravity + buoyancy) / norm(buoyancy), 1e-8);
    EXPECT_GT(report.face_force[1].x, 100);
}

// All is carried along: the velocity is uniform, and the pressure balances what accelerates it.
double pressure_error_of_frame(const FlowScheme scheme, int steps) {
    const Mesh start = cube_with_layers(4, true);
    const auto speed = [](double t) { return std::sin(3 * t) + t * t; };
    const auto rise = [](double t) { return 3 * std::cos(3 * t) + 2 * t; };
    FlowOptions options = fluid(2, 0.1, velocity_of([&](const Vec3&, double t) {
                                    return Vec3{0, 0, speed(t)};
                                }));
    options.regions.push_back(options.regions[0]);
    options.gravity = {0, 0, -9.81};
    options.scheme = scheme;
    options.tolerance = 1e-11;
    FlowState state = still_flow(start);
    Mesh before = place_at_step(start, 0);
    for (int step = 1; step <= steps; ++step) {
        const Mesh current = place_at(start, 5.0 * step / steps, unsigned(step));
        step_flow(petsc().all_ranks(), before, current, options, state, (step - 1.0) / steps, 1.0 / steps);
        EXPECT_LT(largest_difference(current, state, {0, 0, speed(1.0 * step / steps)}), 1e-8);
        before = current;
    }
    return pressure_error(before, state, [&](const Vec3& x) { return -2 * (rise(1) + 9.81) * (x.z - 0.5); });
}

TEST(FlowExact, AnAcceleratingFrameHasALinearPressure) {
    const double a = pressure_error_of_frame(FlowScheme::second_order, 10),
                 b = pressure_error_of_frame(FlowScheme::second_order, 20);
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b));
    EXPECT_LT(a, 0.0147);
    EXPECT_GT(a / b, 3.5);
}

// A duct with walls across y and z, and the same as fixed walls of a mesh from elsewhere, which are no faces of a box.
TEST(FlowExact, FixedWallsAreWalls) {
    const Mesh box = unit_cube(4);
    Mesh fixed = box;
    for (auto& patches : fixed.patch)
        for (Patch& patch : patches)
            if (patch.value >= 2) patch = Patch(box_faces + patch.value % 3);
    FlowOptions options = fluid(1, 1, {});
    options.faces.fill({});
    options.faces[0] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({1, 0, 0})};
    options.faces[1] = {.kind = FlowFace::Kind::open};
    FlowState in_box = still_flow(box), in_fixed = in_box;
    (void)step_flow(petsc().all_ranks(), box, box, options, in_box, 0, 0.1);
    const FlowReport report = step_flow(petsc().all_ranks(), fixed, fixed, options, in_fixed, 0, 0.1);
    EXPECT_EQ(in_fixed.velocity, in_box.velocity);
    EXPECT_NEAR(report.face_flux[1], 1, 1e-3);
    EXPECT_EQ(report.face_flux[2], 0);
}

TEST(FlowExact, WhatFlowsInNeedsAWayOut) {
    const Mesh mesh = unit_cube(4);
    FlowOptions options = fluid(1, 1, {});
    options.faces.fill({});
    options.faces[0] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({1, 0, 0})};
    FlowState state = still_flow(mesh);
    EXPECT_THROW(step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1), CaseError);
    options.faces[1] = {.kind = FlowFace::Kind::open};
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    EXPECT_LT(report.face_flux[0], -0.5);
    EXPECT_NEAR(report.face_flux[1] / report.face_flux[0], -1, 1e-3);
}

// Beside walls too: at their edges it goes along them.
TEST(FlowExact, WhatIsGivenComesInAsAWhole) {
    const Mesh mesh = unit_cube(4);
    FlowOptions options = fluid(1, 1, {});
    options.faces.fill({});
    options.faces[1] = {.kind = FlowFace::Kind::open};
    options.faces[0] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({2, 0, 0})};
    FlowState state = still_flow(mesh);
    FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    EXPECT_NEAR(report.face_flux[0], -2, 1e-14);
    EXPECT_NEAR(report.face_flux[1], 2, 1e-12);
    for (const std::size_t wall : {2, 3, 4, 5}) EXPECT_NEAR(report.face_flux[wall], 0, 1e-14);
    options.faces[0].velocity = uniform({2, 0.1, 0.2});  // at their edges only what goes along walls
    options.faces[4].kind = FlowFace::Kind::slip;
    report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    EXPECT_NEAR(report.face_flux[0], -2, 1e-14);
    for (const std::size_t wall : {2, 3, 4, 5}) EXPECT_NEAR(report.face_flux[wall], 0, 1e-14);
    options.faces[4].kind = FlowFace::Kind::wall;
    options.faces[0].velocity = uniform({0, 0, 1});  // a lid, which nothing passes
    (void)step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    for (Vertex v : mesh.position.indices()) {
        const Vec3& x = mesh.position[v];
        EXPECT_TRUE(x.x != 0 || (x.y != 0 && x.y != 1) || state.velocity[v] == Vec3{});
    }
}

// One bar more at the open faces is one bar more everywhere, and nothing else.
TEST(FlowExact, TheLevelOfThePressureIsOfNoMatter) {
    const Mesh mesh = unit_cube_with_body(8);
    FlowOptions options = fluid(1, 1e-3, {});
    options.regions.emplace_back();
    options.faces.fill({});
    options.gravity = {0, 0, -9.81};
    options.faces[4] = {.kind = FlowFace::Kind::velocity, .velocity = uniform({0, 0, 1e-3})};
    std::array<FlowState, 2> states = {still_flow(mesh), still_flow(mesh)};
    std::array<FlowReport, 2> reports;
    for (std::size_t i = 0; i < 2; ++i) {
        options.faces[5] = {.kind = FlowFace::Kind::open,
                            .pressure = [i](const Vec3& x, double) { return 1e5 * static_cast<double>(i) + x.x; }};
        for (int step = 0; step < 2; ++step)
            reports[i] = step_flow(petsc().all_ranks(), mesh, mesh, options, states[i], 0.1 * step, 0.1);
    }
    EXPECT_LT(norm(reports[1].bodies[0].force - reports[0].bodies[0].force), 1e-8);
    EXPECT_LT(norm(reports[1].face_force[0] - reports[0].face_force[0] - Vec3{-1e5, 0, 0}), 1e-7);
    const Array<Vertex, char> flows = vertices_of(mesh, Region(0));
    for (Vertex v : mesh.position.indices()) {
        EXPECT_LT(norm(states[1].velocity[v] - states[0].velocity[v]), 1e-9);
        EXPECT_NEAR(states[1].pressure[v] - states[0].pressure[v], flows[v] != 0 ? 1e5 : 0, 1e-6);
    }
}

// A post on the floor under water at rest: what the water does to the floor beside it is not the post's.
TEST(FlowExact, APostBearsWhatIsAboveIt) {
    const Mesh mesh = cube_grid(8, 8, 8, [](int i, int j, int k) { return Vec3{i / 8.0, j / 8.0, k / 8.0}; },
                                [](int i, int j, int k) { return i >= 2 && i < 5 && j >= 2 && j < 6 && k < 4 ? 1 : 0; });
    FlowOptions options = fluid(2, 1, {});
    options.regions.emplace_back();
    options.faces.fill({});
    options.faces[5] = {.kind = FlowFace::Kind::open, .pressure = [](const Vec3&, double) { return 7.0; }};
    options.gravity = {0, 0, -10};
    options.tolerance = 1e-10;
    FlowState state = still_flow(mesh);
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
    constexpr double area = 3 * 4 / 64.0;
    EXPECT_LT(norm(report.bodies[0].force - Vec3{0, 0, -17 * area}), 1e-9);
    EXPECT_LT(norm(report.bodies[0].torque - cross({0, 0, 0.25}, report.bodies[0].force)), 1e-9);
    EXPECT_LT(norm(report.face_force[4] - Vec3{0, 0, -27 * (1 - area)}), 1e-9);
    EXPECT_LT(norm(report.face_force[0] - Vec3{-17, 0, 0}), 1e-9);
}

}  // namespace
}  // namespace kropla
