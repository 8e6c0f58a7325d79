#pragma once

#include "adapt/zone.h"

namespace kropla {

// The stages of a step as the paper does them, where AdaptOptions::paper is set.

/// As optimise_places (2.4): sweeps of the weighted Laplacian over the vertices of cells that are not good, each move
/// taken only if the worst aspect ratio of its ball does not get worse; and where a cell is about the limit, a sweep that
/// equalises volumes before (the paper's Fig. 5).
[[nodiscard]] std::optional<Changes> smooth_places(const Zone& zone, ZoneMotion& motion, const Mesh& mesh,
                                                  const AdaptOptions& options);

/// [-] R/r: cells above are "about ten or more".
[[nodiscard]] double about_the_limit(const AdaptOptions& options);

/// Swaps what is not good among the cells away; what is worse than `above` [-] R/r then is cut out in clusters, ring by
/// ring, and re-triangulated (2.6, and 2.2 after a refusal; the paper's 1.3). No cell gets worse than `above`.
Changes remesh_clusters(Mesh& mesh, std::span<const Tet> cells, double above, const Snapshot& at_time,
                        const AdaptOptions& options);

}  // namespace kropla
