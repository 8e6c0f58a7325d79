// What melts: the passes that a step takes, and the bounds it keeps.
#include "meshes.h"
#include "session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace kropla {
namespace {

Quantity always(double value) {
    return [value](const Vec3&, double) { return value; };
}

constexpr double natural_step = 0.25 * 0.25 * 7000 * 800 / 30;  // [s] in which heat passes half the body

/// A body of steel that melts within `width` [K] below 1800 K, in a gas that conducts 1500 times worse and holds 7000 times
/// less.
HeatOptions steel_in_gas(double width) {
    HeatOptions options{.regions = std::vector<HeatRegion>(2), .surfaces = std::vector<HeatSurface>(1)};
    options.regions[0] = {.material = {.conductivity = 0.02, .density = 1.6, .specific_heat = 520}, .initial = 300};
    options.regions[1] = {.material = {.conductivity = 30, .density = 7000, .specific_heat = 800, .latent_heat = 2.5e5,
                                       .solidus = 1800 - width, .liquidus = 1800},
                          .carried = Carried::with_mesh, .initial = 2000};
    return options;
}

/// Cools: what is beside the body is colder and freezes it.
HeatOptions freezing(double width) {
    HeatOptions options = steel_in_gas(width);
    options.surfaces[0].exchange = {always(1e3), always(0.5), always(500)};
    return options;
}

/// Heats: a flux melts the body, of a conductivity, density and specific heat by tables, one with a peak.
HeatOptions melting(double width) {
    HeatOptions options = steel_in_gas(width);
    HeatRegion& body = options.regions[1];
    body.initial = 300;
    body.material.conductivity = Property({300, 1700, 1800, 2500}, {60, 25, 35, 40});
    body.material.density = Property({300, 2500}, {7800, 6800});
    body.material.specific_heat = Property({300, 1000, 1040, 1080, 2500}, {450, 800, 2000, 800, 820});
    options.surfaces[0].flux = always(1e6);
    return options;
}

/// Between a hot and a cold face, beginning within what melts.
HeatOptions between(double width) {
    HeatOptions options = steel_in_gas(width);
    options.regions[0].material.conductivity = Property({300, 3000}, {0.02, 2});
    options.regions[1].initial = 1800 - 0.5 * width;
    options.faces[0] = {HeatFace::Kind::value, always(300)};
    options.faces[1] = {HeatFace::Kind::value, always(3000)};
    return options;
}

struct Variant {
    const char* name;
    HeatOptions (*options)(double width);
};

struct Stretch {
    int passes = 0;       // the most in a step
    double balance = 0;   // [-] the worst
    double beyond = 0;    // [-] the farthest beyond a bound, of the range
    double changed = 0;   // [J] by how much the energy changed, the most
};

Stretch two_steps(const Mesh& mesh, const HeatOptions& options, double dt) {
    NodalField field = initial_temperature(mesh, options);
    Stretch found;
    for (int k = 0; k < 2; ++k) {
        const HeatReport report = step_heat(petsc().all_ranks(), mesh, mesh, options, field, k * dt, dt);
        const HeatExtremes& extremes = report.extremes;
        const double range = extremes.most.value - extremes.least.value;
        double through = std::abs(report.balance.before);  // [J] held and passed on
        for (double face : report.balance.faces) through += std::abs(face);
        for (double surface : report.balance.surfaces) through += std::abs(surface);
        found.passes = std::max(found.passes, report.passes);
        found.balance = std::max(found.balance, std::abs(report.balance.error()) / through);
        if (range > 0)
            found.beyond = std::max({found.beyond, (extremes.lower - extremes.least.value) / range,
                                     (extremes.most.value - extremes.upper) / range});
        found.changed = std::max(found.changed, std::abs(report.balance.after - report.balance.before));
    }
    return found;
}

// The first guess of a step is the state at its begin; from there vertices leap over what they melt by.
TEST(HeatMelting, SettlesAtAnyStepAndWidth) {
    const Mesh mesh = unit_cube_with_body(8);
    int most = 0;
    for (const auto& [name, options] : {Variant{"freezing", freezing}, {"melting", melting}, {"between", between}})
        for (double width : {40.0, 1e-2})
            for (double relative : {1e-3, 1e-1, 1.0, 10.0, 1e3}) {
                SCOPED_TRACE(testing::Message() << name << " within " << width << " K, step " << relative);
                const Stretch found = two_steps(mesh, options(width), relative * natural_step);
                EXPECT_LT(found.beyond, 1e-10);
                EXPECT_LT(found.balance, 1e-11);  // 1e-12; melting within 0.01 K makes 2e6 J of the last digit of 1800 K
                EXPECT_GT(found.changed, 0);
                most = std::max(most, found.passes);
            }
    RecordProperty("passes", most);
    EXPECT_LE(most, 25);
}

}  // namespace
}  // namespace kropla
