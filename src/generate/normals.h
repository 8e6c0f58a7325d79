#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The unit normal at each point of a closed triangulated surface, on the side from which its triangles are
/// counter-clockwise: that of a quadric fitted to the neighbouring points (paper 1.4), turned, where it does
/// not see all triangles at the point well, until it does or there is no such direction.
[[nodiscard]] std::vector<Vec3> surface_normals(std::span<const Vec3> points,
                                                std::span<const std::array<int, 3>> triangles);

}  // namespace kropla
