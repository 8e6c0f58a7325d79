#pragma once

#include "case/case.h"
#include <kropla/simulate/fields.h>
#include <kropla/simulate/flow.h>
#include <kropla/step/fields.h>

#include <cstddef>
#include <span>
#include <vector>

namespace kropla {

/// Of the fields of a flow, velocity by its components, pressure and, if it depends on the temperature, density; where
/// there are liquid bodies, the pressure in each, and the rate of the velocity by its components: the place of the first
/// among those of a state, and their number.
[[nodiscard]] std::size_t place_of_flow(const Case& given);
[[nodiscard]] std::size_t count_flow_fields(const Case& given);

/// Does the gas expand where it is heated?
[[nodiscard]] bool expands(const Case& given);

/// As they begin. `temperature` [K] is needed where the density depends on it. Throws CaseError if an initial velocity is
/// not finite.
[[nodiscard]] std::vector<NodalField> initial_flow(const Mesh& mesh, const Case& given,
                                                   const Array<Vertex, double>& temperature);

/// How they are carried from mesh to mesh.
[[nodiscard]] std::vector<Carrying> carrying_of_flow(const Case& given);
/// The regions of liquid bodies.
[[nodiscard]] std::vector<Region> liquids_of(const Case& given);
/// The rate of the velocity [m/s^2], where there are liquid bodies.
[[nodiscard]] Array<Vertex, Vec3> flow_rate(const Case& given, std::span<const NodalField> fields);
void keep_flow_rate(const Case& given, const Array<Vertex, Vec3>& rate, std::span<NodalField> fields);

/// The pressure as it is shown, that within bodies in them, at their surfaces that outside; and, where there are liquid
/// bodies, with that within them there.
[[nodiscard]] std::vector<NodalField> shown_pressures(const Mesh& mesh, const Case& given, std::span<const NodalField> fields);

/// The mean pressure of each cell, on its side of surfaces: with liquid bodies it shows the jump as it is.
[[nodiscard]] CellField mean_pressure(const Mesh& mesh, const Case& given, std::span<const NodalField> fields);

/// From the fields of a state, and back.
[[nodiscard]] FlowState flow_state(const Case& given, std::span<const NodalField> fields);
void keep_flow(const Case& given, const FlowState& flow, std::span<NodalField> fields);


}  // namespace kropla
