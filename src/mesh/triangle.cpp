// Distances of triangles. Two triangles that do not pierce each other are nearest at a corner of one, or where an edge
// of each is nearest to the other [Ericson 2005, "Real-Time Collision Detection", 5.1].
//
// Two triangles that are not in one plane meet, if they do, in a segment that ends at an edge of one of them; so it is enough
// to ask whether an edge of one meets the other, as in [Guigue, Devillers 2003] "Fast and robust triangle-triangle overlap
// test using orientation predicates", J. Graphics Tools 8. Within a plane the orientation is asked with a point off it, so that
// one predicate does for all.

#include "mesh/triangle.h"

#include <kropla/base/predicates.h>

#include "mesh/box_tree.h"

#include <algorithm>
#include <cmath>
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

/// Of points in the plane of the triangle.
bool is_inside(const Vec3& x, const Corners& t, const Vec3& apex) {
    bool left = false, right = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const int s = side(t[i], t[next(i)], x, apex);
        left = left || s > 0;
        right = right || s < 0;
    }
    return !(left && right);
}

bool ranges_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    Extent one, other;
    one.take_in(p);
    one.take_in(q);
    other.take_in(a);
    other.take_in(b);
    return one.meets(other);
}

bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& apex) {
    const int pa = side(p, q, a, apex), pb = side(p, q, b, apex);
    if (pa * pb > 0) return false;
    if (pa == 0 && pb == 0) return ranges_meet(p, q, a, b);  // all on one line
    return side(a, b, p, apex) * side(a, b, q, apex) <= 0;
}

bool meets_in_plane(const Vec3& p, const Vec3& q, const Corners& t, const Vec3& apex) {
    if (is_inside(p, t, apex) || is_inside(q, t, apex)) return true;
    for (std::size_t i = 0; i < 3; ++i)
        if (segments_meet(p, q, t[i], t[next(i)], apex)) return true;
    return false;
}

/// Off the plane of the triangle, which has an area.
Vec3 off_plane(const Corners& t) {
    const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
    double largest = 0;
    for (const Vec3& corner : t) largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    Vec3 x = t[0];
    x[axis] += largest;
    return x;
}

bool any_edge_meets(const Corners& edges_of, const Corners& t) {
    const Vec3 apex = off_plane(t);
    for (std::size_t i = 0; i < 3; ++i)
        if (meets(edges_of[i], edges_of[next(i)], t, apex)) return true;
    return false;
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

int side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& x) {
    for (int axis = 0; axis < 3; ++axis)
        if (a[axis] == b[axis] && a[axis] == c[axis] && a[axis] == x[axis]) return 0;
    return orient3d(a, b, c, x);
}

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

Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& x) {
    const double along = std::clamp(dot(x - a, b - a) / squared_norm(b - a), 0.0, 1.0);
    return along < 0.5 ? a + along * (b - a) : b + (1 - along) * (a - b);  // the ends exactly
}

bool pierce(const Corners& a, const Corners& b) {
    return may_meet(a, b) && (any_edge_pierces(a, b) || any_edge_pierces(b, a));
}

bool meets(const Vec3& p, const Vec3& q, const Corners& t, const Vec3& apex) {
    const auto& [a, b, c] = t;
    const int sp = side(a, b, c, p), sq = side(a, b, c, q);
    if (sp * sq > 0) return false;
    if (sp == 0 && sq == 0) return meets_in_plane(p, q, t, apex);
    if (sp == 0 || sq == 0) return is_inside(sp == 0 ? p : q, t, apex);
    const int ab = side(p, q, a, b), bc = side(p, q, b, c), ca = side(p, q, c, a);
    return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

bool meet(const Corners& a, const Corners& b) {
    return may_meet(a, b) && (any_edge_meets(a, b) || any_edge_meets(b, a));
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
