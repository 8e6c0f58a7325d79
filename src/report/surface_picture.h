#pragma once

#include <kropla/mesh/mesh.h>
#include "report/picture.h"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace kropla {

/// A triangle of the surface of a body, counter-clockwise seen from outside.
struct SurfaceTriangle {
    Region region;
    std::array<Vec3, 3> corners;  // [m]
};
/// Of all bodies, whose regions are not the surroundings: where their tets end.
[[nodiscard]] std::vector<SurfaceTriangle> surface_triangles(const Mesh& mesh);

/// The triangles as they are seen in parallel projection from the front, right and above, by parts of the picture's plane [m].
[[nodiscard]] CutWindow extent_in_space(std::span<const SurfaceTriangle> triangles);
/// How many of them look towards the viewer.
[[nodiscard]] std::size_t count_seen(std::span<const SurfaceTriangle> triangles);

/// That picture as inline SVG: those that look towards the viewer, the farthest first, as bright as the light falls on
/// them, each body in its colour; and the axes in a corner.
[[nodiscard]] std::string draw_surfaces(std::span<const SurfaceTriangle> triangles, const CutWindow& window);

}  // namespace kropla
