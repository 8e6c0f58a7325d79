#pragma once

#include <kropla/generate/generate.h>

namespace kropla {

/// Moves the points of the inside and of the box's faces (those from `first_free` on that are not on its
/// edges) by some rounds towards an optimal Delaunay triangulation. Points of faces stay on them, inner ones
/// in their clearance. Throws Interrupted if the watch says so.
void relax_points(std::vector<Vec3>& points, std::size_t first_free, const Snapshot& at, int rounds,
                  const Watch* watch = nullptr);

}  // namespace kropla
