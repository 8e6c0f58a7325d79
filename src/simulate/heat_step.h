#pragma once

#include "simulate/flow_potential.h"
#include <kropla/simulate/heat.h>

namespace kropla {

/// The regions whose material moves like that.
[[nodiscard]] std::vector<Region> regions_that(Carried move, const HeatOptions& options);

/// As step_heat, in a flow that is known; of one region alone, as if there were no other, if `only` names it.
HeatReport step_heat_in(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                        const DisplacedFlow& flow, Region only, Array<Vertex, double>& values, double t, double dt);

/// Takes the temperature of the regions that begin with a steady state there; all others stay as `field` has them. Nothing
/// in `options` changes with time. Throws as step_heat.
void settle_start(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, NodalField& field);

}  // namespace kropla
