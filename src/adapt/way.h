#pragma once

#include "adapt/zone.h"

#include <array>
#include <span>

namespace kropla {

/// The largest fraction in [0, 1] of the way from `start` to `place` up to which all of `cells` keep a volume of at least
/// `least` of what they have at the start; from the cubic of each cell's volume along its way.
[[nodiscard]] double safe_fraction(const Mesh& mesh, std::span<const Tet> cells, const Array<Vertex, Vec3>& start,
                                   const Array<Vertex, Vec3>& place, double least);

/// The same for the Jacobians at the six corners of a prism, numbered as in cells.h.
[[nodiscard]] double safe_fraction(const std::array<Vec3, 6>& from, const std::array<Vec3, 6>& to, double least);

/// The least share of its volume that each cell of a rigid body has left on the way, as its vertices go along straight
/// lines while the body turns by the angle a: its volume goes with the determinant of (1 - s) I + s R, R the rotation,
/// whose eigenvalues are 1 and exp(+-i a), so with 1 - 2 s (1 - s) (1 - cos a); that is least half-way, (1 + cos a) / 2.
[[nodiscard]] double volume_kept_turning(const Shape& from, const Shape& to);

}  // namespace kropla
