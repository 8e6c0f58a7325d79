// What the report of a step of the heat equation says of temperatures and energy: extremes, and where energy came from.
#include "simulate/heat_balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

/// The signs with which heat comes from outside.
struct Signs {
    bool cools = false, heats = false;

    void note(double value) {
        cools = cools || value < 0;
        heats = heats || value > 0;
    }
};

/// Adds what shares of the boundary and the flow through faces brought. Returns it by vertices [J].
Array<Vertex, double> add_conditions(const HeatStep& step, const HeatConditions& conditions,
                                     const Array<Vertex, double>& solved, HeatBalance& sum) {
    Array<Vertex, double> acting(solved.size(), 0.0);
    for (const BoundaryShare& share : conditions.shares) {
        const double in = step.dt * (share.flux - share.given(solved[share.vertex]));
        acting[share.vertex] += in;
        if (share.origin.kind == Origin::Kind::face) sum.faces[share.origin.number] += in;
        else sum.surfaces[share.origin.number - 1] += in;
    }
    for (const auto& [v, region, face, rate] : step.flow.through) {
        if (!step.steps(region)) continue;
        const double temperature = rate < 0 ? step.old_temperature[v] : solved[v];
        const double in = -step.dt * rate * step.enthalpy[region](temperature);
        acting[v] += in;
        sum.faces[face] += in;
    }
    return acting;
}

void add_sources(const HeatStep& step, const HeatConditions& conditions, HeatBalance& sum) {
    if (std::ranges::all_of(conditions.source, [](const auto& source) { return source.empty(); })) return;
    for_each_share(step.current, living_cells(step.current, step.only), [&](const auto& cell, Vertex v, double volume) {
        const Region region = cell_region(step.current, cell);
        if (const auto& source = conditions.source[region]; !source.empty())
            sum.sources[static_cast<std::size_t>(region.value)] += step.dt * volume * source[v];
    });
}

/// Adds what came and left with the material of regions whose volume changes.
void add_expansion(const HeatStep& step, const Array<Vertex, double>& solved, HeatBalance& sum) {
    const MaterialFlow& flow = step.flow;
    for (Region region : flow.expansion.indices()) {
        if (!step.steps(region) || !flow.expands(region)) continue;
        const auto add = [&](const auto&, Vertex v, double share) {
            const double grown = step.dt * flow.expansion[region][v] * share;
            const double temperature = grown > 0 ? step.old_temperature[v] : solved[v];
            sum.expansion[as_size(region.value)] += grown * step.enthalpy[region](temperature);
        };
        const Cells cells = living_cells(step.current, region);
        if (region == flow.by_mass) for_each_mass(step.current, cells, flow.density, add);
        else for_each_share(step.current, cells, add);
    }
}

/// Adds what kept values as they are fixed: what the cells gained there and nothing acting on it brought.
void add_fixed(const Ranks& ranks, const Mesh& mesh, const std::vector<FixedValue>& fixed, const Assembled& solved,
               const Array<Vertex, double>& acting, HeatBalance& sum) {
    std::vector<double> kept(fixed.size(), 0.0);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const Vertex v = fixed[k].vertex;
        const int row = solved.pattern.numbering.row[v] - solved.pattern.rows.first_row;
        if (row < 0 || static_cast<std::size_t>(row) >= solved.pattern.rows.count()) continue;
        kept[k] = gained_at(solved, mesh, static_cast<std::size_t>(row), [](const auto&) { return true; },
                            [](Vertex) { return true; }) - acting[v];
    }
    MPI_Allreduce(MPI_IN_PLACE, kept.data(), static_cast<int>(kept.size()), MPI_DOUBLE, MPI_SUM, ranks.communicator);
    for (std::size_t k = 0; k < kept.size(); ++k) {
        const Origin origin = fixed[k].origin;
        (origin.kind == Origin::Kind::face ? sum.faces[origin.number] : sum.held[origin.number]) += kept[k];
    }
}

}  // namespace

HeatExtremes heat_extremes(const HeatStep& step, const HeatConditions& conditions, const std::vector<Vertex>& vertices,
                           const Array<Vertex, double>& after) {
    const Vertex first = vertices.front();
    const double start = step.old_temperature[first];
    HeatExtremes found{{after[first], step.current.position[first]}, {after[first], step.current.position[first]},
                       start, start};
    const auto widen = [&](double value) {
        found.lower = std::min(found.lower, value);
        found.upper = std::max(found.upper, value);
    };
    for (Vertex v : vertices) {
        widen(step.old_temperature[v]);
        if (after[v] < found.least.value) found.least = {after[v], step.current.position[v]};
        if (after[v] > found.most.value) found.most = {after[v], step.current.position[v]};
    }
    for (const FixedValue& fixed : conditions.fixed) widen(fixed.value);
    Signs signs;
    for (const auto& source : conditions.source)
        for (double value : source) signs.note(value);
    for (const BoundaryShare& share : conditions.shares) {
        signs.note(share.flux);
        if (share.exchanges()) widen(share.ambient);
    }
    if (signs.cools) found.lower = -INFINITY;
    if (signs.heats) found.upper = INFINITY;
    return found;
}

double HeatBalance::brought() const {
    double sum = std::accumulate(faces.begin(), faces.end(), 0.0);
    for (const auto* parts : {&surfaces, &sources, &held, &expansion}) sum = std::accumulate(parts->begin(), parts->end(), sum);
    return sum;
}

HeatBalance heat_balance(const Ranks& ranks, const HeatStep& step, const HeatConditions& conditions,
                         const Assembled& solved, const Array<Vertex, double>& after) {
    HeatBalance sum;
    const MaterialFlow& flow = step.flow;
    sum.before = energy(step.before, step.options, step.old_temperature, step.only, {flow.by_mass, flow.density_before});
    sum.after = energy(step.current, step.options, after, step.only, {flow.by_mass, flow.density});
    sum.surfaces.assign(step.options.surfaces.size(), 0.0);
    sum.sources.assign(step.options.regions.size(), 0.0);
    sum.held.assign(step.options.regions.size(), 0.0);
    sum.expansion.assign(step.options.regions.size(), 0.0);
    const Array<Vertex, double> acting = add_conditions(step, conditions, solved.after, sum);
    add_expansion(step, solved.after, sum);
    add_sources(step, conditions, sum);
    add_fixed(ranks, step.current, conditions.fixed, solved, acting, sum);
    return sum;
}

}  // namespace kropla
