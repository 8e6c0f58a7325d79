// Exact signs of determinants, after
//   [Shewchuk 1997] Adaptive precision floating-point arithmetic and fast robust geometric predicates;
//   [Devillers, Teillaud 2011] Perturbations for Delaunay and weighted Delaunay 3D triangulations.
// Against Shewchuk: three stages instead of his four (a bound from lengths, a bound from the permanent, all
// exact), because points in general position are decided by the first two and regular grids need the last at
// once.

#include <kropla/base/predicates.h>

#include "base/expansion.h"
#include "base/predicates_filter.h"

#include <algorithm>

namespace kropla {

namespace {

using Difference = Expansion<2>;

struct ExactVector {
    Difference x, y, z;
};

ExactVector exact_vector(const Vec3& a, const Vec3& b) {
    return {exact_difference(a.x, b.x), exact_difference(a.y, b.y), exact_difference(a.z, b.z)};
}

/// a.x b.y - b.x a.y
Expansion<16> minor(const ExactVector& a, const ExactVector& b) { return a.x * b.y - b.x * a.y; }

/// The determinant of three rows from the minors of the first two columns.
Expansion<192> combine(const Expansion<16>& bc, const Difference& az, const Expansion<16>& ac,
                       const Difference& bz, const Expansion<16>& ab, const Difference& cz) {
    return (bc * az - ac * bz) + ab * cz;
}

Expansion<24> lift(const ExactVector& a) { return (a.x * a.x + a.y * a.y) + a.z * a.z; }

/// The sign, or 0 if the permanent does not decide it. Closer than the filter for flat configurations.
int orient3d_by_permanent(const Vec3& u, const Vec3& v, const Vec3& w) {
    const auto term = [](double s, double p, double q, double& permanent) {
        permanent += std::abs(s) * (std::abs(p) + std::abs(q));
        return s * (p - q);
    };
    double permanent = 0;
    const double x = term(u.x, v.y * w.z, v.z * w.y, permanent);
    const double y = term(u.y, v.z * w.x, v.x * w.z, permanent);
    const double z = term(u.z, v.x * w.y, v.y * w.x, permanent);
    const double det = x + y + z;
    if (!(std::abs(det) > 8.1 * filter::eps * permanent)) return 0;
    return det > 0 ? 1 : -1;
}

int orient3d_exactly(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const ExactVector u = exact_vector(b, a), v = exact_vector(c, a), w = exact_vector(d, a);
    return sign(combine(minor(v, w), u.z, minor(u, w), v.z, minor(u, v), w.z));
}

/// One term of the 4x4 determinant, lift * det(p, q, r), and what it adds to the permanent.
double insphere_term(double lift, const Vec3& p, const Vec3& q, const Vec3& r, double& permanent) {
    const double qr1 = q.x * r.y, qr2 = q.y * r.x, pr1 = p.x * r.y;
    const double pr2 = p.y * r.x, pq1 = p.x * q.y, pq2 = p.y * q.x;
    permanent += lift * ((std::abs(qr1) + std::abs(qr2)) * std::abs(p.z) + (std::abs(pr1) + std::abs(pr2)) *
                         std::abs(q.z) + (std::abs(pq1) + std::abs(pq2)) * std::abs(r.z));
    return lift * (p.z * (qr1 - qr2) - q.z * (pr1 - pr2) + r.z * (pq1 - pq2));
}

int insphere_by_permanent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    double permanent = 0;
    const double ta = insphere_term(squared_norm(a), b, c, d, permanent);
    const double tb = insphere_term(squared_norm(b), a, c, d, permanent);
    const double tc = insphere_term(squared_norm(c), a, b, d, permanent);
    const double td = insphere_term(squared_norm(d), a, b, c, permanent);
    const double det = (ta - tb) + (tc - td);
    if (!(std::abs(det) > 16.1 * filter::eps * permanent)) return 0;
    return det > 0 ? 1 : -1;
}

int insphere_exactly(const Vec3& pa, const Vec3& pb, const Vec3& pc, const Vec3& pd, const Vec3& e) {
    const ExactVector a = exact_vector(pa, e), b = exact_vector(pb, e);
    const ExactVector c = exact_vector(pc, e), d = exact_vector(pd, e);
    const auto ab = minor(a, b), ac = minor(a, c), ad = minor(a, d);
    const auto bc = minor(b, c), bd = minor(b, d), cd = minor(c, d);
    const auto with_a = lift(a) * combine(cd, b.z, bd, c.z, bc, d.z);
    const auto with_b = lift(b) * combine(cd, a.z, ad, c.z, ac, d.z);
    const auto with_c = lift(c) * combine(bd, a.z, ad, b.z, ab, d.z);
    const auto with_d = lift(d) * combine(bc, a.z, ac, b.z, ab, c.z);
    return sign((with_a - with_b) + (with_c - with_d));
}

}  // namespace

int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    if (const int s = filter::orient3d(a, b, c, d)) return s;
    if (const int s = orient3d_by_permanent(b - a, c - a, d - a)) return s;
    return orient3d_exactly(a, b, c, d);
}

int insphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
    if (const int s = filter::insphere(a, b, c, d, e)) return s;
    if (const int s = insphere_by_permanent(a - e, b - e, c - e, d - e)) return s;
    return insphere_exactly(a, b, c, d, e);
}

// Lifted to the paraboloid, e is inside if it lies below the hyperplane h through the lifted a, b, c, d:
//     insphere = sign(h(e) - lift(e)),   h(e) = sum of lambda_i(e) lift(p_i),
// where lambda_i are the barycentric coordinates of e in the tet. Only the lifts are raised, each by an
// amount that outweighs all amounts of lower ranks. So on a tie the point of highest rank decides by its
// factor: -1 for e, and for a corner lambda_i, whose sign is the orientation of the tet with that corner
// replaced by e. Where that is zero the next rank decides; the factor of e is never zero, so the search ends.
// All five points enter one determinant, hence neighbouring tets agree, and as the triangulation is the lower
// hull of lifted points whose places are the true ones, it has no flat tets. A point coplanar with three
// corners takes the fourth out of play (its factor is zero), so that circles on the facets of the hull are
// decided alike from either side.
int insphere_perturbed(const std::array<const Vec3*, 5>& points, const std::array<std::int64_t, 5>& ranks) {
    if (const int s = insphere(*points[0], *points[1], *points[2], *points[3], *points[4])) return s;
    std::array<std::size_t, 5> by_rank = {0, 1, 2, 3, 4};
    std::ranges::sort(by_rank, [&](std::size_t i, std::size_t j) { return ranks[i] > ranks[j]; });
    for (const std::size_t i : by_rank) {
        if (i == 4) break;
        std::array<const Vec3*, 4> tet = {points[0], points[1], points[2], points[3]};
        tet[i] = points[4];
        if (const int s = orient3d(*tet[0], *tet[1], *tet[2], *tet[3])) return s;
    }
    return -1;
}

}  // namespace kropla
