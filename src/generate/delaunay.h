#pragma once

#include <kropla/generate/generate.h>

#include <span>

namespace kropla {

/// The Delaunay triangulation of the points named in `order`, which are distinct, inserted in that order. The
/// order changes the numbering of the tets and the time taken, not the tets: ties are broken by the points'
/// indices. `same_as` is left empty. Fewer than four points, or all of them coplanar: no tets.
[[nodiscard]] Triangulation triangulate_in_order(std::span<const Vec3> points, std::span<const Vertex> order,
                                                 const Watch* watch = nullptr);

}  // namespace kropla
