// Shape of one tetrahedron. The formulas for the circumradius and the inradius by the edge vectors of one
// corner are classical (e.g. [Shewchuk 2002] What is a good linear finite element?, section 6).

#include "base/tetrahedron.h"

#include "base/four.h"
#include <kropla/base/predicates.h>
#include "base/predicates_filter.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace kropla {

double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return determinant(b - a, c - a, d - a) / 6;
}

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();


template <class Number>
struct Shape {
    Number v6, uu, vv, ww, ratio;
};

// With u, v, w the edge vectors from one corner and V6 = u . (v x w) six times the volume:
//     R = |m| / (2 V6),  m = |u|^2 (v x w) + |v|^2 (w x u) + |w|^2 (u x v)
//     r = V6 / (n1 + n2 + n3 + n4),  n_i twice the areas of the facets; the fourth normal is the sum of the
//     others
//     R/r = |m| (n1 + n2 + n3 + n4) / (2 V6^2)
// |m| goes under the roots of the areas, which are independent of each other and go through the pipeline
// together.
template <class Number>
[[gnu::always_inline]] inline Shape<Number> shape_of(const Vector3<Number>& u, const Vector3<Number>& v, const Vector3<Number>& w) {
    const Vector3<Number> vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    const Number uu = squared_norm(u), vv = squared_norm(v), ww = squared_norm(w);
    const Number v6 = dot(u, vw);
    const Number mm = squared_norm(uu * vw + vv * wu + ww * uv);
    const Number first = square_root(mm * squared_norm(vw));
    const Number second = square_root(mm * squared_norm(wu));
    const Number third = square_root(mm * squared_norm(uv));
    const Number fourth = square_root(mm * squared_norm(vw + wu + uv));
    return {v6, uu, vv, ww, ((first + second) + (third + fourth)) / (2 * v6 * v6)};
}

}  // namespace

double tet_aspect_ratio(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto shape = shape_of(b - a, c - a, d - a);
    const bool positive = shape.v6 > 0 && filter::certain(shape.v6, shape.uu, shape.vv, shape.ww);
    if (!positive && !(orient3d(a, b, c, d) > 0)) return infinity;
    return shape.ratio > 0 ? shape.ratio : infinity;  // else not a number: of what no double can hold
}

namespace {

// What it brings to do four at once, in instructions by callgrind, as `advance` goes the ten steps of cases/quick.toml (no
// heat, size.surface 3e-4, growth 0.15): one by one, tet_aspect_ratios makes them 7.6 % more, tet_energies 7.4 %,
// find_ratios 6.7 %, surely_keep_volume 3.4 %, have_edge_out_of 2.9 % at least.

/// The corners of four tets.
struct FourTets {
    FourVec3 a, b, c, d;
};

// Always a part of what calls them, so that they are compiled for the same processor.
[[gnu::always_inline]] inline FourTets gathered(const FourPlaces& tets) {
    const auto corner = [&](std::size_t k) { return four_of(*tets[0][k], *tets[1][k], *tets[2][k], *tets[3][k]); };
    return {corner(0), corner(1), corner(2), corner(3)};
}

[[gnu::always_inline]] inline Four four_of(const FourNumbers& a) { return Four(Four::Register{a[0], a[1], a[2], a[3]}); }

[[gnu::always_inline]] inline void store(const Four& from, FourNumbers& to) { std::memcpy(&to, &from.all, sizeof to); }

[[gnu::always_inline]] inline Shape<Four> shape_of(const FourTets& tets, FourNumbers& ratios) {
    const auto& [a, b, c, d] = tets;
    const auto shape = shape_of(b - a, c - a, d - a);
    store(shape.ratio, ratios);
    if (all_greater(shape.v6, 0) && filter::all_certain(shape.v6, shape.uu, shape.vv, shape.ww) &&
        all_greater(shape.ratio, 0))
        return shape;
    for (std::size_t i = 0; i < 4; ++i)
        ratios[i] = tet_aspect_ratio(one_of(a, i), one_of(b, i), one_of(c, i), one_of(d, i));
    return shape;
}

/// The length of the longest row.
[[gnu::always_inline]] inline Four longest(const FourVec3& u, const FourVec3& v, const FourVec3& w) {
    return square_root(greater(greater(squared_norm(u), squared_norm(v)), squared_norm(w)));
}

[[gnu::always_inline]] inline std::array<bool, 4> are_positive(const Four& a) {
    return {a[0] > 0, a[1] > 0, a[2] > 0, a[3] > 0};
}

}  // namespace

KROPLA_FOR_EACH_PROCESSOR
FourNumbers tet_aspect_ratios(const FourPlaces& tets) {
    FourNumbers ratios;
    shape_of(gathered(tets), ratios);
    return ratios;
}

KROPLA_FOR_EACH_PROCESSOR
RatiosAndEnergies tet_energies(const FourPlaces& tets) {
    RatiosAndEnergies result;
    const auto shape = shape_of(gathered(tets), result.ratios);
    const Four ratios = four_of(result.ratios);
    store(shape.v6 / 6 * (ratios * ratios) * (ratios * ratios), result.energies);
    return result;
}

std::vector<FourFacets> by_fours(std::span<const StarFacet> star) {
    std::vector<FourFacets> fours((star.size() + 3) / 4);
    for (std::size_t i = 0; i < 4 * fours.size(); ++i) {
        const auto& [a, b, c] = star[std::min(i, star.size() - 1)];
        const std::array<double, 9> coordinates = {a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
        for (std::size_t k = 0; k < 9; ++k) fours[i / 4].coordinates[k][i % 4] = coordinates[k];
    }
    return fours;
}

KROPLA_FOR_EACH_PROCESSOR
void find_ratios(FourFacets& facets, const Vec3& x) {
    const auto& all = facets.coordinates;
    const auto corner = [&](std::size_t k) {
        return FourVec3{four_of(all[k]), four_of(all[k + 1]), four_of(all[k + 2])};
    };
    shape_of({four_times(x), corner(0), corner(3), corner(6)}, facets.ratios);
}

KROPLA_FOR_EACH_PROCESSOR
std::array<bool, 4> have_edge_out_of(SquaredBounds bounds, const FourPlaces& tets,
                                     const std::array<FourNumbers, 4>& sizes) {
    const FourTets corners = gathered(tets);
    const Four a = four_of(sizes[0]), b = four_of(sizes[1]), c = four_of(sizes[2]), d = four_of(sizes[3]);
    const auto beyond = [&](const FourVec3& from, const FourVec3& to, const Four& size_from, const Four& size_to) {
        const Four size = (size_from + size_to) / 2, square = squared_norm(from - to);
        return greater(square - bounds.most * (size * size), bounds.least * (size * size) - square);
    };
    const Four at_a = greater(beyond(corners.a, corners.b, a, b), beyond(corners.a, corners.c, a, c));
    const Four at_d = greater(beyond(corners.a, corners.d, a, d), beyond(corners.b, corners.d, b, d));
    const Four at_c = greater(beyond(corners.b, corners.c, b, c), beyond(corners.c, corners.d, c, d));
    return are_positive(greater(at_a, greater(at_d, at_c)));
}

// A determinant of rows that are no longer than L and change by no more than D changes by at most (L + D)^3 - L^3 [by
// Hadamard's inequality for each of its terms].
KROPLA_FOR_EACH_PROCESSOR
std::array<bool, 4> surely_keep_volume(const FourPlaces& from, const FourPlaces& to, double least) {
    const FourTets start = gathered(from), end = gathered(to);
    const FourVec3 u = start.b - start.a, v = start.c - start.a, w = start.d - start.a, moved = end.a - start.a;
    const Four l = longest(u, v, w);
    const Four d = longest(end.b - start.b - moved, end.c - start.c - moved, end.d - start.d - moved);
    return are_positive((1 - least) * determinant(u, v, w) - d * (3 * l * (l + d) + d * d));
}

// As above with corner b as the origin, so that of u, v, w only u = a - b moves with a; F = |m| N / (2 V6^2),
// hence grad F / F = grad |m| / |m| + grad N / N - 2 grad V6 / V6.
AspectGradient tet_aspect_gradient(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = a - b, v = d - b, w = c - b;  // det(u, v, w) > 0
    const Vec3 vw = cross(v, w), wu = cross(w, u), uv = cross(u, v), outer = vw + wu + uv;
    const double vv = squared_norm(v), ww = squared_norm(w);
    const Vec3 m = squared_norm(u) * vw + vv * wu + ww * uv;
    const double v6 = dot(u, vw), mm = squared_norm(m);
    const double n_wu = norm(wu), n_uv = norm(uv), n_outer = norm(outer);
    const double n = norm(vw) + n_wu + n_uv + n_outer;
    const Vec3 grad_m = (2 * dot(m, vw)) * u + cross(m, vv * w - ww * v);  // |m| grad |m|
    const Vec3 grad_n = cross(wu, w) / n_wu + cross(v, uv) / n_uv + cross(outer, w - v) / n_outer;
    const double aspect_ratio = std::sqrt(mm) * n / (2 * v6 * v6);
    return {aspect_ratio, aspect_ratio * (grad_m / mm + grad_n / n - (2 / v6) * vw)};
}

namespace {

/// An angle by what are in proportion to its sine and cosine.
struct Turn {
    double sine, cosine;

    [[nodiscard]] double angle() const { return std::atan2(sine, cosine); }
    [[nodiscard]] double cotangent() const { return cosine / sine; }
};

// At the edge shared by the facets with outward normals p and q the angle is pi less the one between them,
// and |p x q| = V6 |edge|; the arc tangent is accurate for all angles.
std::array<Turn, 6> dihedral_turns(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    // Outward normals of the facets, named by the opposite corners.
    const Vec3 at_a = cross(c - b, d - b), at_b = cross(d - a, c - a);
    const Vec3 at_c = cross(b - a, d - a), at_d = cross(c - a, b - a);
    const double v6 = determinant(b - a, c - a, d - a);
    const auto turn = [v6](const Vec3& p, const Vec3& q, const Vec3& edge) { return Turn{v6 * norm(edge), -dot(p, q)}; };
    return {turn(at_c, at_d, b - a), turn(at_b, at_d, c - a), turn(at_b, at_c, d - a),
            turn(at_a, at_d, c - b), turn(at_a, at_c, d - b), turn(at_a, at_b, d - c)};
}

}  // namespace

std::array<double, 6> tet_dihedral_angles(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    std::array<double, 6> angles;
    std::ranges::transform(dihedral_turns(a, b, c, d), angles.begin(), &Turn::angle);
    return angles;
}

// Between zero and pi the cotangent only falls: two arc tangents will do, which cost more than all the rest.
DihedralRange tet_dihedral_range(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const auto turns = dihedral_turns(a, b, c, d);
    if (std::ranges::all_of(turns, [](const Turn& turn) { return turn.sine > 0; })) {
        const auto [least, largest] = std::ranges::minmax_element(turns, std::greater(), &Turn::cotangent);
        return {least->angle(), largest->angle()};
    }
    const auto [least, largest] = std::ranges::minmax(tet_dihedral_angles(a, b, c, d));
    return {least, largest};
}

Vec3 tet_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const Vec3 vw = cross(v, w);
    const Vec3 m = squared_norm(u) * vw + squared_norm(v) * cross(w, u) + squared_norm(w) * cross(u, v);
    return a + m / (2 * dot(u, vw));
}

}  // namespace kropla
