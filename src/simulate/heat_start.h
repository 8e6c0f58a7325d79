#pragma once

#include <kropla/simulate/heat.h>

namespace kropla {

/// Takes the temperature of the regions that begin with a steady state there; all others stay as `field` has them. Nothing
/// in `options` changes with time. Throws as step_heat.
void settle_start(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, NodalField& field);

}  // namespace kropla
