#pragma once

#include "simulate/heat_cell.h"
#include "simulate/heat_conditions.h"
#include "simulate/surface_flux.h"

#include <vector>

namespace kropla {

/// Of the vertices that are stepped, with the temperatures `after` [K] that they have at the end. The same on all ranks.
[[nodiscard]] HeatExtremes heat_extremes(const HeatStep& step, const HeatConditions& conditions,
                                         const std::vector<Vertex>& vertices, const Array<Vertex, double>& after);

/// Of a step that was solved, from the rows of its system; `after` is the temperature [K] with what was repaired. All ranks
/// call it together, and all get the same.
[[nodiscard]] HeatBalance heat_balance(const Ranks& ranks, const HeatStep& step, const HeatConditions& conditions,
                                       const Assembled& solved, const Array<Vertex, double>& after);

}  // namespace kropla
