#pragma once

#include "report/section.h"

#include <cmath>
#include <span>
#include <vector>

namespace kropla {

/// Where something goes, in a plane.
struct Arrow {
    Point2 place;      // [m] of its middle
    Point2 direction;  // of unit length
    double length;     // [m]
};

struct ArrowOptions {
    double spacing;  // [m] of the places, in rows; every other row stands between those next to it
    double most;     // [m/s] has an arrow as long as the spacing; others as the root of their share of it
    CutWindow window = {{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};  // outside of it there are none
};
/// The velocity within the plane at even places of what the cut shows in the window; none where it is zero, or where the
/// arrow would reach into `solids`.
[[nodiscard]] std::vector<Arrow> arrows(std::span<const CutPolygon> cut, std::span<const CutPolygon> solids,
                                        const CutPlane& plane, const Array<Vertex, Vec3>& velocity,
                                        const ArrowOptions& options);

}  // namespace kropla
