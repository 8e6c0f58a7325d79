#pragma once

#include "base/four.h"

#include <array>

namespace kropla {

/// The volume of the tet (a, b, c, d) [m^3], negative if it is turned inside out (by rounded arithmetic).
[[nodiscard]] double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The aspect ratio R/r of the tet: circumradius by inradius; 3 is perfect. Infinite unless the tet is
/// positively oriented by the exact predicate, and where a corner is not finite; never not a number.
[[nodiscard]] double tet_aspect_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The corners of four tets.
struct FourTets {
    FourVec3 a, b, c, d;
};
/// The same, where they are: per tet, per corner.
using FourPlaces = std::array<std::array<const Vec3*, 4>, 4>;

/// A part of what calls it, so that it is compiled for the same processor.
[[gnu::always_inline]] inline FourTets gathered(const FourPlaces& tets) {
    const auto corner = [&](std::size_t k) {
        return four_of(*tets[0][k], *tets[1][k], *tets[2][k], *tets[3][k]);
    };
    return {corner(0), corner(1), corner(2), corner(3)};
}

/// Their aspect ratios, bit for bit as one by one.
void tet_aspect_ratios(const FourTets& tets, Four& ratios);
void tet_aspect_ratios(const FourPlaces& tets, Four& ratios);
/// The same, and the energies [m^3] of those that are positively oriented: volume times the fourth power of R/r.
void tet_aspect_ratios(const FourPlaces& tets, Four& ratios, Four& energies);

/// R/r and its gradient with respect to the first vertex [1/m].
struct AspectGradient {
    double aspect_ratio;
    Vec3 gradient;
};
/// As tet_aspect_ratio, with the gradient; the tet is positively oriented.
[[nodiscard]] AspectGradient tet_aspect_gradient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The six dihedral angles [rad], at the edges 01, 02, 03, 12, 13, 23.
[[nodiscard]] std::array<double, 6> tet_dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c,
                                                         const Vec3& d);

/// The centre of the sphere through the four points, which are not coplanar.
[[nodiscard]] Vec3 tet_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace kropla
