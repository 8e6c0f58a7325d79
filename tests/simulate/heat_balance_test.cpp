// What comes in and what is held agree in every step, whatever acts at once.
#include "meshes.h"
#include "session.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr Vec3 middle{0.5, 0.5, 0.5};

Quantity always(double value) {
    return [value](const Vec3&, double) { return value; };
}

/// A cube with a body that has prisms on both sides of its surface; or one without prisms, half of it a body of its own.
Mesh layered() {
    return with_layer(with_layer(unit_cube_with_body(8), middle, surroundings, 2, 0.3), middle, Region(1), 2, 0.24);
}
Mesh two_bodies() {
    const auto place = [](int i, int j, int k) { return Vec3{i / 8.0, j / 8.0, k / 8.0}; };
    return cube_grid(8, 8, 8, place, [](int i, int j, int k) {
        const auto inside = [](int n, int from, int to) { return n >= from && n < to; };
        if (!inside(j, 2, 6) || !inside(k, 2, 6)) return 0;
        return inside(i, 1, 3) ? 1 : inside(i, 5, 7) ? 2 : 0;
    });
}

/// The body goes up and turns, what is around follows, up to the box.
Mesh moved(const Mesh& start, int step) {
    Mesh mesh = start;
    const double angle = 0.04 * step, up = 0.02 * step;
    for (Vertex v : mesh.position.indices()) {
        const Vec3 r = start.position[v] - middle;
        const double off = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
        const double share = std::clamp((0.5 - off) / 0.25, 0.0, 1.0);
        const double c = std::cos(share * angle), s = std::sin(share * angle);
        mesh.position[v] = middle + Vec3{c * r.x - s * r.y, s * r.x + c * r.y, r.z + share * up};
    }
    return mesh;
}

/// Every kind of face, of surface and of source, in materials by tables with latent heat.
HeatOptions everything(std::size_t bodies) {
    HeatOptions options{.regions = std::vector<HeatRegion>(1 + bodies), .surfaces = std::vector<HeatSurface>(bodies)};
    options.regions[0].material = {.conductivity = Property({300, 3000}, {60, 300}),
                                   .density = Property({300, 3000}, {1.6, 0.2}),
                                   .specific_heat = 520};
    options.regions[0].initial = HeatStart([](const Vec3& x, double) { return 300 + 100 * x.x; });
    options.regions[0].source = [](const Vec3& x, double t) { return 1e4 * x.z + t; };
    for (std::size_t body = 1; body <= bodies; ++body) {
        options.regions[body] = {.material = {.conductivity = 3e4, .density = 7000,
                                              .specific_heat = Property({300, 1500, 2500}, {500, 750, 830}),
                                              .latent_heat = 2.5e5, .solidus = 1700, .liquidus = 1720},
                                 .carried = Carried::with_mesh, .initial = 1710};
        options.regions[body].source = [](const Vec3& x, double) { return 1 + x.y; };
        options.regions[body].power = always(2e7);
        options.surfaces[body - 1] = {.flux = [](const Vec3& x, double) { return x.x; }, .power = always(-5e6),
                                      .exchange = {always(50), always(0.4), always(400)}};
    }
    options.faces[0] = {HeatFace::Kind::value, [](const Vec3& x, double t) { return 320 + 30 * x.y + 100 * t; }};
    options.faces[1] = {HeatFace::Kind::flux, always(4e4)};
    options.faces[2] = {HeatFace::Kind::exchange, {}, {always(20), {}, always(280)}};
    options.faces[3] = {HeatFace::Kind::exchange, {}, {{}, always(0.9), always(500)}};
    options.faces[4] = {.kind = HeatFace::Kind::flux, .quantity = [](const Vec3& x, double) { return x.x * x.y; },
                        .power = always(-1e4)};
    return options;
}

/// [-] of what there was and came in.
double error_of(const HeatBalance& balance) {
    return std::abs(balance.error()) / (std::abs(balance.before) + std::abs(balance.brought()));
}

void expect_everything_brought(const HeatBalance& balance) {
    for (std::size_t face = 0; face < 5; ++face) EXPECT_NE(balance.faces[face], 0) << face;
    EXPECT_EQ(balance.faces[5], 0);  // insulated
    for (double surface : balance.surfaces) EXPECT_NE(surface, 0);
    for (double source : balance.sources) EXPECT_NE(source, 0);
}

TEST(HeatBalanceOfSteps, IsExactWithEverythingAtOnce) {
    const Mesh mesh = layered();
    const HeatOptions options = everything(1);
    for (double dt : {1e-4, 1e-2, 1.0, 1e2}) {
        SCOPED_TRACE(dt);
        NodalField field = initial_temperature(mesh, options);
        for (int k = 0; k < 3; ++k) {
            const HeatBalance balance =
                step_heat(petsc().all_ranks(), mesh, mesh, options, field, k * dt, dt).balance;
            expect_everything_brought(balance);
            EXPECT_LT(error_of(balance), 1e-12);
            EXPECT_NEAR(balance.sources[1] / (2e7 * dt), 1, 1e-12);
            EXPECT_NEAR(balance.faces[4] / (-1e4 * dt), 1, 1e-12);
        }
    }
}

TEST(HeatBalanceOfSteps, IsExactWhileTheBodyMoves) {
    const Mesh start = layered();
    const HeatOptions options = everything(1);
    Mesh before = start;
    NodalField field = initial_temperature(before, options);
    for (int step = 1; step <= 4; ++step) {
        const Mesh current = moved(start, step);
        const HeatReport report =
            step_heat(petsc().all_ranks(), before, current, options, field, 0.01 * step, 0.01);
        EXPECT_GT(report.potential_iterations, 0);  // gas made way
        expect_everything_brought(report.balance);
        EXPECT_LT(error_of(report.balance), 1e-12) << "step " << step;
        EXPECT_NEAR(report.balance.after, energy(current, options, field.values), 1e-13 * report.balance.after);
        before = current;
    }
}

// A region that is held gets what the others take from it; the second body lies away from it.
TEST(HeatBalanceOfSteps, KnowsWhatHoldsARegion) {
    const Mesh mesh = two_bodies();
    HeatOptions options = everything(2);
    options.regions[1].held = 1900;
    NodalField field = initial_temperature(mesh, options);
    const auto of_body = vertices_of(mesh, Region(1));
    for (int k = 0; k < 3; ++k) {
        const HeatBalance balance = step_heat(petsc().all_ranks(), mesh, mesh, options, field, 0.05 * k, 0.05).balance;
        EXPECT_LT(error_of(balance), 1e-12);
        EXPECT_NE(balance.held[1], 0);
        EXPECT_EQ(balance.held[2], 0);
    }
    for (Vertex v : mesh.position.indices()) {
        if (!of_body[v]) continue;
        EXPECT_EQ(field.values[v], 1900);
    }
}

}  // namespace
}  // namespace kropla
