#pragma once

#include "simulate/flow_cell.h"
#include "simulate/flow_solver.h"

namespace kropla {

/// Is the system a large one of viscosity alone, in next to all cells? The same on all ranks.
[[nodiscard]] bool is_viscous(const Ranks& ranks, const Pattern& pattern, const FlowStage& stage);
/// What the solver needs then; without further rows of interfaces.
[[nodiscard]] PressureScales pressure_scales(const Ranks& ranks, const Pattern& pattern, const FlowStage& stage);

}  // namespace kropla
