#include "meshes.h"
#include "session.h"
#include "simulate/cells.h"
#include <kropla/simulate/species.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr Region surroundings(0), body(1);

/// The unit cube whose body has gone by `shift`, the rest following; vertices inside both wobble with `wobble` [m].
Mesh moved(const Mesh& start, const Vec3& shift, double wobble) {
    Mesh mesh = start;
    for (Vertex v : mesh.position.indices()) {
        const Vec3 x = start.position[v];
        const double m = std::max({std::abs(x.x - 0.5), std::abs(x.y - 0.5), std::abs(x.z - 0.5)});
        const bool on_body = std::abs(m - 0.25) < 1e-9;
        mesh.position[v] += std::clamp((0.5 - m) / 0.25, 0.0, 1.0) * shift;
        if (!on_body && m < 0.49) mesh.position[v] += wobble * Vec3{std::sin(37 * x.x), std::sin(41 * x.y), std::sin(43 * x.z)};
    }
    return mesh;
}

HeatOptions still_gas_and_body() {
    HeatOptions heat{.regions = std::vector<HeatRegion>(2)};
    heat.regions[1].carried = Carried::with_mesh;
    return heat;
}

/// One step, in gas that makes way.
SpeciesReport take_step(const Mesh& before, const Mesh& current, const Species& species, const HeatOptions& heat,
                        const std::vector<SurfaceFlux>& surfaces, Concentrations& c, double t) {
    const double dt = 0.1;
    const MaterialFlow flow = material_flow(petsc().all_ranks(), before, current, {surroundings}, dt);
    return step_species(petsc().all_ranks(), before, current, species, heat, flow, surfaces, c, t, dt);
}

Species vapour(double in_gas, double in_body) {
    return {.name = "vapour", .regions = {SpeciesRegion{.diffusivity = 0.01, .initial = in_gas},
                                          SpeciesRegion{.diffusivity = 0.02, .initial = in_body}}};
}

double amount(const Mesh& mesh, const Concentrations& c, Region region) {
    return energy(mesh, {.regions = std::vector<HeatRegion>(2)}, c[static_cast<std::size_t>(region.value)], region);
}

TEST(Species, EachSideOfAnInterfaceKeepsItsValue) {
    const Mesh start = unit_cube_with_body(8);
    const Species species = vapour(1, 3);
    Concentrations c = initial_concentrations(start, species);
    Mesh before = start;
    for (int step = 1; step <= 3; ++step) {
        const Mesh current = moved(start, {0.03 * step, 0, -0.02 * step}, 0.01);
        (void)take_step(before, current, species, still_gas_and_body(), {}, c, 0.1 * step);
        before = current;
    }
    const auto of_gas = vertices_of(start, surroundings), of_body = vertices_of(start, body);
    for (Vertex v : before.position.indices()) {
        if (of_gas[v] != 0) {
            EXPECT_NEAR(c[0][v], 1, 1e-10);
        }
        if (of_body[v] != 0) {
            EXPECT_NEAR(c[1][v], 3, 1e-10);
        }
    }
}

// A cloud on one side of the box is neither lost nor does it become negative or thicker, however the body stirs it.
TEST(Species, IsConservedWithinItsBounds) {
    const Mesh start = unit_cube_with_body(8);
    Species species = vapour(0, 0);
    species.regions[0]->initial = Quantity([](const Vec3& x, double) { return x.x < 0.3 ? 1.0 : 0.0; });
    species.regions[0]->diffusivity = 1e-6;
    species.regions[1].reset();
    Concentrations c = initial_concentrations(start, species);
    EXPECT_TRUE(c[1].empty());
    Mesh before = start;
    const double begin = amount(start, c, surroundings);
    for (int step = 1; step <= 5; ++step) {
        const Mesh current = moved(start, {-0.04 * step, 0.02 * step, 0}, 0.01 * (step % 2));
        const SpeciesReport report = take_step(before, current, species, still_gas_and_body(), {}, c, 0.1 * step);
        EXPECT_NEAR(report.balance[0].error(), 0, 1e-12 * begin);
        EXPECT_NEAR(amount(current, c, surroundings), begin, 1e-12 * begin);
        const auto [least, most] = std::ranges::minmax(c[0]);
        EXPECT_GE(least, -1e-10);
        EXPECT_LE(most, 1 + 1e-10);
        before = current;
    }
}

TEST(Species, WhatLeavesTheBodyIsInTheGas) {
    const Mesh start = unit_cube_with_body(8);
    Species species = vapour(0, 2);
    species.surfaces = {{.flux = [](const Vec3&, double t) { return 0.1 * t; }, .per_heat = 0.01}};
    HeatOptions heat = still_gas_and_body();
    heat.regions[1].initial = 100;
    NodalField temperature = initial_temperature(start, heat);
    Concentrations c = initial_concentrations(start, species);
    const double begin = amount(start, c, body), dt = 0.1;
    const Mesh current = moved(start, {0.03, 0, 0.01}, 0.005);
    const HeatReport warm = step_heat(petsc().all_ranks(), start, current, heat, temperature, 0, dt);
    const SpeciesReport report =
        take_step(start, current, species, heat, warm.surfaces, c, 0);
    const double area = 6 * 0.25, by_heat = 0.01 * warm.surfaces[0].total * dt;  // all of it leaves the body
    ASSERT_GT(by_heat, 0);
    const double left = 0.05 * dt * dt * area + by_heat;  // the integral of 0.1 t, and what goes with the heat
    EXPECT_NEAR(amount(current, c, surroundings), left, 1e-9 * left);
    EXPECT_NEAR(begin - amount(current, c, body), left, 1e-9 * left);
    EXPECT_NEAR(report.balance[0].surfaces[0], left, 1e-9 * left);
}

TEST(Species, NamesWhatIsWrong) {
    const Mesh mesh = unit_cube_with_body(4);
    Species species = vapour(0, 0);
    species.regions[1]->diffusivity = -1;
    try {
        (void)initial_concentrations(mesh, species);
        FAIL();
    } catch (const CaseError& error) {
        EXPECT_EQ(std::string(error.what()).find("species.vapour.region.(body 1).diffusivity must be positive, got -1"), 0u) << error.what();
    }
}

}  // namespace
}  // namespace kropla
