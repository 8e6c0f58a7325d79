#pragma once

#include "base/four.h"

#include <algorithm>
#include <cmath>

// The first stage of the predicates, inline for the loops that ask most: the sign by rounded arithmetic where
// its error is provably smaller than the value, else 0 (not decided).
//
// The bounds count roundings: a value that is a sum of products, each of whose factors and partial results
// went through at most n roundings, is off by at most n eps times the same sum with all terms taken positive
// (the permanent), eps = 2^-53, up to terms in eps^2 [Shewchuk 1997]. The permanent of three rows of lengths
// r1, r2, r3 is at most 3! / 3^(3/2) r1 r2 r3 = 1.1548 r1 r2 r3 [Carlen, Lieb, Loss 2006], so that squared
// lengths, which cost little, bound it. Squares are compared with squares, which needs no root; `tiny` leaves
// to the next stage what might underflow.

namespace kropla::filter {

inline constexpr double eps = 0x1p-53;
inline constexpr double tiny = 1e-280;

/// orient3d: 3 roundings of differences, 2 of a minor, 3 of the product and sums: 8 eps times 1.1548 r1 r2
/// r3.
inline constexpr double orient3d_factor = 9.3 * eps * 9.3 * eps;

/// insphere: 8 as above, 5 of a lift (differences 2, square 1, sums 2), 3 of the last product and sums: 16
/// eps times four terms of lift * 1.1548 r1 r2 r3, each at most (largest lift)^(5/2).
inline constexpr double insphere_factor = 75.0 * eps * 75.0 * eps;

/// Whether the sign of the rounded determinant of the differences u, v, w is right.
inline bool certain(double det, double uu, double vv, double ww) {
    return det * det > orient3d_factor * (uu * vv * ww) + tiny;
}

inline bool all_certain(const Four& det, const Four& uu, const Four& vv, const Four& ww) {
    return all_greater(det * det, orient3d_factor * (uu * vv * ww) + tiny);
}

[[nodiscard]] inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = c - a, w = d - a;
    const double det = determinant(u, v, w);
    if (!certain(det, squared_norm(u), squared_norm(v), squared_norm(w))) return 0;
    return det > 0 ? 1 : -1;
}

/// For a, b, c, d positively oriented.
[[nodiscard]] inline int insphere(const Vec3& pa, const Vec3& pb, const Vec3& pc, const Vec3& pd,
                                  const Vec3& e) {
    const Vec3 a = pa - e, b = pb - e, c = pc - e, d = pd - e;
    const double la = squared_norm(a), lb = squared_norm(b), lc = squared_norm(c), ld = squared_norm(d);
    const double ab = a.x * b.y - b.x * a.y, bc = b.x * c.y - c.x * b.y, cd = c.x * d.y - d.x * c.y;
    const double da = d.x * a.y - a.x * d.y, ac = a.x * c.y - c.x * a.y, bd = b.x * d.y - d.x * b.y;
    const double abc = a.z * bc - b.z * ac + c.z * ab;
    const double bcd = b.z * cd - c.z * bd + d.z * bc;
    const double cda = c.z * da + d.z * ac + a.z * cd;
    const double dab = d.z * ab + a.z * bd + b.z * da;
    const double det = (lc * dab - ld * abc) + (la * bcd - lb * cda);
    const double lift = std::max(std::max(la, lb), std::max(lc, ld));
    const double lift2 = lift * lift;
    if (!(det * det > insphere_factor * (lift2 * lift2 * lift) + tiny)) return 0;
    return det > 0 ? 1 : -1;
}

}  // namespace kropla::filter
