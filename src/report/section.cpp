// The cut of a mesh by a plane: marching cells with one rule for ties. A vertex on the plane counts as
// above it, so that every cell has a clear case and neighbours agree about their common facet.
//
// A tet has 1, 2 or 3 corners above. Of a prism, each facet is cut by itself, and its lines are joined to closed
// polygons. A quad with its corners above and below in turns has two lines; which of the two pairs, the sign where
// its bilinear height is stationary says [Nielson, Hamann 1991, "The asymptotic decider"], for both its prisms.

#include "report/section.h"

#include <kropla/mesh/prisms.h>

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
    CutPolygon polygon{.region = mesh.region[t], .size = s.count_above == 2 ? 4 : 3, .corners = {}};
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

// ---- prisms

// Edges of a prism: 0 1 2 around its lower triangle, 3 4 5 around the upper one, 6 7 8 the columns.
constexpr std::array<std::array<std::size_t, 2>, 9> prism_edges = {
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
// The corners around each facet, and the edges from each of them to the next. The last of a triangle stands twice.
constexpr std::array<std::array<std::size_t, 4>, 5> facet_corners = {
    {{0, 1, 2, 2}, {3, 4, 5, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<std::array<std::size_t, 4>, 5> facet_edges = {
    {{0, 1, 2, 2}, {3, 4, 5, 5}, {0, 7, 3, 6}, {1, 8, 4, 7}, {2, 6, 5, 8}}};

/// The lines in the facets of a prism: per crossed edge, to which edges they lead, one line in each facet there.
struct Lines {
    std::array<std::array<std::size_t, 2>, 9> to = {};
    std::array<std::size_t, 9> count = {};
    void join(std::size_t a, std::size_t b) {
        to[a][count[a]++] = b;
        to[b][count[b]++] = a;
    }
};

void add_lines(Lines& lines, std::size_t facet, const std::array<double, 6>& heights) {
    const std::size_t size = facet < 2 ? 3 : 4;
    const auto height = [&](std::size_t i) { return heights[facet_corners[facet][i % size]]; };
    std::array<std::size_t, 4> crossed{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i)
        if ((height(i) < 0) != (height(i + 1) < 0)) crossed[count++] = facet_edges[facet][i];
    if (count == 2) lines.join(crossed[0], crossed[1]);
    if (count < 4) return;
    const double saddle = height(0) * height(2) - height(1) * height(3);  // above 0: corners 0 and 2 belong together
    const bool first_apart = saddle < 0 || (saddle == 0 && height(0) < 0);
    lines.join(crossed[0], crossed[first_apart ? 3 : 1]);
    lines.join(crossed[2], crossed[first_apart ? 1 : 3]);
}

/// Adds the polygons cut out of a prism; rarely more than one, of a very bent prism.
void cut_prism(std::vector<CutPolygon>& polygons, const Mesh& mesh, const Prism& prism, const CutPlane& plane) {
    const auto vertices = prism_vertices(mesh, prism);
    std::array<double, 6> heights{};
    for (std::size_t i = 0; i < 6; ++i) heights[i] = height(mesh, vertices[i], plane);
    Lines lines;
    for (std::size_t facet = 0; facet < 5; ++facet) add_lines(lines, facet, heights);
    std::array<bool, 9> done{};
    for (std::size_t start = 0; start < 9; ++start) {
        if (lines.count[start] == 0 || done[start]) continue;
        CutPolygon polygon{
            .region = layer_of(mesh, prism.layer).region, .of_prism = true, .size = 0, .corners = {}};
        for (std::size_t edge = start, before = start; !done[edge];) {
            done[edge] = true;
            const auto& [a, b] = prism_edges[edge];
            polygon.corners[static_cast<std::size_t>(polygon.size++)] =
                crossing(mesh, vertices[a], vertices[b], plane);
            const auto& to = lines.to[edge];
            before = std::exchange(edge, to[0] == before ? to[1] : to[0]);
        }
        if (signed_area(polygon) < 0)
            std::reverse(polygon.corners.begin(), polygon.corners.begin() + polygon.size);
        if (area(polygon) > 0) polygons.push_back(polygon);
    }
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
    for (const Prism& prism : all_prisms(mesh)) cut_prism(polygons, mesh, prism, plane);
    return polygons;
}

double area(const CutPolygon& polygon) { return signed_area(polygon); }

}  // namespace kropla
