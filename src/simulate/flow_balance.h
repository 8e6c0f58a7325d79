#pragma once

#include "simulate/flow_conditions.h"

#include <vector>

namespace kropla {

// What passes the boundary of a flow is balanced to rounding. `residual` has block_size numbers for each row that the rank
// owns, the last of them of volume [m^3/s]; all ranks call together what has ranks.

/// The share that each row of all ranks has of the volume of its piece [-], with the vertices at `position`.
[[nodiscard]] std::vector<double> shares_of_volume(const Mesh& mesh, const Cells& cells, const Pattern& pattern,
                                                   const Array<Vertex, Vec3>& position);

/// In closed pieces: what the given velocities let in more than out, as rounding and facets have it, is spread over the
/// volume.
void spread_net_flux(const Ranks& ranks, const SparseRows& rows, const std::vector<char>& closed,
                     const std::vector<double>& share_of_volume, std::vector<double>& residual);

/// In pieces with open faces: what is left of the residual of the whole piece goes out through them, at one velocity along
/// their normals, however well the stage is solved. As OpenFOAM's adjustPhi. Where there are densities [kg/m^3], it is mass.
void let_rest_out(const Ranks& ranks, const Pattern& pattern, const FlowBoundary& boundary,
                  const FlowConditions& conditions, const Array<Vertex, Vec3>& position,
                  const Array<Vertex, double>& densities, const std::vector<double>& residual,
                  Array<Vertex, Vec3>& velocity);

}  // namespace kropla
