#include <kropla/simulate/species.h>

#include <kropla/base/error.h>
#include "simulate/cells.h"
#include "simulate/heat_step.h"
#include "simulate/step_mean.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

Quantity negative(const Quantity& quantity) {
    if (!quantity) return {};
    return [quantity](const Vec3& place, double t) { return -quantity(place, t); };
}

/// What passes the surface of a body, as the surroundings (`sign` 1) or the body (-1) have it.
HeatSurface passing(const SpeciesSurface& surface, const std::vector<SurfaceFlux>& heat, std::size_t body, double sign) {
    HeatSurface passes;
    passes.flux = sign > 0 ? surface.flux : negative(surface.flux);
    if (surface.per_heat == 0 || body > heat.size()) return passes;
    for (double density : heat[body - 1].density)
        passes.at_vertices.push_back(sign * surface.per_heat * std::max(density, 0.0));
    return passes;
}

/// The species in one region, in the words of heat: of a capacity of one.
HeatOptions as_heat(const Species& species, std::size_t region, const HeatOptions& heat,
                    const std::vector<SurfaceFlux>& surfaces) {
    HeatOptions options{.regions = std::vector<HeatRegion>(species.regions.size())};
    options.key = "species." + species.name;
    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        options.regions[r].carried = heat.regions[r].carried;
        options.regions[r].name = heat.regions[r].name;
    }
    options.regions[region].material.conductivity = species.regions[region]->diffusivity;
    options.regions[region].initial = species.regions[region]->initial;
    options.regions[region].source = species.regions[region]->source;
    options.faces = species.faces;
    options.surfaces.resize(species.surfaces.size());
    for (std::size_t body = 1; body <= species.surfaces.size(); ++body) {
        if (region == 0) options.surfaces[body - 1] = passing(species.surfaces[body - 1], surfaces, body, 1);
        if (region == body) options.surfaces[body - 1] = passing(species.surfaces[body - 1], surfaces, body, -1);
    }
    return options;
}

/// The options of heat that know no more than how many regions there are.
HeatOptions plain(const Species& species) { return {.regions = std::vector<HeatRegion>(species.regions.size())}; }

void check_species(const Species& species) {
    for (std::size_t r = 0; r < species.regions.size(); ++r) {
        if (!species.regions[r]) continue;
        const double diffusivity = species.regions[r]->diffusivity;
        if (std::isfinite(diffusivity) && diffusivity > 0) continue;
        throw CaseError(region_key(as_heat(species, r, plain(species), {}), r) + ".diffusivity must be positive, got " +
                        std::to_string(diffusivity));
    }
}

}  // namespace

Concentrations initial_concentrations(const Mesh& mesh, const Species& species) {
    check_species(species);
    Concentrations values(species.regions.size());
    for (std::size_t r = 0; r < values.size(); ++r) {
        if (!species.regions[r]) continue;
        const HeatOptions options = as_heat(species, r, plain(species), {});
        check_heat(options, mesh);
        const HeatStart& start = species.regions[r]->initial;
        values[r].resize(mesh.position.size(), 0.0);
        for_each_cell(living_cells(mesh, Region(r)), [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell))
                values[r][v] = start.profile ? value_at(start.profile, mesh.position[v], 0, region_key(options, r) + ".initial")
                                             : start.value;
        });
    }
    return values;
}

SpeciesReport step_species(const Ranks& ranks, const Mesh& before, const Mesh& current, const Species& species,
                           const HeatOptions& heat, const MaterialFlow& flow, const std::vector<SurfaceFlux>& surfaces,
                           Concentrations& values, double t, double dt) {
    check_species(species);
    SpeciesReport report{std::vector<HeatBalance>(species.regions.size())};
    for (std::size_t r = 0; r < species.regions.size(); ++r) {
        if (!species.regions[r]) continue;
        const HeatOptions options = as_heat(species, r, heat, surfaces);
        check_heat(options, current);
        report.balance[r] =
            step_heat_in(ranks, before, current, options, flow, Region(r), values[r], t, dt).balance;
    }
    return report;
}

}  // namespace kropla
