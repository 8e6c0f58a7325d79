#pragma once

#include "simulate/heat_cell.h"

#include <vector>

namespace kropla {

/// What leaves each body, region 1 and on, in a step that took its temperatures to `after`: the consistent
/// flux of SurfaceFlux. `cells` are all living cells of the step's mesh.
[[nodiscard]] std::vector<SurfaceFlux> surface_fluxes(const HeatStep& step, const Cells& cells,
                                                      const Array<Vertex, double>& after);

}  // namespace kropla
