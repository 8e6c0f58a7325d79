// Bodies whose material moves as it is told: they swell, turn within their mesh, come in through a face.
#include "meshes.h"
#include "session.h"
#include "base/random.h"
#include <kropla/simulate/heat.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr Region gas{0}, body{1};
constexpr Vec3 middle{0.5, 0.5, 0.5};
constexpr double dt = 0.1;

/// Of a motion that is `way` in the body and nothing on the box; vertices off the body's surface are shaken along.
Mesh moved(const Mesh& start, const auto& way) {
    Mesh mesh = start;
    Random random{17};
    const Array<Vertex, char> of_body = vertices_of(start, body), of_gas = vertices_of(start, gas);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 x = start.position[v], off = x - middle;
        const double far = std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)});
        Vec3 place = x + std::clamp((0.5 - far) / 0.25, 0.0, 1.0) * (way(x) - x);
        for (int axis = 0; axis < 3; ++axis) {
            if (!of_body[v] || !of_gas[v]) place[axis] += random.uniform(-0.015, 0.015);
            if (x[axis] == 0 || x[axis] == 1) place[axis] = x[axis];
        }
        mesh.position[v] = place;
    }
    return mesh;
}

HeatOptions both_flow() {
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[0] = {.material = {.conductivity = 60, .density = 1.6, .specific_heat = 520}, .initial = 300};
    options.regions[1] = {.material = {.conductivity = 3e4, .density = 7000, .specific_heat = 800}, .initial = 300};
    return options;
}

double volume_of_body(const Mesh& mesh) {
    HeatOptions options = both_flow();
    options.regions[1].material = {.conductivity = 1, .density = 1, .specific_heat = 1};
    return energy(mesh, options, Array<Vertex, double>(mesh.position.size(), 1.0), body);
}

/// The velocity by which all came here from where `back` says.
ToldFlow told(const Mesh& current, const auto& back) {
    ToldFlow flow{body, Array<Vertex, Vec3>(current.position.size())};
    for (Vertex v : current.position.indices()) flow.velocity[v] = (current.position[v] - back(current.position[v])) / dt;
    return flow;
}

TEST(ToldFlow, WhatSwellsStaysAsWarmAsItIs) {
    const Mesh before = unit_cube_with_body(8);
    constexpr double grows = 1.06;
    const Mesh current = moved(before, [](const Vec3& x) { return middle + grows * (x - middle); });
    const HeatOptions options = both_flow();
    NodalField field = initial_temperature(before, options);
    ToldFlow swells = told(current, [](const Vec3& x) { return middle + (x - middle) / grows; });
    swells.expansion.resize(current.position.size(), (1 - std::pow(grows, -3)) / dt);
    const MaterialFlow flow = material_flow(petsc().all_ranks(), before, current, {gas, body}, dt, {}, {swells});
    const HeatReport report = step_heat(petsc().all_ranks(), before, current, options, flow, field, 0, dt);
    EXPECT_LT(largest_difference(current, field, 300) / 300, 1e-12);
    const double gained = volume_of_body(current) - volume_of_body(before);
    EXPECT_GT(gained, 0.02);
    EXPECT_NEAR(report.balance.expansion[1], 7000.0 * 800 * 300 * gained, 1e-10 * report.balance.after);
    EXPECT_NEAR(report.balance.expansion[0], -1.6 * 520 * 300 * gained, 1e-10 * report.balance.after);
    EXPECT_NEAR(report.balance.error(), 0, 1e-13 * report.balance.after);
}

// Where the velocity says nothing, what a volume gains comes evenly; so a hot body that swells stays within its bounds.
TEST(ToldFlow, WhatIsNotToldExpandsEvenly) {
    const Mesh before = unit_cube_with_body(8);
    const Mesh current = moved(before, [](const Vec3& x) { return middle + 1.06 * (x - middle); });
    HeatOptions options = both_flow();
    options.regions[1].initial = 2500;
    NodalField field = initial_temperature(before, options);
    const MaterialFlow flow = material_flow(petsc().all_ranks(), before, current, {gas, body}, dt);
    const double rate = (volume_of_body(current) - volume_of_body(before)) / (dt * volume_of_body(current));
    const Array<Vertex, char> of_body = vertices_of(current, body);
    for (Vertex v : current.position.indices()) {
        if (of_body[v] == 0) continue;
        EXPECT_NEAR(flow.expansion[body][v], rate, 1e-12 * rate);
    }
    const HeatReport report = step_heat(petsc().all_ranks(), before, current, options, flow, field, 0, dt);
    EXPECT_GE(report.extremes.least.value, 300 - 1e-8);
    EXPECT_LE(report.extremes.most.value, 2500 + 1e-8);
    EXPECT_NEAR(report.balance.error(), 0, 1e-13 * report.balance.after);
}

// As HeatMoving.BodyCarriesItsHeat, of a body that is not known to be rigid.
TEST(ToldFlow, CarriesWhatIsInTheBody) {
    const auto turned = [](const Vec3& x, double angle) {
        const Vec3 r = x - middle;
        return middle + Vec3{std::cos(angle) * r.x - std::sin(angle) * r.y, std::sin(angle) * r.x + std::cos(angle) * r.y, r.z};
    };
    const Mesh before = unit_cube_with_body(8);
    const Mesh current = moved(before, [&](const Vec3& x) { return turned(x, 0.2); });
    HeatOptions options = both_flow();
    for (HeatRegion& region : options.regions) region.material.conductivity = 1e-12;
    const auto linear = [](const Vec3& x) { return 500 + 100 * x.x - 200 * x.y + 50 * x.z; };
    NodalField field = initial_temperature(before, options);
    for (Vertex v : before.position.indices()) field.values[v] = linear(before.position[v]);
    const auto back = [&](const Vec3& x) { return turned(x, -0.2); };
    const MaterialFlow flow = material_flow(petsc().all_ranks(), before, current, {gas, body}, dt, {}, {told(current, back)});
    step_heat(petsc().all_ranks(), before, current, options, flow, field, 0, dt);
    const Array<Vertex, char> of_gas = vertices_of(before, gas), of_body = vertices_of(before, body);
    double largest = 0;
    for (Vertex v : current.position.indices())
        if (of_body[v] && !of_gas[v]) largest = std::max(largest, std::abs(field.values[v] - linear(back(current.position[v]))));
    RecordProperty("largest_error", std::to_string(largest));
    EXPECT_LT(largest, 1.6);  // places turn by up to 0.07 across 230 K/m, and vertices are shaken
}

}  // namespace
}  // namespace kropla
