// The cut of a tet mesh by a plane: marching tets with one rule for ties. A vertex on the plane counts as
// above it, so that every tet has a clear case (1, 2 or 3 corners above) and neighbours agree about their
// common facet.

#include "report/section.h"

#include <algorithm>
#include <utility>

namespace kropla {
namespace {

/// The height of a vertex above the plane, on the seen side [m].
double height(const Mesh& mesh, Vertex v, const CutPlane& plane) {
    return dot(mesh.position[v] - plane.origin, cross(plane.right, plane.up));
}

/// Always computed from the vertex of lower index, so that all tets at an edge get the same corner.
CutCorner crossing(const Mesh& mesh, Vertex a, Vertex b, const CutPlane& plane) {
    if (b < a) std::swap(a, b);
    const double at_a = height(mesh, a, plane), at_b = height(mesh, b, plane);
    const double share = at_a / (at_a - at_b);
    const Vec3 place = (1 - share) * mesh.position[a] + share * mesh.position[b] - plane.origin;
    return {a, b, share, {dot(place, plane.right), dot(place, plane.up)}};
}

double signed_area(const CutPolygon& polygon) {
    double doubled = 0;
    const Point2 first = polygon.corners[0].place;
    for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.size); ++i) {
        const Point2 p = polygon.corners[i - 1].place, q = polygon.corners[i].place;
        doubled += (p.x - first.x) * (q.y - first.y) - (q.x - first.x) * (p.y - first.y);
    }
    return doubled / 2;
}

/// The corners of a tet below and above the plane.
struct Sides {
    std::array<Vertex, 4> below, above;
    std::size_t count_below = 0, count_above = 0;
};

Sides sides(const Mesh& mesh, Tet t, const CutPlane& plane) {
    Sides s;
    for (const Vertex v : mesh.tets[t]) {
        if (height(mesh, v, plane) < 0) s.below[s.count_below++] = v;
        else s.above[s.count_above++] = v;
    }
    return s;
}

/// Of a tet with corners on both sides; may have no area.
CutPolygon cut_tet(const Mesh& mesh, Tet t, const Sides& s, const CutPlane& plane) {
    CutPolygon polygon{.tet = t, .size = s.count_above == 2 ? 4 : 3, .corners = {}};
    if (s.count_above == 2) {  // around the quad, below and above change in turns
        polygon.corners = {
            crossing(mesh, s.below[0], s.above[0], plane), crossing(mesh, s.below[0], s.above[1], plane),
            crossing(mesh, s.below[1], s.above[1], plane), crossing(mesh, s.below[1], s.above[0], plane)};
    } else {
        const Vertex alone = s.count_above == 1 ? s.above[0] : s.below[0];
        const auto& others = s.count_above == 1 ? s.below : s.above;
        for (std::size_t i = 0; i < 3; ++i) polygon.corners[i] = crossing(mesh, alone, others[i], plane);
    }
    if (signed_area(polygon) < 0)
        std::reverse(polygon.corners.begin(), polygon.corners.begin() + polygon.size);
    return polygon;
}

}  // namespace

CutPlane plane_across(int axis, const Vec3& origin) {
    constexpr Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    return {origin, axis == 0 ? y : x, axis == 2 ? y : z};
}

std::vector<CutPolygon> cut_mesh(const Mesh& mesh, const CutPlane& plane) {
    std::vector<CutPolygon> polygons;
    for (const Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        const Sides s = sides(mesh, t, plane);
        if (s.count_below == 0 || s.count_above == 0) continue;
        const CutPolygon polygon = cut_tet(mesh, t, s, plane);
        if (area(polygon) > 0) polygons.push_back(polygon);
    }
    return polygons;
}

double area(const CutPolygon& polygon) { return signed_area(polygon); }

}  // namespace kropla
