#pragma once

#include "domain/triangulated_surface.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace kropla {

/// The whole surface of a body of which a box cuts off a part, where it stands; its triangles do not pass the planes of the
/// box's faces.
struct CutSurface {
    TriangulatedSurface whole;
    std::vector<std::array<int, 2>> lines;  // its edges in these planes, by their points, the lower first
    Bounds box;
};

/// Of a surface that does not pass the planes of a box's faces what is in the box, or on its faces: these triangles, and the
/// points that they have, in the order in which they come.
struct PartInBox {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<int> number;  // in it, of each point of the surface; -1: it is not there
};
[[nodiscard]] PartInBox part_in(const Bounds& box, std::span<const Vec3> points,
                                std::span<const std::array<int, 3>> triangles);

/// The first triangle that lies in a face of the box, and which one that is.
struct TriangleOnFace {
    std::size_t triangle;
    int face;
};
[[nodiscard]] std::optional<TriangleOnFace> triangle_on_face(const Bounds& box, std::span<const Vec3> points,
                                                             std::span<const std::array<int, 3>> triangles);

}  // namespace kropla
