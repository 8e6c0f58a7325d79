// What flows do to bodies, and what units, threads and ranks do to flows: nothing.
#include "flow_problems.h"
#include "session.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace kropla {
namespace {

using std::numbers::pi;

constexpr double radius = 0.2;

/// Twice as fine with k = 2.
Mesh sphere_mesh(int k) {
    return sphere_in_cube(
        {.radius = radius, .half = 1, .around = 2 * k, .prisms = 2 * k, .layer = 0.06, .out = 4 * k});
}

FlowOptions stokes(const VectorQuantity& on_faces) {
    FlowOptions options = fluid(1, 1, on_faces);
    options.regions.emplace_back();
    options.convection = false;
    options.scheme = FlowScheme::steady;
    options.tolerance = 1e-6;
    return options;
}

FlowReport steady(const Mesh& mesh, const FlowOptions& options) {
    FlowState state = still_flow(mesh);
    return step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1);
}

TEST(FlowBody, DragOfASphereAsStokesHasIt) {
    const FlowOptions options =
        stokes(velocity_of([](const Vec3& x, double) { return stokes_velocity(x, radius, 1); }));
    const double drag = 6 * pi * radius;
    const double a = steady(sphere_mesh(1), options).bodies[0].force.z / drag - 1,
                 b = steady(sphere_mesh(2), options).bodies[0].force.z / drag - 1;
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b));
    EXPECT_GT(std::log2(a / b), 1.9);
    EXPECT_LT(std::abs(b), 0.0232);  // 768 triangles on the sphere
}

// K = 1.601688 for a radius of 0.2 half-widths: a method of fundamental solutions, see the handbook's section
// 1.4.
TEST(FlowBody, DragOfASphereThatMovesInAClosedCube) {
    FlowOptions options = stokes({});
    options.bodies.push_back([](double) { return RigidVelocity{{}, {0, 0, 1}, {}}; });
    const double drag = -6 * pi * radius;
    const double a = steady(sphere_mesh(1), options).bodies[0].force.z / drag / 1.601688 - 1,
                 b = steady(sphere_mesh(2), options).bodies[0].force.z / drag / 1.601688 - 1;
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b));
    EXPECT_GT(std::log2(a / b), 1.9);
    EXPECT_LT(std::abs(b), 0.03);
}

TEST(FlowBody, TorqueOnASphereThatSpins) {
    const Vec3 spin{0.3, -0.5, 1};
    const auto exact = [&](const Vec3& x, double) { return std::pow(radius / norm(x), 3) * cross(spin, x); };
    FlowOptions options = stokes(velocity_of(exact));
    options.bodies.push_back([&](double) { return RigidVelocity{{}, {}, spin}; });
    const FlowReport report = steady(sphere_mesh(1), options);
    const double size = 8 * pi * std::pow(radius, 3) * norm(spin);
    RecordProperty("torque", std::to_string(norm(report.bodies[0].torque) / size));
    EXPECT_LT(norm(report.bodies[0].torque + 8 * pi * std::pow(radius, 3) * spin) / size, 0.077);
    EXPECT_LT(norm(report.bodies[0].force) * radius / size, 1e-4);
    EXPECT_LT(std::abs(report.net_flux), 1e-14);
}

// A cube on its way through a closed box that moves as its mesh does.
FlowState pushed(const FlowOptions& options, const Ranks& ranks, double length, double time,
                 FlowReport& report) {
    const Mesh start = cube_with_layers(4, false);
    const auto at = [&](int step) {
        Mesh mesh = moved(start, {0.02 * step, 0, -0.01 * step}, 0.02 * step, 0.003, unsigned(step));
        for (Vec3& x : mesh.position) x = length * x;
        return mesh;
    };
    Mesh before = at(0);
    FlowState state = still_flow(before);
    for (int step = 1; step <= 3; ++step) {
        const Mesh current = at(step);
        report = step_flow(ranks, before, current, options, state, (step - 1) * time, time);
        before = current;
    }
    return state;
}

FlowOptions in_a_box(double density, double viscosity) {
    return {.regions = {FlowRegion{.density = density, .viscosity = viscosity}, {}}, .tolerance = 1e-9};
}

double largest_difference(const FlowState& a, const FlowState& b, double speed, double pressure) {
    double largest = 0;
    for (Vertex v : a.velocity.indices()) {
        largest = std::max(largest, distance(a.velocity[v], b.velocity[v] / speed));
        largest = std::max(largest, std::abs(a.pressure[v] - b.pressure[v] / pressure));
    }
    return largest;
}

TEST(FlowBody, UnitsAreOfNoMatter) {
    FlowReport metres, others;
    const FlowState reference = pushed(in_a_box(1, 0.01), petsc().all_ranks(), 1, 0.1, metres);
    ASSERT_GT(norm(metres.bodies[0].force), 0.01);
    struct Units { double length, time, mass; };
    for (const Units u : {Units{1e-6, 1e-9, 1e-15}, Units{1e3, 1, 1e20}, Units{1, 1e6, 1e-12}}) {
        const double density = u.mass / std::pow(u.length, 3), viscosity = u.mass / (u.length * u.time);
        const FlowState state =
            pushed(in_a_box(density, 0.01 * viscosity), petsc().all_ranks(), u.length, 0.1 * u.time, others);
        EXPECT_LT(largest_difference(reference, state, u.length / u.time, viscosity / u.time), 1e-7);
        EXPECT_NEAR(others.bodies[0].force.x * u.time * u.time / (u.mass * u.length),
                    metres.bodies[0].force.x, 1e-7 * norm(metres.bodies[0].force));
        EXPECT_LE(std::abs(others.iterations - metres.iterations), 1);
    }
}

TEST(FlowBody, ABodyThatMovesPushesAsMuchAwayAsItLetsIn) {
    FlowReport report;
    pushed(in_a_box(1, 0.01), petsc().all_ranks(), 1, 0.1, report);
    // Chords of a turn by 0.02 in a time of 0.1 are no rigid velocity: so much, 0.02^2 / 0.1 of the volume,
    // it grows.
    EXPECT_LT(std::abs(report.bodies[0].flux), 0.02 * 0.02 / 0.1 * 0.35 * 0.35 * 0.35);
    EXPECT_LT(report.bodies[0].force.x, 0);            // it is held back
}

TEST(FlowBody, TheSameBitsByOneThreadAndTwo) {
    const Mesh mesh = sphere_mesh(1);
    FlowOptions options = fluid(1, 0.01, uniform({0, 0, 1}));
    options.regions.emplace_back();
    const auto run = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        FlowState state = still_flow(mesh);
        step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.1);
        return state;
    };
    const FlowState one = run(1), two = run(2);
    EXPECT_TRUE(one.velocity == two.velocity);
    EXPECT_TRUE(one.pressure == two.pressure);
}

TEST(FlowBody, TwoRanksFindWhatOneDoes) {
    if (petsc().all_ranks().count == 1) GTEST_SKIP() << "under mpirun only";
    FlowReport together, alone;
    const FlowState a = pushed(in_a_box(1, 0.01), petsc().all_ranks(), 1, 0.1, together),
                    b = pushed(in_a_box(1, 0.01), petsc().this_rank(), 1, 0.1, alone);
    EXPECT_LT(largest_difference(a, b, 1, 1), 1e-7);
    EXPECT_LT(distance(together.bodies[0].force, alone.bodies[0].force), 1e-7);
}

}  // namespace
}  // namespace kropla
