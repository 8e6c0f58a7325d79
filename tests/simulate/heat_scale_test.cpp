// Units, contrasts and time steps: nothing of them matters to the solvers.
#include "meshes.h"
#include "session.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr Vec3 middle{0.5, 0.5, 0.5};
constexpr int most_iterations = 60;

/// Units of a case, each in SI.
struct Units {
    double length = 1, time = 1, energy = 1;
};

/// The cube with its body shifted by this share of (0.06, -0.04, 0.08), what is around following.
Mesh shifted(const Mesh& start, double share) {
    Mesh mesh = start;
    for (Vec3& x : mesh.position) {
        const Vec3 r = x - middle;
        const double m = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
        x += share * std::clamp((0.5 - m) / 0.25, 0.0, 1.0) * Vec3{0.06, -0.04, 0.08};
    }
    return mesh;
}

Mesh in_units(Mesh mesh, const Units& units) {
    for (Vec3& x : mesh.position) x *= units.length;
    return mesh;
}

HeatMaterial in_units(const HeatMaterial& m, const Units& units) {
    return {.conductivity = m.conductivity(0) * units.energy / (units.time * units.length),
            .density = m.density,
            .specific_heat = m.specific_heat(0) * units.energy / std::pow(units.length, 3)};
}

HeatOptions hot_body(const HeatMaterial& gas, const HeatMaterial& body) {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0] = {.material = gas, .carried = Carried::with_flow, .initial = 300};
    options.regions[1] = {.material = body, .carried = Carried::with_mesh, .initial = 2500};
    return options;
}

struct Solved {
    HeatReport report;
    NodalField field;
};

/// A step of a hot body among stretched prisms in a gas, in these units.
Solved solve_in(const Units& units, double dt) {
    const Mesh start = with_layer(unit_cube_with_body(8), middle, surroundings, 4, 0.05);
    const Mesh before = in_units(start, units), current = in_units(shifted(start, 1), units);
    HeatOptions options = hot_body(in_units({60, 1.6, 520}, units), in_units({3e4, 7000, 800}, units));
    options.faces[4] = {HeatFace::Kind::value, [](const Vec3&, double) { return 400.0; }};
    NodalField field = initial_temperature(before, options);
    const HeatReport report =
        step_heat(petsc().all_ranks(), before, current, options, field, 0, dt * units.time);
    return {report, field};
}

TEST(HeatScale, UnitsDoNotMatter) {
    constexpr Units all[] = {{1e-12, 1, 1}, {1e9, 1, 1},  {1, 1e-6, 1},         {1, 1e6, 1},
                             {1, 1, 1e-6},  {1, 1, 1e6},  {1e-6, 1e-6, 1e-12}, {1e6, 1e6, 1e6}};
    for (const double dt : {0.1, 1e4}) {  // held back by the masses; conducted away
        const Solved one = solve_in({}, dt);
        EXPECT_GT(one.report.potential_iterations, 0);
        EXPECT_LE(one.report.iterations, most_iterations);
        EXPECT_LE(one.report.potential_iterations, most_iterations);
        for (const Units& units : all) {
            SCOPED_TRACE(testing::Message() << units.length << " m, " << units.time << " s, " << units.energy
                                            << " J, dt " << dt);
            const Solved other = solve_in(units, dt);
            EXPECT_NEAR(other.report.iterations, one.report.iterations, 1);
            EXPECT_NEAR(other.report.potential_iterations, one.report.potential_iterations, 1);
            double largest = 0;
            for (Vertex v : one.field.values.indices())
                largest = std::max(largest, std::abs(other.field.values[v] / one.field.values[v] - 1));
            EXPECT_LT(largest, 1e-9);
        }
    }
}

/// Runs one step at rest, and asks for what conduction cannot break: energy and bounds.
NodalField conducted(const HeatMaterial& gas, const HeatMaterial& body, double dt) {
    const Mesh mesh = unit_cube_with_body(8);
    const HeatOptions options = hot_body(gas, body);
    NodalField field = initial_temperature(mesh, options);
    const double begin = energy(mesh, options, field.values);
    HeatReport report;
    EXPECT_NO_THROW(report = step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0, dt));
    EXPECT_LE(report.iterations, most_iterations);
    EXPECT_LT(report.error, 1e-13);

    EXPECT_NEAR(energy(mesh, options, field.values) / begin, 1, 1e-12);
    const auto [least, most] = std::ranges::minmax(field.values);
    EXPECT_GT(least, 300 * (1 - 1e-9));
    EXPECT_LT(most, 2500 * (1 + 1e-9));
    return field;
}

TEST(HeatScale, ContrastsOfAHundredMillionAreSolved) {
    for (const double contrast : {1e8, 1e-8}) {
        const HeatMaterial one{1, 1, 1};
        const HeatMaterial bodies[] = {{contrast, 1, 1},        {1, contrast, 1},        {1, 1, contrast},
                                       {contrast, contrast, 1}, {1, contrast, contrast}, {contrast, 1, contrast},
                                       {contrast, contrast, contrast}};
        for (const HeatMaterial& body : bodies) {
            for (const double dt : {1e-6, 1.0, 1e6}) {
                SCOPED_TRACE(testing::Message() << "conductivity " << body.conductivity(0) << ", density "
                                                << body.density(0) << ", specific heat " << body.specific_heat(0)
                                                << ", dt " << dt);
                conducted(one, body, dt);
            }
        }
    }
}

TEST(HeatScale, AnyStepIsSolved) {
    for (const double conductivity : {1.0, 1e4, 1e8}) {
        for (int decade = -10; decade <= 10; ++decade) {
            SCOPED_TRACE(testing::Message() << "conductivity " << conductivity << ", dt 1e" << decade);
            const NodalField field = conducted({1, 1, 1}, {conductivity, 1, 1}, std::pow(10, decade));
            const auto [least, most] = std::ranges::minmax(field.values);
            if (decade == 10) {  // of one temperature all over
                EXPECT_LT((most - least) / most, 1e-8);
            }
            if (decade == -10 && conductivity == 1) {
                EXPECT_GT(most - least, 2200 * (1 - 1e-6));
            }
        }
    }
}

// What comes in during a step of which conduction makes one temperature all over is that temperature's rise alone:
// a constant, which the matrix hardly knows.
TEST(HeatScale, SourcesOfClosedRoomsWarmThemEvenly) {
    const Mesh mesh = unit_cube_with_body(8);
    HeatOptions options = hot_body({1.5, 1.7, 3500}, {6000, 4e-4, 2400});
    options.regions[0].source = [](const Vec3&, double) { return 1e6; };
    options.regions[1].initial = 300;
    for (const double dt : {1e10, 1e14}) {
        SCOPED_TRACE(dt);
        NodalField field = initial_temperature(mesh, options);
        const double held = energy(mesh, options, field.values) / 300, room = 1e6 * region_volume(mesh, surroundings);
        for (int step = 1; step <= 3; ++step) {
            const HeatReport report =
                step_heat(petsc().all_ranks(), mesh, mesh, options, field, (step - 1) * dt, dt);
            EXPECT_LE(report.iterations, most_iterations);
            for (Vertex v : field.values.indices())
                ASSERT_NEAR(field.values[v] / (300 + step * dt * room / held), 1, 1e-9);
        }
    }
}

// Twenty prisms, the first a two-thousandth of the body, each a quarter higher than the one below.
TEST(HeatScale, StretchedPrismsAreSolved) {
    Mesh start = with_layer(unit_cube_with_body(8), middle, surroundings, 20, 0.2);
    const PrismLayer& layer = start.layers.front();
    for (int column = 0; column < count_columns(layer); ++column) {
        const Vec3 wall = start.position[column_vertex(layer, column, 0)],
                   shell = start.position[column_vertex(layer, column, layer.count)];
        for (int k = 1; k < layer.count; ++k)
            start.position[column_vertex(layer, column, k)] =
                wall + (std::pow(1.25, k) - 1) / (std::pow(1.25, layer.count) - 1) * (shell - wall);
    }
    const Mesh current = shifted(start, 1);
    const HeatOptions options = hot_body({0.02, 1.6, 520}, {35, 7000, 800});
    for (const double dt : {1e-3, 1.0, 1e3}) {
        SCOPED_TRACE(dt);
        NodalField field = initial_temperature(start, options);
        const double begin = energy(start, options, field.values);
        const HeatReport report = step_heat(petsc().all_ranks(), start, current, options, field, 0, dt);
        EXPECT_GT(report.potential_iterations, 0);
        EXPECT_LE(report.potential_iterations, most_iterations);
        EXPECT_LE(report.iterations, most_iterations);
        EXPECT_NEAR(energy(current, options, field.values) / begin, 1, 1e-12);
    }
}

}  // namespace
}  // namespace kropla
