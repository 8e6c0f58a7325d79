// Problems with a front of melting whose place is known.
//   [Carslaw, Jaeger 1959] Conduction of heat in solids, 2nd ed., chapter 11: Stefan's and Neumann's solutions.
//   [Paterson 1952] Propagation of a boundary of fusion. Proc. Glasgow Math. Assoc. 1: the spherical one.
#include "heat_problems.h"
#include "still_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

std::string number(double value) {
    std::string text = std::to_string(value);
    text.erase(std::max(text.find_last_not_of('0'), text.find('.') + 1) + 1);
    return text;
}

Quantity always(double value) {
    return [value](const Vec3&, double) { return value; };
}

/// A bar of square cubes, `even` of them of the size h [m], and as many more as it takes to `length`, each longer by a
/// tenth than the one before.
Mesh bar(double h, int even, double length) {
    std::vector<double> x = {0};
    for (double step = h; x.back() < length || static_cast<int>(x.size()) <= even;) {
        x.push_back(x.back() + step);
        if (static_cast<int>(x.size()) > even) step *= 1.1;
    }
    const auto place = [&](int i, int j, int k) { return Vec3{x[static_cast<std::size_t>(i)], h * j, h * k}; };
    return cube_grid(static_cast<int>(x.size()) - 1, 1, 1, place, [](int, int, int) { return 0; });
}

/// e^(-x^2)/x - sqrt(pi) erfc(x): what a source of the strength of sqrt(t) at a point makes.
double point_source(double x) {
    return std::exp(-x * x) / x - std::sqrt(pi) * std::erfc(x);
}

}  // namespace

Outcome one_phase_stefan(const Ranks& ranks, double stefan_number, int fineness) {
    const double width = 1e-3;  // [K] of melting, of the 1 K between wall and liquid
    const int behind = 25 * fineness, steps = 100 * fineness;
    const double lambda = root_between(
        [&](double l) { return l * std::exp(l * l) * std::erf(l) - stefan_number / std::sqrt(pi); }, 1e-3, 3);
    const double front = 2 * lambda, h = front / behind;  // at 1 s
    const Mesh mesh = bar(h, behind + 10, front);
    HeatOptions options{.regions = {HeatRegion{.material = {.latent_heat = 1 / stefan_number, .solidus = -width}}}};
    options.faces[0] = {HeatFace::Kind::value, always(-1)};
    Outcome outcome{std::to_string(behind) + " cells behind the front, melting within " + number(width) + " K of 1",
                    std::to_string(steps) + " equal", {}};
    StillRun run(ranks, mesh, options, outcome);
    run.steps_to(1, steps);
    outcome.reached = {{"front [m]", front, solid_volume(mesh, run.field, -width, 0) / (h * h)}};
    return outcome;
}

Outcome two_phase_stefan(const Ranks& ranks, const TwoPhases& m, int fineness) {
    const double width = 1e-3 * (m.melting - m.wall);  // [K] of melting
    const int behind = 25 * fineness, steps = 100 * fineness;
    const double solid = m.conductivity_solid / (m.density * m.heat_solid),  // [m^2/s]
                 liquid = m.conductivity_liquid / (m.density * m.heat_liquid);
    const double ratio = std::sqrt(solid / liquid);
    const double lambda = root_between(
        [&](double l) {
            return std::exp(-l * l) / std::erf(l) -
                   m.conductivity_liquid / m.conductivity_solid * ratio * (m.initial - m.melting) /
                       (m.melting - m.wall) * std::exp(-l * l * ratio * ratio) / std::erfc(l * ratio) -
                   l * std::sqrt(pi) * m.latent_heat / (m.heat_solid * (m.melting - m.wall));
        },
        1e-3, 3);
    const double front = 2 * lambda * std::sqrt(solid * m.time), h = front / behind;
    const Mesh mesh = bar(h, behind + 10, 10 * std::sqrt(liquid * m.time));
    const double below = m.melting - width;  // the tables jump within the melting
    HeatOptions options{.regions = {HeatRegion{
        .material = {.conductivity = Property({below, m.melting}, {m.conductivity_solid, m.conductivity_liquid}),
                     .density = m.density,
                     .specific_heat = Property({below, m.melting}, {m.heat_solid, m.heat_liquid}),
                     .latent_heat = m.latent_heat,
                     .solidus = below,
                     .liquidus = m.melting},
        .initial = m.initial}}};
    options.faces[0] = {HeatFace::Kind::value, always(m.wall)};
    Outcome outcome{std::to_string(behind) + " cells behind the front, melting within " + number(width) + " K",
                    std::to_string(steps) + " equal", {}};
    StillRun run(ranks, mesh, options, outcome);
    run.steps_to(m.time, steps);
    outcome.reached = {{"front [m]", front, solid_volume(mesh, run.field, below, m.melting) / (h * h)}};
    return outcome;
}

Outcome freezing_ball(const Ranks& ranks, int fineness) {
    const double lambda = 0.5, latent = 1, warmer = 0.2, width = 1e-3;  // [J/kg], [K]
    const double start = 1, end = 4, hole = 0.5;                       // [s], [m]: the front goes from 1 m to 2 m
    const double at_front = point_source(lambda);
    const double strength = 2 * latent * std::pow(lambda, 3) * std::exp(lambda * lambda) + warmer / at_front;
    const auto exact = [=](const Vec3& x, double t) {
        const double at = point_source(norm(x) / (2 * std::sqrt(start + t)));
        return at > at_front ? strength * (at_front - at) : warmer * (1 - at / at_front);
    };
    const int even = 38 * fineness;
    std::vector<double> radii = {hole};
    for (double step = 1.9 / even; radii.back() < 9;) {
        radii.push_back(radii.back() + step);
        if (radii.back() > 2.4) step *= 1 + 0.2 / fineness;
    }
    const auto [mesh, share] = sector_of_ball(radii, 2, [](int) { return 0; });
    HeatOptions options{.regions = {HeatRegion{.material = {.latent_heat = latent, .solidus = -width},
                                               .initial = Quantity(exact)}}};
    options.faces[2] = {HeatFace::Kind::value, exact};
    const int steps = 60 * fineness;
    Outcome outcome{std::to_string(even) + " shells of a sector from 0.5 m to 2.4 m, melting within " + number(width) + " K",
                    std::to_string(steps) + " equal", {}};
    StillRun run(ranks, mesh, options, outcome);
    run.steps_to(end - start, steps);
    const double solid = solid_volume(mesh, run.field, -width, 0);
    outcome.reached = {{"front [m]", 2 * lambda * std::sqrt(end), std::cbrt(solid / share + std::pow(hole, 3))}};
    return outcome;
}

}  // namespace kropla
