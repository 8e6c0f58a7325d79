#pragma once

#include "mesh/mesh.h"

#include <array>

namespace kropla {

/// A tet as the linear element sees it. Linear shape functions have constant gradients: grad phi_i is
/// volume_gradient[i] / volume, and volume_gradient[i] = dV/dx_i, a third of the area vector of the facet
/// opposite corner i, pointing to that corner. The four sum to zero.
struct LinearTet {
    double volume;                          // [m^3]
    std::array<Vec3, 4> volume_gradient;    // [m^2]
};

/// The places of four corners [m], as in Mesh.
using Corners = std::array<Vec3, 4>;
[[nodiscard]] Corners corners(const Mesh& mesh, Tet t);

/// In terms of differences to corner 0 alone, so that the rounding error is relative to the tet's size.
[[nodiscard]] LinearTet linear_tet(const Corners& x);

/// The mean over a step of volume_gradient, while the corners go straight from `x0` to `x1`. Exact: the
/// integrand is quadratic in time and two Gauss points integrate cubics. So the volume swept is the volume
/// gained: sum (x1_i - x0_i) . mean_i = V1 - V0, the geometric conservation law of [Lesoinne, Farhat 1996].
[[nodiscard]] std::array<Vec3, 4> mean_volume_gradient(const Corners& x0, const Corners& x1);

/// The mean over a step of the area vector [m^2] of the triangle whose corners go straight from `x0` to `x1`.
[[nodiscard]] Vec3 mean_area_vector(const std::array<Vec3, 3>& x0, const std::array<Vec3, 3>& x1);

}  // namespace kropla
