#pragma once

#include "simulate/flow_conditions.h"

#include <array>
#include <vector>

namespace kropla {

/// What holds each vertex [N], the residual of its rows of momentum: `residual` has block_size numbers for each row that the
/// rank owns. All ranks call it together, and all get the whole.
[[nodiscard]] Array<Vertex, Vec3> reactions(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& residual);

/// Takes off what a pressure [Pa] that is the same everywhere in a piece of the pattern adds to them, of each piece.
void take_off_pressure(const Pattern& pattern, const FlowBoundary& boundary, const Array<Vertex, Vec3>& position,
                       const std::vector<double>& pressure, Array<Vertex, Vec3>& reaction);

/// Of solid bodies, with their vertices at `position`.
[[nodiscard]] std::vector<BodyForce> body_forces(const FlowBoundary& boundary, const Array<Vertex, Vec3>& position,
                                                 const Array<Vertex, Vec3>& velocity,
                                                 const Array<Vertex, Vec3>& reaction);

/// [N] on each face of the box, as FlowReport has it. Where faces meet, each direction is of the one across it, else of all
/// alike that hold it.
[[nodiscard]] std::array<Vec3, 6> face_forces(const FlowOptions& options, const FlowBoundary& boundary,
                                              const Array<Vertex, Vec3>& reaction);

}  // namespace kropla
