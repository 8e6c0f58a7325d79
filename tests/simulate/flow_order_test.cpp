// Errors against closed solutions, and the orders in which they fall.
#include "flow_problems.h"
#include "session.h"
#include "simulate/cells.h"
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

bool loud() { return std::getenv("LOUD") != nullptr; }

/// A solution of the Navier-Stokes equations for a density of 1, in three dimensions:
///   [Ethier, Steinman 1994] Exact fully 3D Navier-Stokes solutions for benchmarking. Int. J. Numer. Methods Fluids 19.
struct EthierSteinman {
    static constexpr double a = pi / 4, d = pi / 2;
    double viscosity;

    [[nodiscard]] Vec3 velocity(const Vec3& p, double t) const {
        const auto [x, y, z] = p;
        const double decay = -a * std::exp(-viscosity * d * d * t);
        return decay * Vec3{std::exp(a * x) * std::sin(a * y + d * z) + std::exp(a * z) * std::cos(a * x + d * y),
                            std::exp(a * y) * std::sin(a * z + d * x) + std::exp(a * x) * std::cos(a * y + d * z),
                            std::exp(a * z) * std::sin(a * x + d * y) + std::exp(a * y) * std::cos(a * z + d * x)};
    }
    [[nodiscard]] double pressure(const Vec3& p, double t) const {
        const auto [x, y, z] = p;
        const double sum =
            std::exp(2 * a * x) + std::exp(2 * a * y) + std::exp(2 * a * z) +
            2 * std::sin(a * x + d * y) * std::cos(a * z + d * x) * std::exp(a * (y + z)) +
            2 * std::sin(a * y + d * z) * std::cos(a * x + d * y) * std::exp(a * (z + x)) +
            2 * std::sin(a * z + d * x) * std::cos(a * y + d * z) * std::exp(a * (x + y));
        return -a * a / 2 * std::exp(-2 * viscosity * d * d * t) * sum;
    }
};

struct Errors {
    double velocity, pressure;
};

/// On a mesh that swings; the cube -1 ... 1 would be the paper's, this is 0 ... 1.
Errors ethier_steinman(int n, int steps, double end, double viscosity) {
    const EthierSteinman exact{viscosity};
    FlowOptions options =
        fluid(1, viscosity, velocity_of([=](const Vec3& x, double t) { return exact.velocity(x, t); }));
    const Mesh start = unit_cube(n);
    const auto at = [&](double t) {
        Mesh mesh = start;
        for (Vec3& x : mesh.position) {
            const double bump = std::sin(pi * x.x) * std::sin(pi * x.y) * std::sin(pi * x.z);
            x += 0.1 * std::sin(2 * pi * t / end) * bump * Vec3{1, -0.5, 0.7};
        }
        return mesh;
    };
    Mesh before = at(0);
    FlowState state = still_flow(before);
    for (Vertex v : before.position.indices()) {
        state.velocity[v] = exact.velocity(before.position[v], 0);
        state.pressure[v] = exact.pressure(before.position[v], 0);
    }
    int iterations = 0, passes = 0;
    for (int step = 1; step <= steps; ++step) {
        const Mesh current = at(step * end / steps);
        const FlowReport report =
            step_flow(petsc().all_ranks(), before, current, options, state, (step - 1) * end / steps, end / steps);
        iterations += report.iterations;
        passes += report.passes;
        before = current;
    }
    double mean = 0, count = 0;
    for (Vertex v : before.position.indices()) {
        mean += exact.pressure(before.position[v], end) - state.pressure[v];
        ++count;
    }
    const Errors errors{velocity_error(before, state, [&](const Vec3& x) { return exact.velocity(x, end); }),
            pressure_error(before, state, [&](const Vec3& x) { return exact.pressure(x, end) - mean / count; })};
    if (loud()) std::printf("ES n %d steps %d: u %.4g p %.4g its %d passes %d\n", n, steps, errors.velocity, errors.pressure, iterations, passes);
    return errors;
}

TEST(FlowOrder, EthierAndSteinman) {
    const Errors a = ethier_steinman(6, 4, 0.4, 0.05), b = ethier_steinman(9, 6, 0.4, 0.05),
                 c = ethier_steinman(12, 8, 0.4, 0.05);
    const auto order = [](double coarse, double fine, double ratio) { return std::log(coarse / fine) / std::log(ratio); };
    if (loud()) std::printf("orders u %.3f %.3f p %.3f %.3f\n", order(a.velocity, b.velocity, 1.5), order(b.velocity, c.velocity, 4./3),
       order(a.pressure, b.pressure, 1.5), order(b.pressure, c.pressure, 4./3));
}

TEST(FlowOrder, InTimeAlone) {
    if (!loud()) GTEST_SKIP();
    for (int steps : {1, 2, 4, 8, 16, 32}) ethier_steinman(6, steps, 0.4, 0.05);
}

TEST(FlowOrder, StokesSphere) {
    for (int k : {1, 2, 3}) {
        const Mesh mesh = sphere_in_cube({.radius = 0.2, .half = 1, .around = 2 * k, .prisms = 2 * k, .layer = 0.06, .out = 4 * k});
        FlowOptions options = fluid(1, 1, velocity_of([](const Vec3& x, double) { return stokes_velocity(x, 0.2, 1); }));
        options.regions.emplace_back();
        options.convection = false;
        options.scheme = FlowScheme::steady;
        FlowState state = still_flow(mesh);
        const auto begin = std::chrono::steady_clock::now();
        const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const double drag = 6 * pi * 0.2;
        if (loud()) std::printf("k %d cells %zu+%zu K %.5f u %.4g p %.4g its %d net %.3g time %.2f passes %d\n", k, living_cells(mesh).tets.size(),
          living_cells(mesh).prisms.size(), report.bodies[0].force.z / drag,
          velocity_error(mesh, state, [](const Vec3& x) { return norm(x) < 0.2001 ? Vec3{} : stokes_velocity(x, 0.2, 1); }),
          pressure_error(mesh, state, [](const Vec3& x) { return stokes_pressure(x, 0.2, 1); }), report.iterations, report.net_flux, seconds, report.passes);
    }
}

TEST(FlowOrder, StokesSphereOfGenerator) {
    if (!loud()) GTEST_SKIP();
    for (double h : {0.06, 0.0425, 0.03}) {
        Domain domain{.box = {{-1, -1, -1}, {1, 1, 1}}};
        const double hh = getenv("LH") ? atof(getenv("LH")) : 0.35;
        domain.bodies.push_back({.name = "a", .shape = {.centre = {0, 0, 0}, .semi_axes = {0.2, 0.2, 0.2}},
             .layer = LayerOptions{.count = getenv("LC") ? atoi(getenv("LC")) : 3, .first_height = hh * h, .growth = 1.3}});
        domain.size = {.surface = h, .growth = getenv("GR") ? atof(getenv("GR")) : 0.2, .far = 0.25};
        const Mesh mesh = initial_mesh(domain, 1);
        FlowOptions options = fluid(1, 1, velocity_of([](const Vec3& x, double) { return stokes_velocity(x, 0.2, 1); }));
        options.regions.emplace_back();
        options.convection = false;
        options.scheme = FlowScheme::steady;
        FlowState state = still_flow(mesh);
        const auto begin = std::chrono::steady_clock::now();
        const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        const double drag = 6 * pi * 0.2;
        std::printf("h %g facets %zu cells %zu+%zu flow tets %zu K %.5f u %.4g p %.4g its %d net %.3g time %.2f passes %d\n", h, mesh.layers[0].triangles.size(), living_cells(mesh).tets.size(),
          living_cells(mesh).prisms.size(), living_cells(mesh, surroundings).tets.size(), report.bodies[0].force.z / drag,
          velocity_error(mesh, state, [](const Vec3& x) { return norm(x) < 0.2001 ? Vec3{} : stokes_velocity(x, 0.2, 1); }),
          pressure_error(mesh, state, [](const Vec3& x) { return stokes_pressure(x, 0.2, 1); }), report.iterations, report.net_flux, seconds, report.passes);
    }
}

TEST(FlowOrder, Re100) {
    if (!loud()) GTEST_SKIP();
    const auto num = [](const char* name, double v) { return getenv(name) ? atof(getenv(name)) : v; };
    const double h = num("H", 0.06), side = num("SIDE", 8);
        Domain domain{.box = {{-side, -side, -side}, {side, side, 2 * side}}};
        domain.bodies.push_back({.name = "a", .shape = {.centre = {0, 0, 0}, .semi_axes = {0.5, 0.5, 0.5}},
             .layer = LayerOptions{.count = int(num("LC", 4)), .first_height = num("LH", 0.3) * h, .growth = 1.3}});
        domain.size = {.surface = h, .growth = num("GR", 0.15), .far = 2};
        const Mesh mesh = initial_mesh(domain, 1);
        FlowOptions options{.regions = {FlowRegion{.density = 1, .viscosity = 0.01}, {}}};
        options.faces.fill({.kind = FlowFace::Kind::velocity, .velocity = uniform({0, 0, 1})});
        options.faces[5] = {.kind = FlowFace::Kind::open};
        options.scheme = FlowScheme::first_order;
        options.tolerance = num("TOL", 1e-4);
        FlowState state = still_flow(mesh);
        std::printf("facets %zu cells %zu+%zu vertices %d\n", mesh.layers[0].triangles.size(), living_cells(mesh).tets.size(),
          living_cells(mesh).prisms.size(), count_vertices(mesh));
        const auto begin = std::chrono::steady_clock::now();
        double dt = num("DT", 0.5), t = 0;
        for (int step = 0; step < num("STEPS", 14); ++step) {
            if (step >= num("STEADY", 100)) options.scheme = FlowScheme::steady;
            const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, t, dt);
            const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
            std::printf("t %g dt %g Cd %.5f its %d passes %d courant %.3g error %.2g time %.2f\n", t += dt, dt, report.bodies[0].force.z / (0.5 * pi / 4),
             report.iterations, report.passes, report.largest_courant, report.error, seconds);
            dt *= num("GROW", 1.5);
        }
}

}  // namespace
}  // namespace kropla
