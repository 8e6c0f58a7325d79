#pragma once

#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

namespace kropla {

/// The target size that a mesh has already: `surface` the median length of the edges on the bodies' surfaces, `far` that
/// which one edge in a hundred is longer than, at least `surface`; `growth` the median over edges away from the bodies of
/// how much longer than `surface` they are by their distance, from 0 to `steepest_growth`. Without bodies `far` for all.
[[nodiscard]] SizeField size_of_mesh(const Mesh& mesh, const Domain& domain);

}  // namespace kropla
