#include "meshes.h"
#include "session.h"
#include <kropla/base/error.h>
#include "base/random.h"
#include "simulate/elements.h"
#include <kropla/simulate/material_flow.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

/// How far the motion of the middle reaches: 1 on the body, 0 on the box.
double share(const Vec3& x) {
    const double m = std::max({std::abs(x.x - 0.5), std::abs(x.y - 0.5), std::abs(x.z - 0.5)});
    return std::clamp((0.5 - m) / 0.25, 0.0, 1.0);
}

/// The unit cube with its body turned about z and shifted, what is around following, and every vertex that is
/// not on the body's surface shaken by up to `shake` [m], those on the box along it.
Mesh with_body_at(const Mesh& start, const Vec3& shift, double angle, double shake, std::uint64_t seed) {
    Mesh mesh = start;
    Random random{seed};
    const Array<Vertex, char> of_body = vertices_of(start, Region(1)),
                              of_gas = vertices_of(start, surroundings);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 x = start.position[v], r = x - Vec3{0.5, 0.5, 0.5};
        const double s = share(x), c = std::cos(s * angle), d = std::sin(s * angle);
        Vec3 place = Vec3{0.5, 0.5, 0.5} + Vec3{c * r.x - d * r.y, d * r.x + c * r.y, r.z} + s * shift;
        for (int axis = 0; axis < 3; ++axis) {
            const double shaken = random.uniform(-shake, shake);
            if (!of_body[v] || !of_gas[v]) place[axis] += shaken;
            if (x[axis] == 0 || x[axis] == 1) place[axis] = x[axis];
        }
        mesh.position[v] = place;
    }
    return mesh;
}

/// Steel in argon, in metres and seconds that suit the unit cube.
HeatOptions droplet_in_gas() {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0] = {.material = {.conductivity = 60, .density = 1.6, .specific_heat = 520},
                          .carried = Carried::with_flow, .initial = 300};
    options.regions[1] = {.material = {.conductivity = 3e4, .density = 7000, .specific_heat = 800},
                          .carried = Carried::with_mesh, .initial = 2500};
    return options;
}

Mesh position_of_step(const Mesh& start, int step) {
    const double s = std::sin(1.3 * step);
    return with_body_at(start, {0.06 * s, -0.03 * step / 4.0, 0.08 * s * s}, 0.05 * step, 0.015,
                        100u + unsigned(step));
}

TEST(HeatMoving, ConstantStateIsKept) {
    const Mesh start = unit_cube_with_body(8);
    HeatOptions options = droplet_in_gas();
    options.regions[0].initial = options.regions[1].initial = 300;
    NodalField field = initial_temperature(start, options);
    Mesh before = position_of_step(start, 0);
    for (int step = 1; step <= 5; ++step) {
        const Mesh current = position_of_step(start, step);
        const auto report = step_heat(petsc().all_ranks(), before, current, options, field, 0.1 * step, 0.1);
        EXPECT_GT(report.potential_iterations, 0);  // the body did push gas
        EXPECT_LT(largest_difference(current, field, 300) / 300, 1e-12) << "step " << step;
        before = current;
    }
}

TEST(HeatMoving, ConstantStateIsKeptWithoutABody) {
    const Mesh start = unit_cube(6);
    HeatOptions options = droplet_in_gas();
    NodalField field = initial_temperature(start, options);
    const Mesh current = with_body_at(start, {0.02, 0.05, -0.03}, 0.1, 0.02, 5);
    const auto report = step_heat(petsc().all_ranks(), start, current, options, field, 0, 0.1);
    EXPECT_EQ(report.potential_iterations, 0);
    EXPECT_LT(largest_difference(current, field, 300) / 300, 1e-12);
}

TEST(HeatMoving, EnergyIsConserved) {
    const Mesh start = unit_cube_with_body(8);
    const HeatOptions options = droplet_in_gas();
    Mesh before = position_of_step(start, 0);
    NodalField field = initial_temperature(before, options);
    const double begin = energy(before, options, field.values);
    for (int step = 1; step <= 5; ++step) {
        const Mesh current = position_of_step(start, step);
        step_heat(petsc().all_ranks(), before, current, options, field, 0.1 * step, 0.1);
        EXPECT_NEAR(energy(current, options, field.values) / begin, 1, 1e-11) << "step " << step;
        before = current;
    }
    const double gas = energy(before, options, field.values, Region(0));
    EXPECT_GT(gas, 2 * energy(position_of_step(start, 0), options, initial_temperature(start, options).values,
                              Region(0)));  // heat did flow
    EXPECT_NEAR(gas + energy(before, options, field.values, Region(1)), energy(before, options, field.values),
                1e-12 * begin);
}

// A linear temperature in a body that moves and turns goes with it, while the vertices inside are moved on
// their own.
TEST(HeatMoving, BodyCarriesItsHeat) {
    const Mesh start = unit_cube_with_body(8);
    HeatOptions options = droplet_in_gas();
    for (HeatRegion& region : options.regions) region.material.conductivity = 1e-12;
    const Mesh before = with_body_at(start, {}, 0, 0.02, 3),
               current = with_body_at(start, {0.05, 0, 0.02}, 0.2, 0.02, 4);
    const auto linear = [](const Vec3& x) { return 500 + 100 * x.x - 200 * x.y + 50 * x.z; };
    NodalField field = initial_temperature(before, options);
    for (Vertex v : before.position.indices()) field.values[v] = linear(before.position[v]);
    step_heat(petsc().all_ranks(), before, current, options, field, 0, 1e-3);
    const Array<Vertex, char> of_gas = vertices_of(start, surroundings),
                              of_body = vertices_of(start, Region(1));
    double largest = 0;
    for (Vertex v : current.position.indices()) {
        if (!of_body[v] || of_gas[v]) continue;
        const Vec3 r = current.position[v] - Vec3{0.55, 0.5, 0.52};
        const double c = std::cos(0.2), s = std::sin(0.2);
        const Vec3 back = Vec3{0.5, 0.5, 0.5} + Vec3{c * r.x + s * r.y, c * r.y - s * r.x, r.z};
        largest = std::max(largest, std::abs(field.values[v] - linear(back)));
    }
    RecordProperty("largest_error", std::to_string(largest));
    // Vertices were moved by up to 0.04 past the material, across 230 K/m: 9 K if nothing were carried, and
    // 0.22 K for one big implicit step.
    EXPECT_LT(largest, 0.24);
}

TEST(HeatMoving, GasMakesWayForABodyAsTheLawOfPotentialFlowSays) {
    // A shift of the whole mesh, box and all: the flow is that shift, everywhere, and goes past no cell.
    const Mesh before = unit_cube(4);
    Mesh current = before;
    for (Vertex v : current.position.indices()) current.position[v] += Vec3{0.1, -0.2, 0.3};
    const MaterialFlow flow =
        material_flow(petsc().all_ranks(), before, current, {surroundings}, 0.5);
    for (Tet t : living_cells(current).tets) {
        const auto potential = at_corners(flow.potential[surroundings], cell_vertices(current, t));
        const Vec3 velocity = gradient(linear_tet(corners(current, t)), potential);
        EXPECT_LT(distance(velocity, {0.2, -0.4, 0.6}), 1e-12);
    }
}

// On a mesh whose vertices swing around their places, with T given and the source that it needs.
double manufactured_error(int n, int steps) {
    const double end = 0.2, k = 0.2;
    const auto exact = [](const Vec3& x, double t) {
        return std::sin(x.x + x.y + t) + std::cos(x.y - x.z + 2 * t);
    };
    const auto source = [k](const Vec3& x, double t) {
        const double a = x.x + x.y + t, b = x.y - x.z + 2 * t;
        return std::cos(a) - 2 * std::sin(b) + 2 * k * (std::sin(a) + std::cos(b));
    };
    HeatOptions options{.regions = {HeatRegion{.material = {.conductivity = k}, .source = source}}};
    options.faces.fill({HeatFace::Kind::value, exact});
    const Mesh start = unit_cube(n);
    const auto at = [&](double t) {
        Mesh mesh = start;
        for (Vec3& x : mesh.position) {
            const double bump = std::sin(pi * x.x) * std::sin(pi * x.y) * std::sin(pi * x.z);
            x += 0.1 * std::sin(2 * pi * t) * bump * Vec3{1, -0.5, 0.7};
        }
        return mesh;
    };
    NodalField field = initial_temperature(start, options);
    Mesh before = at(0);
    for (Vertex v : before.position.indices()) field.values[v] = exact(before.position[v], 0);
    for (int step = 0; step < steps; ++step) {
        const Mesh current = at((step + 1) * end / steps);
        step_heat(petsc().all_ranks(), before, current, options, field, step * end / steps, end / steps);
        before = current;
    }
    return l2_error(before, field, [&](const Vec3& x) { return exact(x, end); });
}

TEST(HeatMoving, ManufacturedSolutionIsOfSecondOrder) {
    const double a = manufactured_error(6, 12), b = manufactured_error(9, 27), c = manufactured_error(12, 48);
    RecordProperty("errors", std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c));
    EXPECT_GT(std::log(a / b) / std::log(9.0 / 6), 1.9);  // dt as h^2: the order in space
    EXPECT_GT(std::log(b / c) / std::log(12.0 / 9), 1.9);
}

TEST(HeatMoving, TwoRanksFindWhatOneDoes) {
    if (petsc().all_ranks().count == 1) GTEST_SKIP() << "under mpirun only";
    const Mesh start = unit_cube_with_body(8);
    const HeatOptions options = droplet_in_gas();
    const Mesh before = position_of_step(start, 0), current = position_of_step(start, 1);
    NodalField together = initial_temperature(before, options), alone = together;
    step_heat(petsc().all_ranks(), before, current, options, together, 0, 0.1);
    step_heat(petsc().this_rank(), before, current, options, alone, 0, 0.1);
    double largest = 0;
    for (Vertex v : current.position.indices()) {
        largest = std::max(largest, std::abs(together.values[v] - alone.values[v]));
    }
    EXPECT_LT(largest, 1e-9 * 2500);  // both to 1e-12 in the norm over all vertices
    EXPECT_GT(largest_difference(current, together, 300), 1000);
}

}  // namespace
}  // namespace kropla
