// Gauss's flux on a half-space, at rest and moving.
//   [Carslaw, Jaeger 1959] Conduction of heat in solids, 2nd ed., 10.2: an instantaneous source; the sum over them is
//   [Eagar, Tsai 1983] Temperature fields produced by traveling distributed heat sources. Welding Journal 62.
#include "heat_problems.h"
#include "still_run.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

struct Source {
    double power, width, speed;  // [W], [m] the standard deviation, [m/s] along x
};


constexpr double conductivity = 30, diffusivity = 5.5e-6;  // [W/(m K)], [m^2/s]

/// By how much it is warmer [K] at a place seen from the source, after it has acted for a time [s]: the integral over
/// the ages of what was set free, by Simpson's rule in the root of the age.
double exact(const Source& source, const Vec3& x, double time) {
    constexpr int pieces = 4000;
    const double capacity = conductivity / diffusivity, step = std::sqrt(time) / pieces;
    double sum = 0;
    for (int k = 0; k <= pieces; ++k) {
        const double root = k * step, age = root * root;
        const double spread = 2 * diffusivity * age + source.width * source.width;
        const double ahead = x.x + source.speed * age;
        const double deep = x.z == 0 ? 1 : age == 0 ? 0 : std::exp(-x.z * x.z / (4 * diffusivity * age));
        const double weight = k == 0 || k == pieces ? 1 : k % 2 == 1 ? 4 : 2;
        sum += weight * deep * std::exp(-(ahead * ahead + x.y * x.y) / (2 * spread)) / spread;
    }
    // 2 sqrt(age) d sqrt(age), over sqrt(4 pi alpha age), twice for the half-space
    return source.power / (pi * capacity) / std::sqrt(4 * pi * diffusivity) * 2 * sum * step / 3;
}

/// Places from `begin` on: `even` steps h, then each longer than the one before, over `beyond` [m].
std::vector<double> lines(double begin, int even, double h, double growth, double beyond) {
    std::vector<double> at = {begin};
    for (int k = 1; k <= even; ++k) at.push_back(begin + k * h);
    const double last = at.back() + beyond;
    for (double step = h * growth; at.back() < last; step *= growth) at.push_back(at.back() + step);
    return at;
}

Mesh box(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z) {
    const auto place = [&](int i, int j, int k) {
        return Vec3{x[static_cast<std::size_t>(i)], y[static_cast<std::size_t>(j)], z[static_cast<std::size_t>(k)]};
    };
    const auto cells = [](const std::vector<double>& at) { return static_cast<int>(at.size()) - 1; };
    return cube_grid(cells(x), cells(y), cells(z), place, [](int, int, int) { return 0; });
}

/// The half-space is z > 0; the source stands at x = 0 when the time has come.
HeatOptions heated_by(const Source& source, double time) {
    HeatOptions options{.regions = {HeatRegion{
        .material = {.conductivity = conductivity, .density = 1 / diffusivity, .specific_heat = conductivity}}}};
    options.faces[4] = {HeatFace::Kind::flux, [source, time](const Vec3& x, double t) {
                            const double ahead = x.x - source.speed * (t - time);
                            const double s2 = source.width * source.width;
                            return source.power / (2 * pi * s2) * std::exp(-(ahead * ahead + x.y * x.y) / (2 * s2));
                        }};
    return options;
}

Outcome solve(const Ranks& ranks, const Source& source, const Mesh& mesh, double time, int steps,
              const std::vector<std::pair<std::string, Vec3>>& places) {
    const HeatOptions options = heated_by(source, time);
    Outcome outcome{"", std::to_string(steps) + " and " + std::to_string(2 * steps) + ", Richardson", {}};
    for (const auto& [name, place] : places) outcome.reached.push_back({name, exact(source, place, time), 0});
    for (int half : {0, 1}) {
        StillRun run(ranks, mesh, options, outcome);
        run.steps_to(time, half == 0 ? steps : 2 * steps);
        for (std::size_t k = 0; k < places.size(); ++k)
            outcome.reached[k].value += (half == 0 ? -1 : 2) * value_at_vertex(mesh, run.field, places[k].second);
    }
    return outcome;
}

}  // namespace

Outcome resting_source(const Ranks& ranks, double time, int fineness) {
    const Source source{1000, 1.5e-3, 0};
    const double h = 0.25e-3 / fineness, beyond = 4 * std::sqrt(4 * diffusivity * time);
    const std::vector<double> at = lines(0, 12 * fineness, h, 1 + 0.25 / fineness, beyond);
    const Mesh mesh = box(at, at, lines(0, 6 * fineness, h / 3, 1 + 0.25 / fineness, beyond));
    Outcome outcome = solve(ranks, source, mesh, time, 12 * fineness, {{"centre [K]", {}}});
    outcome.mesh = "a quarter, cells of a sixth of the width at the source" + std::string(fineness > 1 ? ", halved" : "");
    return outcome;
}

Outcome moving_source(const Ranks& ranks, double time, int fineness) {
    const Source source{3000, 2e-3, 8e-3};
    const double h = 0.5e-3 / fineness, growth = 1 + 0.25 / fineness, beyond = 3 * std::sqrt(4 * diffusivity * time);
    // Along x evenly from one and a half widths behind where it began to as much before where it ends.
    const int behind = static_cast<int>(std::ceil((source.speed * time + 1.5 * source.width) / h)),
              before = static_cast<int>(std::ceil(1.5 * source.width / h));
    std::vector<double> x;
    for (double p : lines(0, behind, h, growth, 3 * source.width + beyond)) x.insert(x.begin(), -p);
    const std::vector<double> ahead = lines(0, before, h, growth, 3 * source.width + beyond);
    x.insert(x.end(), ahead.begin() + 1, ahead.end());
    const Mesh mesh = box(x, lines(0, 6 * fineness, h, growth, 2 * source.width + beyond), lines(0, 8 * fineness, h / 4, growth, beyond));
    Outcome outcome = solve(ranks, source, mesh, time, 10 * fineness,
                            {{"centre [K]", {}}, {"2 mm behind [K]", {-2e-3, 0, 0}}, {"2 mm beside [K]", {0, 2e-3, 0}},
                             {"1 mm deep [K]", {0, 0, 1e-3}}});
    outcome.mesh = "half, cells of a quarter of the width along the way" + std::string(fineness > 1 ? ", halved" : "");
    return outcome;
}

}  // namespace kropla
