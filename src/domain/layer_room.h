#pragma once

#include <kropla/domain/domain.h>

#include <limits>

namespace kropla {

// How much of the gap to what is near a layer may take, so that a row of tets stands between: of that to a
// face of the box or to a body without a layer outside; of that to a body with one, which takes as much; and
// of the radius of the largest ball that touches the surface from inside, so that the shell's edges keep half
// their length.
inline constexpr double share_of_gap = 1.0 / 3;
inline constexpr double share_between_layers = 0.25;
inline constexpr double share_inside = 0.5;

/// The layer at one side of a body's surface, if there is one.
[[nodiscard]] const LayerOptions* layer_at_side(const Snapshot& at, std::size_t body, bool inside);

/// What leaves a body the least room at a point of its surface.
struct Gap {
    double distance;   // [m] from the point; infinite in the open; not positive within the obstacle
    double room;       // [m] the greatest thickness that a layer may have there, between the polyhedra
    int wall;          // the obstacle: a face of the box, 0 ... 5, or the fixed walls; -1: a body
    std::size_t body;  // that body, where it is one
};
/// Of what leaves less room than `beyond` [m], if anything does; else the distance is infinite.
[[nodiscard]] Gap nearest_gap(const Snapshot& at, std::size_t body, const Vec3& x,
                              double beyond = std::numeric_limits<double>::infinity());

/// The thickness [m] of the layer at the point `x` of the body's surface: as asked where there is room,
/// exactly, else the room there, 0 at least. A function of the place alone; where it is less than asked it
/// changes by at most share_of_gap per metre outside, so that neighbouring columns are graded.
[[nodiscard]] double layer_thickness(const Snapshot& at, std::size_t body, bool inside, const Vec3& x);

/// The distance from `x` to the nearest surface that bounds tets [m]: a shell, or where there is no layer on
/// the side of `x`, the body's surface; negative in a layer. Right to the change of thickness along the
/// surface.
[[nodiscard]] double distance_to_shells(const Snapshot& at, const Vec3& x);

}  // namespace kropla
