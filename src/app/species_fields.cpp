#include "app/species_fields.h"

#include "case/heat.h"
#include "simulate/cells.h"

#include <algorithm>

namespace kropla {
namespace {

/// Puts what a region has at its vertices.
void put(const Mesh& mesh, Region region, const Array<Vertex, double>& from, Array<Vertex, double>& to) {
    for_each_cell(living_cells(mesh, region), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) to[v] = from[v];
    });
}

}  // namespace

std::vector<SpeciesField> species_fields(const Case& given) {
    std::vector<SpeciesField> fields;
    std::size_t place = given.heat ? 1 : 0;
    for (std::size_t s = 0; s < given.species.size(); ++s)
        for (std::size_t r = 0; r < given.species[s].regions.size(); ++r)
            if (given.species[s].regions[r]) fields.push_back({s, r, place++});
    return fields;
}

std::vector<NodalField> initial_species(const Mesh& mesh, const Case& given) {
    std::vector<Concentrations> start;
    for (const Species& species : given.species) start.push_back(initial_concentrations(mesh, species));
    std::vector<NodalField> fields;
    for (const auto& [s, r, place] : species_fields(given))
        fields.push_back({given.species[s].name + "." + region_name(given.domain, r), "kg/m^3", std::move(start[s][r])});
    return fields;
}

Concentrations concentrations(const Case& given, std::size_t species, std::span<const NodalField> fields) {
    Concentrations values(given.species[species].regions.size());
    for (const auto& [s, r, place] : species_fields(given))
        if (s == species) values[r] = fields[place].values;
    return values;
}

std::vector<NodalField> shown_fields(const Mesh& mesh, const Case& given, std::span<const NodalField> fields) {
    std::vector<NodalField> shown;
    if (given.heat) shown.push_back(fields.front());
    for (std::size_t s = 0; s < given.species.size(); ++s) {
        const Concentrations values = concentrations(given, s, fields);
        NodalField outer{given.species[s].name, "kg/m^3", Array<Vertex, double>(mesh.position.size(), 0.0)};
        for (std::size_t r = values.size(); r-- > 0;)
            if (!values[r].empty()) put(mesh, Region(r), values[r], outer.values);
        NodalField within{given.species[s].name + "_within", "kg/m^3", outer.values};
        shown.push_back(std::move(outer));
        const bool in_bodies = std::any_of(values.begin() + 1, values.end(), [](const auto& c) { return !c.empty(); });
        if (!in_bodies || values[0].empty()) continue;
        for (std::size_t r = 1; r < values.size(); ++r)
            if (!values[r].empty()) put(mesh, Region(r), values[r], within.values);
        shown.push_back(std::move(within));
    }
    return shown;
}

}  // namespace kropla
