// The temperature that a run begins with.
#include <kropla/simulate/heat.h>

#include <kropla/base/error.h>
#include "simulate/cells.h"
#include "simulate/heat_step.h"
#include "simulate/step_mean.h"

#include <algorithm>
#include <utility>

namespace kropla {
namespace {

bool is_steady(const HeatRegion& region) { return region.initial.steady && !region.held; }

/// The region that begins at each vertex: at an interface the last, a body's, of those that say how warm they are. None in
/// free slots.
Array<Vertex, Region> regions_at(const Mesh& mesh, const HeatOptions& options) {
    Array<Vertex, Region> region(mesh.position.size());
    const auto rank = [&](Region r) {
        return std::pair(r.exists() && !is_steady(options.regions[as_size(r.value)]), r);
    };
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        const Region here = cell_region(mesh, cell);
        for (Vertex v : cell_vertices(mesh, cell))
            if (rank(region[v]) < rank(here)) region[v] = here;
    });
    return region;
}

/// What holds still at t = 0.
Quantity at_start(const Quantity& quantity) {
    if (!quantity) return {};
    return [quantity](const Vec3& place, double) { return quantity(place, 0); };
}
HeatExchange at_start(const HeatExchange& exchange) {
    return {at_start(exchange.coefficient), at_start(exchange.emissivity), at_start(exchange.ambient)};
}

/// The options at t = 0, of which nothing changes any more.
HeatOptions at_start(HeatOptions options) {
    for (HeatRegion& region : options.regions) {
        region.source = at_start(region.source);
        region.power = at_start(region.power);
        region.material.latent_heat = 0;  // in a state that stays nothing melts
    }
    for (HeatFace& face : options.faces) {
        face.quantity = at_start(face.quantity);
        face.power = at_start(face.power);
        face.exchange = at_start(face.exchange);
    }
    for (HeatSurface& surface : options.surfaces)
        surface = {at_start(surface.flux), surface.at_vertices, at_start(surface.power), at_start(surface.exchange)};
    return options;
}

}  // namespace

NodalField initial_temperature(const Mesh& mesh, const HeatOptions& options) {
    check_heat(options, mesh);
    NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size(), 0.0)};
    const Array<Vertex, Region> region = regions_at(mesh, options);
    for (Vertex v : mesh.position.indices()) {
        if (!region[v].exists()) continue;
        const auto r = static_cast<std::size_t>(region[v].value);
        const HeatRegion& of = options.regions[r];
        if (of.held) field.values[v] = *of.held;
        else if (of.initial.profile)
            field.values[v] = value_at(of.initial.profile, mesh.position[v], 0, region_key(options, r) + ".initial");
        else field.values[v] = of.initial.value;
    }
    return field;
}

bool has_steady_state(const HeatOptions& options) {
    const auto knows = [](const HeatExchange& exchange) { return exchange.coefficient || exchange.emissivity; };
    return std::ranges::any_of(options.regions, [](const HeatRegion& r) { return r.held || !r.initial.steady; }) ||
           std::ranges::any_of(options.faces, [&](const HeatFace& face) {
               return face.kind == HeatFace::Kind::value || knows(face.exchange);
           }) ||
           std::ranges::any_of(options.surfaces, [&](const HeatSurface& surface) { return knows(surface.exchange); });
}

NodalField initial_temperature(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options) {
    NodalField field = initial_temperature(mesh, options);
    if (std::ranges::none_of(options.regions, is_steady)) return field;
    if (!has_steady_state(options))
        throw CaseError("heat: there is no steady state, or more than one: no face, surface or region says how warm it is");
    settle_start(ranks, mesh, at_start(options), field);
    return field;
}

}  // namespace kropla
