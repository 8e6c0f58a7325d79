#pragma once

#include <kropla/adapt/adapt.h>
#include "domain/body_surface.h"

namespace kropla {

/// Brings the edges of a body's surface near to their target sizes, its triangles to good shapes, and the cells at it
/// back below `good_enough` as far as that takes other triangles: collapses, splits, swaps and slides, each keeping the
/// volume of the body to rounding. Sharp edges are only split. `size` is the target size at each vertex of the surface
/// [m]; new ones get the mean of those beside them. `all`: also triangles that are poor though no edge near has changed. On
/// faces of the box where its line is `pinned` (surface.h), the line stays, but for splits.
Changes adapt_surface(Mesh& mesh, const BodySurface& surface, Array<Vertex, double>& size, bool all,
                      const AdaptOptions& options, unsigned pinned = 0);
/// Is an edge of the surface too long or too short?
[[nodiscard]] bool has_wrong_size(const Mesh& mesh, const BodySurface& surface, const Array<Vertex, double>& size,
                                  const AdaptOptions& options);

/// Of cells at the surface of the region that are worse than `good_enough`: swaps, collapses and slides of the surface
/// that make the worst of those concerned better. For what `improve` has left, and to be followed by it.
Changes improve_surface(Mesh& mesh, std::span<const Tet> cells, Region region, const AdaptOptions& options,
                        unsigned pinned = 0);

}  // namespace kropla
