#pragma once

#include <kropla/domain/domain.h>

namespace kropla {

// What inner points keep from the walls of the box and from the surfaces of the bodies (the shells of their
// layers), per target size;
// points within a face of the box keep the former from its edges. At bodies it is the circumradius of the
// surface's worst triangles (0.58 if equilateral), so that diametral spheres are empty and all triangles are
// facets of any Delaunay mesh. Of 0.55 to 0.7 at walls and 0.65 to 0.75 at bodies these leave the fewest bad
// tets after relaxation, by measurement.
inline constexpr double clearance_at_walls = 0.55;
inline constexpr double clearance_at_bodies = 0.70;
// Of points in a face from a body that reaches through it, per size at its surface: where it is a sheet along the face, one
// cell thick, they are to be as near as the sheet is thick, 0.67.
inline constexpr double clearance_across = 0.65;

/// The target size at `x` and what `clearance` is there, at the cost of one [m].
struct SizeAndClearance {
    double size, clearance;
};
[[nodiscard]] SizeAndClearance size_and_clearance(const Snapshot& at, const Vec3& x);

/// How far `x` is beyond what is to be kept from walls and bodies [m]; negative: too near to one.
[[nodiscard]] double clearance(const Snapshot& at, const Vec3& x);

/// The same for `x` on the face `patch` of the box, against the edges of that face and the bodies that reach through it.
[[nodiscard]] double clearance_on_face(const Snapshot& at, Patch patch, const Vec3& x);

/// The most that either changes per metre.
[[nodiscard]] double clearance_slope(const Snapshot& at);

}  // namespace kropla
