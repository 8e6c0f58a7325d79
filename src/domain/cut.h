#pragma once

#include "domain/triangulated_surface.h"

#include <array>
#include <vector>

namespace kropla {

/// The whole surface of a body of which a box cuts off a part, where it stands; its triangles do not pass the planes of the
/// box's faces.
struct CutSurface {
    TriangulatedSurface whole;
    std::vector<std::array<int, 2>> lines;  // its edges in these planes, by their points, the lower first
    Bounds box;
};

/// Are all the points in the box, or on its faces?
[[nodiscard]] bool is_in(const Bounds& box, const Corners& triangle);

}  // namespace kropla
