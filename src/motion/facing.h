#pragma once

#include <kropla/domain/domain.h>

namespace kropla {

// Where two surfaces come nearest to each other. The gap of ellipsoids is the largest that two parallel planes between
// them have: over all directions n, from b to a,
//     s(n) = n . (centre_a - centre_b) - h_a(n) - h_b(n),    h(n)^2 = n . Q n,
// h how far an ellipsoid reaches from its centre. Of shapes that overlap the largest s is negative: how deep. Newton's
// method on the sphere of directions finds it; the second derivatives of h are the radii of curvature where planes touch.

struct Facing {
    Vec3 on_a, on_b;      // [m] the closest points
    Vec3 normal;          // of unit length, from b to a
    double gap = 0;       // [m] between them; negative where shapes overlap
    // [m^2] By it gas or liquid that is squeezed out of a narrow gap resists: F = 6 pi mu (this) v / gap. For radii of
    // curvature R1, R2 of the gap, 1/R the sums of both surfaces' curvatures, it is 2 (R1 R2)^(3/2) / (R1 + R2): a^2 of a
    // sphere at a wall, (a b / (a + b))^2 of two spheres. The leading order, exact for ellipsoids [Cox 1974].
    double squeezed = 0;
};
//   [Cox 1974] The motion of suspended particles almost in contact. Int. J. Multiphase Flow 1.

/// Of two ellipsoids.
[[nodiscard]] Facing facing(const Shape& a, const Shape& b);
/// Of an ellipsoid and a face of the box, 0 ... 5.
[[nodiscard]] Facing facing_wall(const Shape& a, const Box& box, int wall);

/// At most the gap, and found by balls around the shapes alone [m].
[[nodiscard]] double least_gap_between(const Shape& a, const Shape& b);

}  // namespace kropla
