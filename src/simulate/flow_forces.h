#pragma once

#include "simulate/flow_conditions.h"

#include <array>
#include <vector>

namespace kropla {

/// What holds each vertex [N], the residual of its rows of momentum: `residual` has block_size numbers for each row that the
/// rank owns. All ranks call it together, and all get the whole.
[[nodiscard]] Array<Vertex, Vec3> reactions(const Ranks& ranks, const Pattern& pattern, const std::vector<double>& residual);

/// Takes off what a pressure [Pa] that is the same everywhere in a piece of the pattern, and at its open faces, adds to them,
/// of each piece.
void take_off_pressure(const Pattern& pattern, const FlowBoundary& boundary, const FlowConditions& conditions,
                       const Array<Vertex, Vec3>& position, const std::vector<double>& pressure,
                       Array<Vertex, Vec3>& reaction);

/// Where a face of the box meets a solid body: what the pressure on the face adds to the reaction of a vertex that the body
/// holds. It is of the face, not of the body.
struct FaceShare {
    std::size_t face;
    Vertex vertex;
    Vec3 reaction;  // [N]
};
[[nodiscard]] std::vector<FaceShare> shares_of_faces(const FlowBoundary& boundary, const FlowConditions& conditions,
                                                     const Array<Vertex, Vec3>& position,
                                                     const Array<Vertex, double>& pressure);

/// Of solid bodies, with their vertices at `position`; of the reactions, without what faces add to them.
[[nodiscard]] std::vector<BodyForce> body_forces(const FlowBoundary& boundary, const Array<Vertex, Vec3>& position,
                                                 const Array<Vertex, Vec3>& velocity,
                                                 const Array<Vertex, Vec3>& reaction);

/// [N] on each face of the box, as FlowReport has it. Where faces meet, each direction is of the one across it, else of all
/// alike that hold it. Where they meet bodies, of the reactions what the shares have.
[[nodiscard]] std::array<Vec3, 6> face_forces(const FlowOptions& options, const FlowBoundary& boundary,
                                              const std::vector<FaceShare>& shares, const Array<Vertex, Vec3>& reaction);

}  // namespace kropla
