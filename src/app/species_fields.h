#pragma once

#include "case/case.h"
#include <kropla/simulate/fields.h>
#include <kropla/simulate/species.h>

#include <cstddef>
#include <span>
#include <vector>

namespace kropla {

/// A field per species and region where it is: which, and its place among the fields of a state.
struct SpeciesField {
    std::size_t species, region, place;
};
/// In their order; the first stands after the temperature, where there is one.
[[nodiscard]] std::vector<SpeciesField> species_fields(const Case& given);

/// As they begin, in that order.
[[nodiscard]] std::vector<NodalField> initial_species(const Mesh& mesh, const Case& given);

/// What a species is in each region, of the fields of a state.
[[nodiscard]] Concentrations concentrations(const Case& given, std::size_t species, std::span<const NodalField> fields);

/// The fields as frames have them, one value a vertex: NAME with the side of the lower region at interfaces, and NAME_within
/// with that of the body, where a species is in bodies and the surroundings. Zero where it is not.
[[nodiscard]] std::vector<NodalField> shown_fields(const Mesh& mesh, const Case& given, std::span<const NodalField> fields);

}  // namespace kropla
