#pragma once

#include "heat_problems.h"

namespace kropla {

// Liquid spheres whose drags are known. A drop of radius a stays round as long as its surface tension is large against
// what the flow does to it.

/// A drop in Stokes flow by its viscosity, in that of what is around it, and its drag in 6 pi mu a U.
struct SlowDrop {
    double viscosity, drag;
};

/// A drop of radius 1 m that a force on all of it pulls through the middle of a sphere four times as large, in Stokes flow.
/// Its mesh is made of shells.
inline constexpr SlowDrop in_sphere_01{0.1, 1.1393298}, in_sphere_1{1, 1.5140090}, in_sphere_10{10, 1.9838522},
    in_sphere_25{25, 2.0528617};
[[nodiscard]] Outcome drop_in_sphere(const Ranks& ranks, const SlowDrop& known, int fineness);

/// A drop of radius 1 m that moves to the floor of a box 40 m wide and high, its middle at this height [m], in Stokes flow.
struct DropBeforeFloor {
    double height;
    SlowDrop drop;
};
inline constexpr DropBeforeFloor near_floor_01{1.5, {0.1, 1.52781}}, near_floor_1{1.5, {1, 2.11100}},
    near_floor_25{1.5, {25, 3.09829}}, above_floor_01{2, {0.1, 1.15556}}, above_floor_1{2, {1, 1.53004}},
    above_floor_25{2, {25, 2.07272}};
[[nodiscard]] Outcome drop_to_floor(const Ranks& ranks, const DropBeforeFloor& known, int fineness);

/// A drop of diameter 1 m, of this viscosity and density in those of what is around it, that is held in a stream of 1 m/s in
/// a wide box: its drag, and the largest velocity of its surface.
struct DropStream {
    double reynolds, viscosity, density, drag, surface;
};
inline constexpr DropStream like_10{10, 1, 1, 3.341, 0.436}, like_50{50, 1, 1, 1.081, 0.702}, like_100{100, 1, 1, 0.658, 0.837},
    heavy_10{10, 10, 10, 4.131, 0.0851}, heavy_50{50, 10, 10, 1.492, 0.157}, heavy_100{100, 10, 10, 1.017, 0.208};
[[nodiscard]] Outcome drop_in_stream(const Ranks& ranks, const DropStream& known, int fineness);

}  // namespace kropla
