#pragma once

#include "case/case.h"
#include <kropla/simulate/flow.h>
#include <kropla/simulate/material_flow.h>

#include <vector>

namespace kropla {

/// Do the surfaces of a body that is no liquid move as its deformation says? As those of bodies of kind "field", and of
/// bodies on paths that reach through faces of the box.
[[nodiscard]] bool is_told(const Case& given, std::size_t body);

/// How the material of such bodies moves from t0 to t1 [s]: as they are told, not at their surfaces alone. `current` is the
/// mesh at t1.
[[nodiscard]] std::vector<ToldFlow> told_flows(const Case& given, const Mesh& current, double t0, double t1);

/// The velocities of the surfaces of such bodies in the step from t0 to t1; nothing for the others.
[[nodiscard]] std::vector<VectorField> told_surfaces(const Case& given, double t0, double t1);
/// How such a body spins about `centre` at t1 [rad/s]: half the vorticity there.
[[nodiscard]] Vec3 told_spin(const Case& given, std::size_t body, const Vec3& centre, double t0, double t1);

}  // namespace kropla
