// Clipping of a tet by planes, and the integrals over what is left.
//   [Powell, Abel 2015] An exact general remeshing scheme applied to physically conservative voxelization. J.
//   Comput.
//     Phys. 297: a polyhedron as a graph of vertices with three neighbours each; cutting it by inserting
//     vertices on the edges that cross the plane and linking each to the next around its face.
// Changed: it works in the barycentric coordinates of the tet, so that shares and moments need no scale, and
// all integrals come from tets that start at one vertex of the part: they are sums of positive terms.

#include "transfer/clip.h"

namespace kropla {
namespace {

using Place = std::array<double, 3>;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr int place_in(const std::array<std::int8_t, 3>& next, int vertex) {
    return next[0] == vertex ? 0 : next[1] == vertex ? 1 : 2;
}

/// Where a function is zero between two vertices, at which it is `inside` >= 0 and `outside` < 0.
Place crossing(const Place& a, double inside, const Place& b, double outside) {
    const double whole = inside - outside;
    Place x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = (b[k] * inside - a[k] * outside) / whole;
    return x;
}

/// A step of a way around a face: from a vertex along one of its edges.
struct Step {
    int from, edge;
};
constexpr int end_of(const TetPart& part, Step s) { return part.next[at(s.from)][at(s.edge)]; }
constexpr Step next_around_face(const TetPart& part, Step s) {
    const int to = end_of(part, s), back = place_in(part.next[at(to)], s.from);
    return {to, back == 2 ? 0 : back + 1};
}

/// Puts a vertex on each edge that leaves the inside; it knows the edge's inner end alone.
void add_crossings(TetPart& part, const std::array<double, TetPart::most_vertices>& value) {
    const int before = part.count;
    for (int v = 0; v < before; ++v) {
        if (value[at(v)] < 0) continue;
        for (auto& end : part.next[at(v)]) {
            if (value[at(end)] >= 0) continue;
            const int fresh = part.count++;
            part.place[at(fresh)] =
                crossing(part.place[at(v)], value[at(v)], part.place[at(end)], value[at(end)]);
            part.next[at(fresh)][0] = static_cast<std::int8_t>(v);
            end = static_cast<std::int8_t>(fresh);
        }
    }
}

/// Links the vertices from `first_fresh` on along the edges of the new face.
void close_face(TetPart& part, int first_fresh) {
    for (int v = first_fresh; v < part.count; ++v) {
        Step s{v, 0};
        do s = next_around_face(part, s);
        while (s.from < first_fresh);
        part.next[at(v)][2] = static_cast<std::int8_t>(s.from);
        part.next[at(s.from)][1] = static_cast<std::int8_t>(v);
    }
}

void drop_outside(TetPart& part, const std::array<double, TetPart::most_vertices>& value, int first_fresh) {
    std::array<std::int8_t, TetPart::most_vertices> renumbered;
    int kept = 0;
    for (int v = 0; v < part.count; ++v) {
        if (v < first_fresh && value[at(v)] < 0) continue;
        part.place[at(kept)] = part.place[at(v)];
        part.next[at(kept)] = part.next[at(v)];
        renumbered[at(v)] = static_cast<std::int8_t>(kept++);
    }
    part.count = kept;
    for (int v = 0; v < kept; ++v)
        for (auto& end : part.next[at(v)]) end = renumbered[at(end)];
}

/// Sums over tets with a corner at the origin: of 1, of the coordinates, of their products, each with its factor
/// left out.
struct Sums {
    double volume = 0;
    Place first{};
    std::array<double, 6> second{};  // 11, 12, 13, 22, 23, 33

    void add(const Place& b, const Place& c, const Place& d) {
        const double det = b[0] * (c[1] * d[2] - c[2] * d[1]) + b[1] * (c[2] * d[0] - c[0] * d[2]) +
                           b[2] * (c[0] * d[1] - c[1] * d[0]);
        volume += det;
        const Place sum = {b[0] + c[0] + d[0], b[1] + c[1] + d[1], b[2] + c[2] + d[2]};
        for (std::size_t k = 0; k < 3; ++k) first[k] += det * sum[k];
        std::size_t n = 0;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = i; j < 3; ++j)
                second[n++] += det * ((sum[i] * sum[j] + b[i] * b[j]) + (c[i] * c[j] + d[i] * d[j]));
    }
};

/// With their factors, and the origin moved to where it is seen from the tet's corner 0.
Sums finished(const Sums& s, const Place& origin) {
    Sums moved{s.volume, {}, {}};
    const Place first = {s.first[0] / 4, s.first[1] / 4, s.first[2] / 4};
    for (std::size_t k = 0; k < 3; ++k) moved.first[k] = first[k] + s.volume * origin[k];
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = i; j < 3; ++j, ++n)
            moved.second[n] = s.second[n] / 20 + (origin[i] * first[j] + origin[j] * first[i]) +
                              s.volume * origin[i] * origin[j];
    return moved;
}

/// The same for all four coordinates.
TetMoments with_corner_0(const Sums& s) {
    const auto& q = s.second;
    const double q01 = s.first[0] - (q[0] + q[1] + q[2]), q02 = s.first[1] - (q[1] + q[3] + q[4]),
                 q03 = s.first[2] - (q[2] + q[4] + q[5]);
    const double mean = s.volume - (s.first[0] + s.first[1] + s.first[2]);
    return {{{mean - (q01 + q02 + q03), q01, q02, q03},
             {q01, q[0], q[1], q[2]},
             {q02, q[1], q[3], q[4]},
             {q03, q[2], q[4], q[5]}}};
}

}  // namespace

TetPart whole_tet() {
    TetPart part;
    part.count = 4;
    part.place[0] = {0, 0, 0};
    part.place[1] = {1, 0, 0};
    part.place[2] = {0, 1, 0};
    part.place[3] = {0, 0, 1};
    part.next[0] = {1, 3, 2};
    part.next[1] = {2, 3, 0};
    part.next[2] = {0, 3, 1};
    part.next[3] = {1, 2, 0};
    return part;
}

bool cut(TetPart& part, const std::array<double, 4>& at_corners) {
    std::array<double, TetPart::most_vertices> value;
    const double start = at_corners[0];
    const Place slope = {at_corners[1] - start, at_corners[2] - start, at_corners[3] - start};
    int outside = 0;
    for (int v = 0; v < part.count; ++v) {
        const Place& x = part.place[at(v)];
        value[at(v)] = start + (slope[0] * x[0] + slope[1] * x[1] + slope[2] * x[2]);
        if (value[at(v)] < 0) ++outside;
    }
    if (outside == 0) return false;
    if (outside == part.count) {
        part.count = 0;
        return true;
    }
    const int first_fresh = part.count;
    add_crossings(part, value);
    close_face(part, first_fresh);
    drop_outside(part, value, first_fresh);
    return true;
}

TetMoments moments(const TetPart& part) {
    if (part.count == 0) return {};
    const Place origin = part.place[0];
    std::array<Place, TetPart::most_vertices> place;
    for (int v = 0; v < part.count; ++v)
        for (std::size_t k = 0; k < 3; ++k) place[at(v)][k] = part.place[at(v)][k] - origin[k];
    std::array<std::uint8_t, TetPart::most_vertices> done{};  // per vertex, a bit per edge of it
    const auto walk_on = [&](Step s) {
        done[at(s.from)] = static_cast<std::uint8_t>(done[at(s.from)] | 1u << s.edge);
        return next_around_face(part, s);
    };
    for (int e = 0; e < 3; ++e) {  // the faces at vertex 0: their tets are flat
        Step s{0, e};
        do s = walk_on(s);
        while (s.from != 0);
    }
    Sums sums;
    for (int v = 1; v < part.count; ++v)
        for (int e = 0; e < 3; ++e) {
            if (done[at(v)] >> e & 1u) continue;
            Step s = walk_on({v, e});
            for (int to = end_of(part, s); to != v; to = end_of(part, s)) {
                sums.add(place[at(v)], place[at(to)], place[at(s.from)]);
                s = walk_on(s);
            }
            walk_on(s);
        }
    return with_corner_0(finished(sums, origin));
}

}  // namespace kropla
