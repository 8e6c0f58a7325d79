#pragma once

#include "simulate/flow_cell.h"

namespace kropla {

/// The energy of what flows, with its vertices at `position`: of motion, and in the field of gravity against the origin.
[[nodiscard]] FlowEnergy flow_energy(const Mesh& mesh, const Cells& cells, const Array<Region, FlowMaterial>& material,
                                     const Array<Vertex, Vec3>& velocity, const Vec3& gravity);

/// The momentum of what flows [kg m/s], with its vertices at `position`.
[[nodiscard]] Vec3 momentum(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& position,
                            const Array<Region, FlowMaterial>& material, const Array<Vertex, Vec3>& velocity);

/// What forces do to what flows in a stage [N], by the form that is solved: the integral of rho (du/dt + (u - w).grad u).
/// Of a flow with convection.
[[nodiscard]] Vec3 inertia(const FlowStage& stage, const Cells& cells);

/// What viscosity turns into heat [W], the integral of mu/2 |grad u + grad u^T|^2.
[[nodiscard]] double dissipation(const Mesh& mesh, const Cells& cells, const Array<Vertex, Vec3>& position,
                                 const Array<Region, FlowMaterial>& material, const Array<Vertex, Vec3>& velocity);

}  // namespace kropla
