// Steps of the heat equation, of all regions or of one, and the steady state that a run begins with: what a step is made of,
// and its solution (heat_solution.h).
#include "simulate/heat_step.h"

#include <kropla/base/error.h>
#include <kropla/simulate/species.h>
#include "simulate/bounded.h"
#include "simulate/carried.h"
#include "simulate/heat_solution.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace kropla {
namespace {

Array<Region, Array<Vertex, Vec3>> carry_bodies(const Mesh& before, const Mesh& current, const HeatOptions& options) {
    Array<Region, Array<Vertex, Vec3>> carried(options.regions.size());
    for (Region body : regions_that(Carried::with_mesh, options)) carried[body] = carried_along(before, current, body);
    return carried;
}

/// A time [s] after which nothing is left of how a steady state began: heat passes the domain ten million times.
double long_enough(const Mesh& mesh, const HeatOptions& options) {
    Vec3 least{INFINITY, INFINITY, INFINITY}, most = -1.0 * least;
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) {
            for (int axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], mesh.position[v][axis]);
                most[axis] = std::max(most[axis], mesh.position[v][axis]);
            }
        }
    });
    double slowest = 0;  // [s/m^2]
    for (const HeatRegion& region : options.regions) {
        const Enthalpy enthalpy(region.material);
        for (double k : region.material.conductivity.values())
            slowest = std::max(slowest, enthalpy.slope(region.initial.value) / k);
    }
    return 1e7 * slowest * squared_norm(most - least);
}

HeatStep heat_step(const Mesh& before, const Mesh& current, const HeatOptions& options, const HeatConditions& conditions,
                   const MaterialFlow& flow, const Array<Vertex, double>& values, double dt) {
    return {.before = before,
            .current = current,
            .options = options,
            .old_temperature = values,
            .flow = flow,
            .carried = carry_bodies(before, current, options),
            .source = conditions.source,
            .dt = dt,
            .enthalpy = enthalpy_curves(options, flow.by_mass),
            .material = Array<Region, MaterialState>(options.regions.size())};
}

/// Every piece is to have something that says how warm it is.
void check_known(const Mesh& mesh, const HeatOptions& options, const HeatConditions& conditions) {
    const Pieces pieces = pieces_of(mesh, living_cells(mesh));
    std::vector<char> known(as_size(pieces.count), 0);
    for (const FixedValue& fixed : conditions.fixed) known[as_size(pieces.of[fixed.vertex])] = 1;
    for (const BoundaryShare& share : conditions.shares)
        if (share.exchanges()) known[as_size(pieces.of[share.vertex])] = 1;
    for (Vertex v : pieces.of.indices()) {
        if (pieces.of[v] < 0 || known[as_size(pieces.of[v])] != 0) continue;
        const Vec3& x = mesh.position[v];
        std::ostringstream message;
        message << options.key << ": there is no steady state, or more than one, in the part at (" << x.x << ", " << x.y
                << ", " << x.z << ") m, which meets no other: no face, surface or region says how warm it is";
        throw CaseError(message.str());
    }
}

/// Brings values of cells' vertices back to bounds, which are of what they are per `unit(vertex)`; that counts by
/// `weight(cell, vertex)` times the vertex's share of the cell.
template <class Weight, class Unit>
void keep_values(const Ranks& ranks, const Mesh& mesh, const Cells& cells, double least, double most, const Weight& weight,
                 const Unit& unit, Array<Vertex, double>& kept) {
    const Pattern pattern = make_pattern(mesh, cells, ranks);
    const std::vector<Vertex>& vertices = pattern.numbering.vertex;
    std::vector<double> held(vertices.size(), 0.0), values;
    for_each_share(mesh, cells, [&](const auto& cell, Vertex v, double volume) {
        held[as_size(pattern.numbering.row[v])] += weight(cell, v) * volume;
    });
    for (Vertex v : vertices) values.push_back(kept[v] / unit(v));
    (void)repair(ranks, pattern, held, least, 1, values);
    (void)repair(ranks, pattern, held, most, -1, values);
    for (std::size_t r = 0; r < values.size(); ++r) kept[vertices[r]] = values[r] * unit(vertices[r]);
}

void check_step(const Mesh& mesh, const HeatOptions& options, double dt) {
    check_heat(options, mesh);
    if (!(dt > 0)) throw CaseError(options.key + ": the step must be positive, got " + std::to_string(dt) + " s");
}

}  // namespace

std::vector<Region> regions_that(Carried move, const HeatOptions& options) {
    std::vector<Region> regions;
    for (std::size_t r = 0; r < options.regions.size(); ++r)
        if (options.regions[r].carried == move) regions.push_back(Region(r));
    return regions;
}

HeatReport step_heat_in(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                        const MaterialFlow& flow, Region only, Array<Vertex, double>& values, double t, double dt,
                        const Array<Vertex, double>& guess) {
    const HeatConditions conditions = heat_conditions(before, current, options, only, t, dt, ranks.watch);
    HeatStep step = heat_step(before, current, options, conditions, flow, values, dt);
    step.only = only;
    HeatSolution solution(ranks, step, conditions);
    if (!guess.empty()) solution.begin_with(guess);
    solution.solve_all();
    HeatReport report = solution.report();
    report.potential_iterations = flow.iterations;
    values = solution.after();
    return report;
}

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt) {
    check_step(current, options, dt);
    const MaterialFlow flow = material_flow(ranks, before, current, regions_that(Carried::with_flow, options), dt);
    return step_heat_in(ranks, before, current, options, flow, {}, temperature.values, t, dt);
}

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     const MaterialFlow& flow, NodalField& temperature, double t, double dt,
                     const Array<Vertex, double>& guess) {
    check_step(current, options, dt);
    return step_heat_in(ranks, before, current, options, flow, {}, temperature.values, t, dt, guess);
}

void keep_within(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, double least, double most,
                 Array<Vertex, double>& temperature) {
    const std::vector<double> capacity = capacities(options);
    keep_values(ranks, mesh, living_cells(mesh), least, most,
                [&](const auto& cell, Vertex) { return capacity[as_size(cell_region(mesh, cell).value)]; },
                [](Vertex) { return 1.0; }, temperature);
}

void keep_within(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, double least, double most,
                 std::vector<Array<Vertex, double>>& enthalpies, const KnownDensity& known) {
    const Array<Region, Enthalpy> curve = enthalpy_curves(options, known.region);
    for (Region region : curve.indices()) {
        const auto density = [&](Vertex v) { return region == known.region ? known.values[v] : 1.0; };
        keep_values(ranks, mesh, living_cells(mesh, region), curve[region](least), curve[region](most),
                    [&](const auto&, Vertex v) { return density(v); }, density, enthalpies[as_size(region.value)]);
    }
}

void keep_within(const Ranks& ranks, const Mesh& mesh, Region region, double least, double most, Array<Vertex, double>& values) {
    const auto one = [](auto&&...) { return 1.0; };
    keep_values(ranks, mesh, living_cells(mesh, region), least, most, one, one, values);
}

void settle_start(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, NodalField& field) {
    const double dt = long_enough(mesh, options);
    HeatConditions conditions = heat_conditions(mesh, mesh, options, {}, 0, dt, ranks.watch);
    Array<Vertex, char> known(mesh.position.size(), 0);
    for (const FixedValue& fixed : conditions.fixed) known[fixed.vertex] = 1;
    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        if (options.regions[r].initial.steady) continue;
        for_each_cell(living_cells(mesh, Region(r)), [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell))
                if (std::exchange(known[v], 1) == 0)
                    conditions.fixed.push_back({v, field.values[v], {Origin::Kind::held, r}});
        });
    }
    check_known(mesh, options, conditions);
    const MaterialFlow rest{Array<Region, Array<Vertex, double>>(options.regions.size())};
    HeatStep step = heat_step(mesh, mesh, options, conditions, rest, field.values, dt);
    HeatSolution solution(ranks, step, conditions);
    solution.solve_all();
    field.values = solution.after();
}

}  // namespace kropla
