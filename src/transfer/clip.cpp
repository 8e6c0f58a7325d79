// Clipping of a tet by planes, and the integrals over what is left.
//   [Eberly 2007] Wild Magic 4, IntrTetrahedron3Tetrahedron3 (geometrictools.com): the part is kept as tets,
//     and what a plane leaves of each is one tet or a prism, which falls into three.
// Changed: where a plane goes through corners, as it does where old and new cells have them in common, the
// pieces without volume are left out. It works in the barycentric coordinates of the tet, so that shares and
// moments need no scale, and all integrals are sums of positive terms.

#include "transfer/clip.h"

#include <kropla/base/index.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

using Place = std::array<double, 3>;

struct Corner {
    const Place* place;
    double value;
};

/// Where the function is zero between two corners, at which it is >= 0 and < 0.
Place crossing(const Corner& inside, const Corner& outside) {
    const double per_whole = 1 / (inside.value - outside.value);
    Place x;
    for (std::size_t k = 0; k < 3; ++k)
        x[k] = ((*outside.place)[k] * inside.value - (*inside.place)[k] * outside.value) * per_whole;
    return x;
}

/// Adds the pieces of a tet within the plane, a prism by its staircase; those that are flat, as a corner is in
/// the plane, are left out. `corner`: those inside first.
void add_inside(TetPart& part, const std::array<Corner, 4>& corner, std::size_t inside) {
    const auto add = [&](const Place& a, const Place& b, const Place& c, const Place& d) {
        part.tets[as_size(part.count++)] = {a, b, c, d};
    };
    const auto& [a, b, c, d] = corner;
    const Place ad = crossing(a, d);
    if (inside == 1) {
        add(*a.place, crossing(a, b), crossing(a, c), ad);
    } else if (inside == 2) {
        const Place bc = crossing(b, c), bd = crossing(b, d);
        if (b.value > 0) add(*a.place, *b.place, bc, bd);
        if (a.value > 0) {
            const Place ac = crossing(a, c);
            if (b.value > 0) add(*a.place, ac, bc, bd);
            add(*a.place, ac, ad, bd);
        }
    } else {
        const Place bd = crossing(b, d), cd = crossing(c, d);
        if (c.value > 0) add(*a.place, *b.place, *c.place, cd);
        if (b.value > 0) add(*a.place, *b.place, bd, cd);
        if (a.value > 0) add(*a.place, ad, bd, cd);
    }
}

}  // namespace

TetPart whole_tet() {
    TetPart part;
    part.count = 1;
    part.tets[0] = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    return part;
}

bool cut(TetPart& part, const std::array<double, 4>& at_corners) {
    const double start = at_corners[0];
    const Place slope = {at_corners[1] - start, at_corners[2] - start, at_corners[3] - start};
    bool any = false;
    for (int t = part.count - 1; t >= 0; --t) {  // those behind it are done
        const auto& tet = part.tets[as_size(t)];
        std::array<double, 4> value;
        for (std::size_t k = 0; k < 4; ++k)
            value[k] = start + (slope[0] * tet[k][0] + slope[1] * tet[k][1] + slope[2] * tet[k][2]);
        const double least = std::min(std::min(value[0], value[1]), std::min(value[2], value[3])),
                     most = std::max(std::max(value[0], value[1]), std::max(value[2], value[3]));
        if (least >= 0) continue;
        any = true;
        const auto whole = tet;
        part.tets[as_size(t)] = part.tets[as_size(--part.count)];
        if (most <= 0) continue;
        std::array<Corner, 4> corner;
        std::size_t inside = 0, end = 4;
        for (std::size_t k = 0; k < 4; ++k) corner[value[k] < 0 ? --end : inside++] = {&whole[k], value[k]};
        add_inside(part, corner, inside);
    }
    return any;
}

TetMoments moments(const TetPart& part) {
    double volume = 0;
    Place first{};
    std::array<double, 6> second{};  // 11, 12, 13, 22, 23, 33
    for (int t = 0; t < part.count; ++t) {
        const auto& [a, b, c, d] = part.tets[as_size(t)];
        Place u, v, w, sum;
        for (std::size_t k = 0; k < 3; ++k) {
            u[k] = b[k] - a[k];
            v[k] = c[k] - a[k];
            w[k] = d[k] - a[k];
            sum[k] = (a[k] + b[k]) + (c[k] + d[k]);
        }
        const double share =
            std::abs(u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                     u[2] * (v[0] * w[1] - v[1] * w[0]));
        volume += share;
        for (std::size_t k = 0; k < 3; ++k) first[k] += share * sum[k];
        std::size_t n = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = i; j < 3; ++j)
                second[n++] += share * (sum[i] * sum[j] +
                                        ((a[i] * a[j] + b[i] * b[j]) + (c[i] * c[j] + d[i] * d[j])));
    }
    for (double& x : first) x /= 4;
    for (double& x : second) x /= 20;
    const auto& q = second;
    const double q01 = first[0] - (q[0] + q[1] + q[2]), q02 = first[1] - (q[1] + q[3] + q[4]),
                 q03 = first[2] - (q[2] + q[4] + q[5]);
    const double mean = volume - (first[0] + first[1] + first[2]);
    return {{{mean - (q01 + q02 + q03), q01, q02, q03},
             {q01, q[0], q[1], q[2]},
             {q02, q[1], q[3], q[4]},
             {q03, q[2], q[4], q[5]}}};
}

}  // namespace kropla
