#pragma once

#include <kropla/adapt/adapt.h>
#include "adapt/surface_star.h"
#include "domain/body_surface.h"

namespace kropla {

/// Brings the edges of a surface near to their target sizes, its triangles to good shapes, and the cells at it
/// back below `good_enough` as far as that takes other triangles: collapses, splits, swaps and slides, each keeping the
/// volume within to rounding. Sharp edges are split, and shortened along themselves. `size` is the target size at each vertex of the surface
/// [m]; new ones get the mean of those beside them. `all`: also triangles that are poor though no edge near has changed. On
/// faces of the box where its line is pinned, the line stays, but for splits.
Changes adapt_surface(Mesh& mesh, const SurfaceOf& of, std::span<const std::array<Vertex, 3>> triangles,
                      Array<Vertex, double>& size, bool all, const AdaptOptions& options);
/// Is an edge of the surface too long or too short?
[[nodiscard]] bool has_wrong_size(const Mesh& mesh, const BodySurface& surface, const Array<Vertex, double>& size,
                                  const AdaptOptions& options);

/// Of cells at the surface that are worse than `good_enough`: swaps, slides, collapses and splits of the
/// surface that make the worst of those concerned better. For what `improve` has left, and to be followed by it.
Changes improve_surface(Mesh& mesh, const SurfaceOf& of, std::span<const Tet> cells, const AdaptOptions& options);

/// The cells at vertices that are still there.
[[nodiscard]] std::vector<Tet> cells_at(const Mesh& mesh, std::span<const Vertex> vertices);

}  // namespace kropla
