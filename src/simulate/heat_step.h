#pragma once

#include <kropla/simulate/heat.h>

namespace kropla {

/// As step_heat, of one region alone, as if there were no other, if `only` names it.
HeatReport step_heat_in(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                        const MaterialFlow& flow, Region only, Array<Vertex, double>& values, double t, double dt,
                        const Array<Vertex, double>& guess = {});

/// Takes the temperature of the regions that begin with a steady state there; all others stay as `field` has them. Nothing
/// in `options` changes with time. Throws as step_heat.
void settle_start(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, NodalField& field);

}  // namespace kropla
