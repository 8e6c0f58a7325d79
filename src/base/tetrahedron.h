#pragma once

#include <kropla/base/vec3.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The volume of the tet (a, b, c, d) [m^3], negative if it is turned inside out (by rounded arithmetic).
[[nodiscard]] double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The aspect ratio R/r of the tet: circumradius by inradius; 3 is perfect. Infinite unless the tet is
/// positively oriented by the exact predicate, and where a corner is not finite; never not a number.
[[nodiscard]] double tet_aspect_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

// The same of four tets at once, bit for bit as one by one.

using FourNumbers = std::array<double, 4>;
/// Where the corners are: per tet, per corner.
using FourPlaces = std::array<std::array<const Vec3*, 4>, 4>;

[[nodiscard]] FourNumbers tet_aspect_ratios(const FourPlaces& tets);

/// The aspect ratios, and the energies [m^3] of those that are positively oriented: volume times the fourth power of R/r.
struct RatiosAndEnergies {
    FourNumbers ratios, energies;
};
[[nodiscard]] RatiosAndEnergies tet_energies(const FourPlaces& tets);

/// A facet of a star-shaped polyhedron, by its corners, seen counter-clockwise from outside: with a point x
/// inside it makes the tet (x, a, b, c).
struct StarFacet {
    Vec3 a, b, c;
};
/// Four of them, each coordinate side by side, and the aspect ratios of the tets that they made with the last point.
struct FourFacets {
    std::array<FourNumbers, 9> coordinates;
    FourNumbers ratios;
};
/// All facets of a star; the last one also fills the last four up.
[[nodiscard]] std::vector<FourFacets> by_fours(std::span<const StarFacet> star);
void find_ratios(FourFacets& facets, const Vec3& x);

/// Which of the tets have an edge whose squared length is out of bounds, in squares of the mean of the sizes at its two
/// ends, which are given per corner, per tet. What is not a number is out of none.
struct SquaredBounds {
    double least, most;
};
[[nodiscard]] std::array<bool, 4> have_edge_out_of(SquaredBounds bounds, const FourPlaces& tets,
                                                   const std::array<FourNumbers, 4>& sizes);

/// Which of the tets keep the share `least` of their volume, without doubt, as their corners go along straight lines.
[[nodiscard]] std::array<bool, 4> surely_keep_volume(const FourPlaces& from, const FourPlaces& to, double least);

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

/// The least and the largest of them.
struct DihedralRange {
    double least, largest;  // [rad]
};
[[nodiscard]] DihedralRange tet_dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The centre of the sphere through the four points, which are not coplanar.
[[nodiscard]] Vec3 tet_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace kropla
