// Spheres that are heated or cooled at their surface.
//   [Carslaw, Jaeger 1959] Conduction of heat in solids, 2nd ed.: 9.4 (exchange at the surface), 9.7 (constant flux), 2.2
//     (the infinite medium, of which a sphere is hot).
#include "heat_problems.h"
#include "simulate/cells.h"
#include "still_run.h"

#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

Quantity always(double value) {
    return [value](const Vec3&, double) { return value; };
}

/// A ball of radius 1 of equal shells.
std::vector<double> equal_shells(int count) {
    std::vector<double> radii;
    for (int k = 0; k <= count; ++k) radii.push_back(1.0 * k / count);
    return keeping_volumes(radii);
}

/// What acts on the whole surface of an eighth of a ball.
void set_surface(HeatOptions& options, const HeatFace& face) {
    for (std::size_t f : {1u, 3u, 5u}) options.faces[f] = face;
}

/// `solve(steps)` returns what is reached by so many steps.
template <class Solve>
std::vector<double> richardson(const Solve& solve, int steps) {
    const std::vector<double> whole = solve(steps);
    std::vector<double> half = solve(2 * steps);
    for (std::size_t k = 0; k < half.size(); ++k) half[k] += half[k] - whole[k];
    return half;
}

std::string richardson_of(int steps) {
    return std::to_string(steps) + " and " + std::to_string(2 * steps) + ", Richardson";
}

/// The temperature in a sphere of radius 1 and diffusivity 1 whose surface loses Bi T.
double robin_exact(double biot, double r, double t) {
    double sum = 0;
    for (int n = 0; n < 60; ++n) {
        const double zeta = root_between([&](double z) { return z * std::cos(z) + (biot - 1) * std::sin(z); },
                                         n * pi + 1e-9, (n + 1) * pi - 1e-9);
        const double c = 4 * (std::sin(zeta) - zeta * std::cos(zeta)) / (2 * zeta - std::sin(2 * zeta));
        sum += c * std::exp(-zeta * zeta * t) * (r > 0 ? std::sin(zeta * r) / (zeta * r) : 1);
    }
    return sum;
}

/// By how much a sphere of radius 1, conductivity and diffusivity 1 has warmed by a flux of 1.
double flux_exact(double r, double t) {
    double sum = 3 * t + r * r / 2 - 0.3;
    for (int n = 1; n <= 60; ++n) {
        const double zeta = root_between([](double z) { return std::sin(z) - z * std::cos(z); }, n * pi, (n + 0.5) * pi);
        sum -= 2 * (r > 0 ? std::sin(zeta * r) / (zeta * r) : 1) * std::exp(-zeta * zeta * t) / (zeta * std::sin(zeta));
    }
    return sum;
}

/// A sphere that was at 1 in a like medium at 0.
double like_medium_exact(double r, double t) {
    const double w = std::sqrt(4 * t);
    return 0.5 * (std::erf((1 - r) / w) + std::erf((1 + r) / w)) -
           std::sqrt(t / pi) / r * (std::exp(-(1 - r) * (1 - r) / (4 * t)) - std::exp(-(1 + r) * (1 + r) / (4 * t)));
}

/// A sphere, region 1, in a medium out to 5 radii: shells are thinnest at the interface.
struct InMedium {
    std::vector<double> radii;
    int sphere;  // shells of it
    Sector sector;
};

InMedium sphere_in_medium(int fineness) {
    const int n = 24 * fineness;
    std::vector<double> radii;
    for (int k = 0; k <= n; ++k) radii.push_back(1 - std::pow(1 - 1.0 * k / n, 1.6));
    for (double step = 0.015 / fineness; radii.back() < 5; step = std::min(step * (1 + 0.2 / fineness), 0.3 / fineness))
        radii.push_back(radii.back() + step);
    return {radii, n, sector_of_ball(radii, 2, [n](int shell) { return shell < n ? 1 : 0; })};
}

/// The sphere at 1, the medium at 0, and at the interface what both together hold.
NodalField sphere_at_one(const InMedium& in, const HeatOptions& options) {
    NodalField field = initial_temperature(in.sector.mesh, options);
    const Array<Vertex, double> one(in.sector.mesh.position.size(), 1.0), zero(in.sector.mesh.position.size(), 0.0);
    const auto hot = enthalpies(in.sector.mesh, options, one), cold = enthalpies(in.sector.mesh, options, zero);
    temperature_of(in.sector.mesh, options, {cold[0], hot[1]}, field.values);
    return field;
}

/// At Fo = 0.1 and 0.2 after so many steps: at the centre, the interface, the shell nearest to 1.5, and the mean.
std::vector<double> cooled_in_medium(const Ranks& ranks, const InMedium& in, const HeatOptions& options, double radius,
                                     int steps, Outcome& outcome) {
    StillRun run(ranks, in.sector.mesh, options, outcome);
    run.field = sphere_at_one(in, options);
    const HeatMaterial& m = options.regions[1].material;
    std::vector<double> found;
    for (double time : {0.1, 0.2}) {
        run.steps_to(time, steps);
        for (double r : {0.0, in.radii[static_cast<std::size_t>(in.sphere)], radius})
            found.push_back(mean_at_radius(in.sector.mesh, run.field, r));
        found.push_back(energy(in.sector.mesh, options, run.field.values, Region(1)) / (m.density(0) * in.sector.share));
    }
    return found;
}

/// The temperatures at the centre and at the surface [m], at one time after the other [s], by so many steps to each.
std::vector<double> at_centre_and_surface(StillRun& run, const Mesh& mesh, double surface, std::initializer_list<double> times,
                                          int steps) {
    std::vector<double> found;
    for (double time : times) {
        run.steps_to(time, steps);
        for (double r : {0.0, surface}) found.push_back(mean_at_radius(mesh, run.field, r));
    }
    return found;
}

}  // namespace

Outcome robin_sphere(const Ranks& ranks, double biot, int fineness) {
    const int shells = 10 * fineness, steps = 12 * fineness;
    const Mesh mesh = eighth_of_ball(equal_shells(shells), [](int) { return 0; });
    const double surface = equal_shells(shells).back();
    HeatOptions options{.regions = {HeatRegion{.initial = 1}}};
    set_surface(options, {HeatFace::Kind::exchange, {}, {.coefficient = always(biot), .ambient = always(0)}});
    Outcome outcome{std::to_string(shells) + " shells", richardson_of(2 * steps), {}};
    const auto solve = [&](int count) {
        StillRun run(ranks, mesh, options, outcome);
        return at_centre_and_surface(run, mesh, surface, {0.2, 0.5}, count);
    };
    const std::vector<double> found = richardson(solve, steps);
    outcome.reached = {{"centre, Fo 0.2 [-]", robin_exact(biot, 0, 0.2), found[0]},
                       {"surface, Fo 0.2 [-]", robin_exact(biot, 1, 0.2), found[1]},
                       {"centre, Fo 0.5 [-]", robin_exact(biot, 0, 0.5), found[2]},
                       {"surface, Fo 0.5 [-]", robin_exact(biot, 1, 0.5), found[3]}};
    return outcome;
}

Outcome heated_sphere(const Ranks& ranks, int fineness) {
    const int shells = 10 * fineness, steps = 10 * fineness;
    const double area_of_one = 4 * pi / 8;  // [m^2] the flux is given by its power: facets are a little larger
    const Mesh mesh = eighth_of_ball(equal_shells(shells), [](int) { return 0; });
    const double surface = equal_shells(shells).back();
    HeatOptions options{.regions = {HeatRegion{}}};
    set_surface(options, {.kind = HeatFace::Kind::flux, .power = always(area_of_one / 3)});
    Outcome outcome{std::to_string(shells) + " shells", richardson_of(2 * steps), {}};
    const auto solve = [&](int count) {
        StillRun run(ranks, mesh, options, outcome);
        return at_centre_and_surface(run, mesh, surface, {0.1, 0.5}, count);
    };
    const std::vector<double> found = richardson(solve, steps);
    outcome.reached = {{"centre, Fo 0.1 [K]", flux_exact(0, 0.1), found[0], flux_exact(1, 0.1)},
                       {"surface, Fo 0.1 [K]", flux_exact(1, 0.1), found[1]},
                       {"centre, Fo 0.5 [K]", flux_exact(0, 0.5), found[2]},
                       {"surface, Fo 0.5 [K]", flux_exact(1, 0.5), found[3]}};
    return outcome;
}

Outcome radiating_sphere(const Ranks& ranks, double ambient, int fineness) {
    // 3 emissivity sigma / (rho c a) is 1e-10 times a number: T falls by a third in a second.
    const double radius = 1e-3, emissivity = 0.4, hot = 2400;  // [m], [-], [K]
    const double stefan_boltzmann = 5.670374419e-8;            // [W/(m^2 K^4)] CODATA 2018
    const HeatMaterial material{.conductivity = 1e5, .density = 7000, .specific_heat = 800};
    const double rate = 3 * emissivity * stefan_boltzmann / (7000 * 800.0 * radius);  // [1/(s K^3)] of dT/dt = -rate T^4
    const double end = 1.5;                                                           // [s]
    const int shells = 4 * fineness, steps = 25 * fineness;
    std::vector<double> radii = equal_shells(shells);
    for (double& r : radii) r *= radius;
    const Mesh mesh = eighth_of_ball(radii, [](int) { return 0; });
    HeatOptions options{.regions = {HeatRegion{.material = material, .initial = hot}}};
    set_surface(options, {HeatFace::Kind::exchange, {}, {.emissivity = always(emissivity), .ambient = always(ambient)}});
    Outcome outcome{std::to_string(shells) + " shells", richardson_of(steps), {}};
    const auto solve = [&](int count) {
        StillRun run(ranks, mesh, options, outcome);
        run.steps_to(end, count);
        return std::vector<double>{energy(mesh, options, run.field.values) / (7000 * 800.0 * pi / 6 * std::pow(radius, 3))};
    };
    // The time that it takes to fall from `hot`, times `rate`: the integral of dT / (T^4 - ambient^4).
    const auto taken = [&](double t) {
        if (ambient == 0) return (1 / std::pow(t, 3) - 1 / std::pow(hot, 3)) / 3;
        const double a = ambient;
        return std::log((t + a) * (hot - a) / ((t - a) * (hot + a))) / (4 * a * a * a) +
               (std::atan(t / a) - std::atan(hot / a)) / (2 * a * a * a);
    };
    const double exact = root_between([&](double t) { return taken(t) - rate * end; }, ambient + 1, hot);
    outcome.reached = {{"temperature at 1.5 s [K]", exact, richardson(solve, steps)[0]}};
    return outcome;
}

Outcome sphere_in_like_medium(const Ranks& ranks, int fineness) {
    const InMedium in = sphere_in_medium(fineness);
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    const double radius = in.radii[static_cast<std::size_t>(in.sphere) + 12u * static_cast<unsigned>(fineness)];
    const int steps = 15 * fineness;
    Outcome outcome{std::to_string(in.sphere) + " shells in the sphere, " +
                        std::to_string(in.radii.size() - 1 - static_cast<std::size_t>(in.sphere)) + " beyond",
                    richardson_of(2 * steps), {}};
    const std::vector<double> found = richardson(
        [&](int count) { return cooled_in_medium(ranks, in, options, radius, count, outcome); }, steps);
    // The mean over the sphere, of the series of the closed form's integral, by Simpson's rule.
    const auto mean = [](double t) {
        double sum = 0;
        constexpr int pieces = 2000;
        for (int k = 1; k <= pieces; ++k) {
            const double r = 1.0 * k / pieces;
            sum += (k == pieces ? 1 : k % 2 == 1 ? 4 : 2) * 3 * r * r * like_medium_exact(r, t);
        }
        return sum / (3 * pieces);
    };
    std::size_t k = 0;
    for (double t : {0.1, 0.2}) {
        const std::string at = t == 0.1 ? ", Fo 0.1 [-]" : ", Fo 0.2 [-]";
        outcome.reached.push_back({"centre" + at, like_medium_exact(1e-4, t), found[k++]});
        outcome.reached.push_back({"surface" + at, like_medium_exact(1, t), found[k++]});
        outcome.reached.push_back({"medium" + at, like_medium_exact(radius, t), found[k++], 1});
        outcome.reached.push_back({"mean" + at, mean(t), found[k++]});
    }
    return outcome;
}

Outcome sphere_in_poor_medium(const Ranks& ranks, int fineness) {
    const InMedium in = sphere_in_medium(fineness);
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[1].material = {.conductivity = 10, .density = 10};
    const double surface = in.radii[static_cast<std::size_t>(in.sphere)];
    const int steps = 15 * fineness;
    Outcome outcome{std::to_string(in.sphere) + " shells in the sphere, " +
                        std::to_string(in.radii.size() - 1 - static_cast<std::size_t>(in.sphere)) + " beyond",
                    richardson_of(2 * steps), {}};
    const std::vector<double> found = richardson(
        [&](int count) { return cooled_in_medium(ranks, in, options, surface, count, outcome); }, steps);
    // By inversion of the Laplace transform; there is no closed form.
    outcome.reached = {{"centre, Fo 0.1 [-]", 0.9637873, found[0]}, {"surface, Fo 0.1 [-]", 0.8334227, found[1]},
                       {"mean, Fo 0.1 [-]", 0.8829505, found[3]},   {"centre, Fo 0.2 [-]", 0.8863476, found[4]},
                       {"surface, Fo 0.2 [-]", 0.7892888, found[5]}, {"mean, Fo 0.2 [-]", 0.8256699, found[7]}};
    return outcome;
}

}  // namespace kropla
