#include "still_run.h"

#include <kropla/mesh/cells.h>
#include "simulate/elements.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace kropla {

double Outcome::error() const {
    double largest = 0;
    for (const Reached& value : reached) largest = std::max(largest, std::abs(value.error()));
    return largest;
}

void StillRun::steps_to(double end, int count) {
    const double dt = (end - time) / count;
    for (int k = 0; k < count; ++k, time += dt) {
        const HeatReport report = step_heat(ranks_, mesh_, mesh_, options_, field, time, dt);
        const HeatBalance& balance = report.balance;
        const HeatExtremes& extremes = report.extremes;
        const double range = extremes.most.value - extremes.least.value;
        outcome_.passes = std::max(outcome_.passes, report.passes);
        outcome_.balance = std::max(outcome_.balance, std::abs(balance.error()) /
                                                          (std::abs(balance.before) + std::abs(balance.brought())));
        if (range > 0)
            outcome_.beyond = std::max({outcome_.beyond, (extremes.lower - extremes.least.value) / range,
                                        (extremes.most.value - extremes.upper) / range});
    }
    time = end;
}

double solid_volume(const Mesh& mesh, const NodalField& temperature, double solidus, double liquidus) {
    double sum = 0;
    for (Tet t : living_cells(mesh).tets) {
        double solid = 0;
        for (Vertex v : mesh.tets[t])
            solid += std::clamp((liquidus - temperature.values[v]) / (liquidus - solidus), 0.0, 1.0) / 4;
        sum += solid * linear_tet(corners(mesh, t)).volume;
    }
    return sum;
}

Mesh eighth_of_ball(const std::vector<double>& radii, const std::function<int(int shell)>& region) {
    const int m = static_cast<int>(radii.size()) - 1;
    return cube_grid(2 * m, 2 * m, 2 * m, on_spheres(radii), [&](int i, int j, int k) {
        return std::min({i, j, k}) < m ? -1 : region(std::max({i, j, k}) - m);
    });
}

Sector sector_of_ball(const std::vector<double>& radii, int across, const std::function<int(int shell)>& region) {
    constexpr double width = 0.12;  // [-] of the radius, about
    const std::size_t hollow = radii.front() == 0 ? 1 : 0;  // the grid begins at this radius
    const auto place = [&](int i, int j, int k) {
        return radii[hollow + static_cast<std::size_t>(i)] * normalised(Vec3{1, width * j / across, width * k / across});
    };
    const int layers = static_cast<int>(radii.size() - 1 - hollow);
    const auto region_of = [&](int i, int, int) { return region(i + static_cast<int>(hollow)); };
    Mesh mesh = cube_grid(layers, across, across, place, region_of);
    if (hollow == 1) {
        Array<Tet, std::array<Vertex, 4>> tets = mesh.tets;
        Array<Tet, Region> regions = mesh.region;
        Array<Vertex, Vec3> position = mesh.position;
        const Vertex apex = position.push_back({});
        for (const auto& tet : mesh.tets)
            for (const auto& facet : tet_facets) {
                std::array<Vertex, 4> added = {apex, {}, {}, {}};
                bool innermost = true;
                for (std::size_t k = 0; k < 3; ++k) {
                    added[k + 1] = tet[static_cast<std::size_t>(facet[k])];
                    innermost = innermost && norm(position[added[k + 1]]) < 0.5 * (radii[1] + radii[2]);
                }
                if (!innermost) continue;
                const Corners<4> x = {position[apex], position[added[1]], position[added[2]], position[added[3]]};
                if (linear_tet(x).volume < 0) std::swap(added[2], added[3]);
                tets.push_back(added);
                regions.push_back(Region(region(0)));
            }
        mesh = make_mesh(std::move(position), std::move(tets), std::move(regions));
    }
    double volume = 0;
    for (Tet t : mesh.tets.indices()) {
        volume += linear_tet(corners(mesh, t)).volume;
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (mesh.neighbour[t][corner].exists()) continue;
            double least = INFINITY, most = 0;
            for (std::size_t other = 1; other < 4; ++other) {
                const double r = norm(mesh.position[mesh.tets[t][(corner + other) % 4]]);
                least = std::min(least, r);
                most = std::max(most, r);
            }
            const bool inner = most < 1.0001 * radii.front(), outer = least > 0.9999 * radii.back();
            mesh.patch[t][corner] = Patch(inner ? 2 : outer ? 1 : 0);
        }
    }
    const auto cube = [](double r) { return r * r * r; };
    return {std::move(mesh), volume / (cube(radii.back()) - cube(radii.front()))};
}

std::vector<double> keeping_volumes(const std::vector<double>& radii) {
    std::vector<double> kept = radii;
    const Mesh mesh = eighth_of_ball(radii, [](int shell) { return shell; });
    std::vector<double> within(radii.size(), 0.0);  // [m^3] of each shell
    for (Tet t : living_cells(mesh).tets)
        within[static_cast<std::size_t>(mesh.region[t].value) + 1] += linear_tet(corners(mesh, t)).volume;
    double enclosed = 0;
    for (std::size_t k = 1; k < radii.size(); ++k) {
        enclosed += within[k];
        kept[k] *= std::cbrt(std::numbers::pi / 6 * radii[k] * radii[k] * radii[k] / enclosed);
    }
    return kept;
}

double mean_at_radius(const Mesh& mesh, const NodalField& field, double radius) {
    double sum = 0, count = 0;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v) && std::abs(norm(mesh.position[v]) - radius) <= 1e-9 * radius) sum += field.values[v], ++count;
    if (count == 0) throw std::logic_error("no vertex at this radius");
    return sum / count;
}

double value_at_vertex(const Mesh& mesh, const NodalField& field, const Vec3& place) {
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v) && norm(mesh.position[v] - place) < 1e-9) return field.values[v];
    throw std::logic_error("no vertex at this place");
}

double root_between(const std::function<double(double)>& function, double low, double high) {
    const bool rising = function(high) > 0;
    for (int halves = 0; halves < 100; ++halves) {
        const double middle = 0.5 * (low + high);
        ((function(middle) > 0) == rising ? high : low) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace kropla
