#pragma once

#include "heat_problems.h"

namespace kropla {

// Flows around a sphere whose forces are known, as heat_problems.h has problems of heat; of radius 1 m
// and velocities up to 1 m/s, in a liquid of 1 Pa s, with prisms at the sphere. Where nothing else is
// said meshes are of `initial_mesh` and move by `advance`, with velocity and pressure carried as runs
// carry them. A drag is given in 6 pi mu a U, which it is in an unbounded liquid.

/// Stokes flow in the shell around a sphere that moves in the middle of one four times as large. Its mesh
/// is made of shells.
[[nodiscard]] Outcome drag_in_sphere(const Ranks& ranks, int fineness);

/// Stokes flow in a closed cube five times as wide as the sphere that moves through its middle.
[[nodiscard]] Outcome drag_in_cube(const Ranks& ranks, int fineness);

/// A sphere that moves to the floor of a closed box, 20 m by 20 m by 20 m, in a liquid without inertia,
/// its middle from a height of h = 4 m, or as fine as tests take it 2 m, to 1.2 m. And how far the force
/// jumps: the largest distance of a step's drag from the mean of those before and after it, each in what
/// the floor alone would make; and the largest share by which the same flow has another drag when the
/// mesh has been remade.
[[nodiscard]] Outcome way_to_floor(const Ranks& ranks, int fineness);

/// A sphere that swings by 0.02 m, a^2 omega / nu = 10, with velocities of an unbounded liquid given on
/// the faces of a cube of half-width 4 m: the parts of the force in phase with the velocity and a quarter
/// of a period before it, over the second of two periods.
[[nodiscard]] Outcome swinging_sphere(const Ranks& ranks, int fineness);

/// A sphere of diameter 1 m that is held in a stream of 1 m/s in a wide box: its drag, the length of its wake and the angle
/// from its front at which the flow leaves it (none: 0), and the heat that it gives off, held at one temperature.
struct KnownStream {
    double reynolds, drag, wake, angle, nusselt;
};
inline constexpr KnownStream stream_20{20, 2.719, 0, 0, 4.019}, stream_50{50, 1.576, 0.406, 139.2, 5.395},
    stream_100{100, 1.0882, 0.869, 126.8, 6.903}, stream_200{200, 0.7707, 1.435, 116.3, 9.115};
[[nodiscard]] Outcome sphere_in_stream(const Ranks& ranks, const KnownStream& known, int fineness);

}  // namespace kropla
