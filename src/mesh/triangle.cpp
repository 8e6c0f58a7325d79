// Distances of triangles. Two triangles that do not pierce each other are nearest at a corner of one, or where an edge
// of each is nearest to the other [Ericson 2005, "Real-Time Collision Detection", 5.1].

#include "mesh/triangle.h"

#include <kropla/base/predicates.h>

#include <algorithm>
#include <cstddef>

namespace kropla {

namespace {

constexpr std::size_t next(std::size_t corner) { return (corner + 1) % 3; }

/// The nearest point of the edge from corner i to the next. Told from its own length and nothing else: well
/// conditioned for needles too.
OnTriangle closest_on_edge(const Corners& triangle, std::size_t i, const Vec3& x) {
    const Vec3 &a = triangle[i], &b = triangle[next(i)];
    const double along = dot(x - a, b - a), whole = squared_norm(b - a);
    const auto part = [](TrianglePart first, std::size_t k) {
        return static_cast<TrianglePart>(static_cast<std::size_t>(first) + k);
    };
    if (!(along > 0)) return {a, part(TrianglePart::corner_0, i)};
    if (along >= whole) return {b, part(TrianglePart::corner_0, next(i))};
    return {a + along / whole * (b - a), part(TrianglePart::edge_0, i)};
}

/// Does the segment go through the inside of the triangle?
bool pierces(const Vec3& p, const Vec3& q, const Corners& t) {
    const int from = orient3d(t[0], t[1], t[2], p), to = orient3d(t[0], t[1], t[2], q);
    if (from == 0 || to == 0 || from == to) return false;
    const int side = orient3d(p, q, t[0], t[1]);
    return side != 0 && orient3d(p, q, t[1], t[2]) == side && orient3d(p, q, t[2], t[0]) == side;
}

bool any_edge_pierces(const Corners& edges_of, const Corners& t) {
    for (std::size_t i = 0; i < 3; ++i)
        if (pierces(edges_of[i], edges_of[next(i)], t)) return true;
    return false;
}

/// Between the insides of two edges, if they are nearest there; else something that is no less than the distance.
double between_edges(const Vec3& p, const Vec3& along_p, const Vec3& q, const Vec3& along_q) {
    const Vec3 apart = p - q;
    const double pp = squared_norm(along_p), qq = squared_norm(along_q), pq = dot(along_p, along_q);
    const double p_apart = dot(along_p, apart), q_apart = dot(along_q, apart);
    const double area = pp * qq - pq * pq;
    const double s = area > 0 ? std::clamp((pq * q_apart - qq * p_apart) / area, 0.0, 1.0) : 0;
    const double t = std::clamp((pq * s + q_apart) / qq, 0.0, 1.0);
    return squared_norm(apart + s * along_p - t * along_q);
}

bool may_meet(const Corners& a, const Corners& b) {
    for (int axis = 0; axis < 3; ++axis) {
        const auto [a_min, a_max] = std::minmax({a[0][axis], a[1][axis], a[2][axis]});
        const auto [b_min, b_max] = std::minmax({b[0][axis], b[1][axis], b[2][axis]});
        if (a_max < b_min || b_max < a_min) return false;
    }
    return true;
}

}  // namespace

OnTriangle closest_on_triangle(const Corners& triangle, const Vec3& x) {
    const auto& [a, b, c] = triangle;
    const Vec3 normal = cross(b - a, c - a);
    const auto within = [&](const Vec3& p, const Vec3& q) { return dot(cross(q - p, x - p), normal) > 0; };
    if (within(a, b) && within(b, c) && within(c, a))
        return {x - dot(x - a, normal) / squared_norm(normal) * normal, TrianglePart::inside};
    OnTriangle nearest = closest_on_edge(triangle, 0, x);
    for (std::size_t i = 1; i < 3; ++i) {
        const OnTriangle on_edge = closest_on_edge(triangle, i, x);
        if (squared_norm(x - on_edge.point) < squared_norm(x - nearest.point)) nearest = on_edge;
    }
    return nearest;
}

bool pierce(const Corners& a, const Corners& b) {
    return may_meet(a, b) && (any_edge_pierces(a, b) || any_edge_pierces(b, a));
}

double squared_distance(const Corners& a, const Corners& b) {
    if (pierce(a, b)) return 0;
    double least = squared_norm(a[0] - b[0]);
    for (std::size_t i = 0; i < 3; ++i) {
        least = std::min({least, squared_norm(a[i] - closest_on_triangle(b, a[i]).point),
                          squared_norm(b[i] - closest_on_triangle(a, b[i]).point)});
        for (std::size_t j = 0; j < 3; ++j)
            least = std::min(least, between_edges(a[i], a[next(i)] - a[i], b[j], b[next(j)] - b[j]));
    }
    return least;
}

}  // namespace kropla
