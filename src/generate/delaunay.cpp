// Incremental Delaunay triangulation: the order of insertion, the first tet and the result; the step is in
// delaunay_kernel.cpp.

#include "generate/delaunay.h"

#include <kropla/base/predicates.h>
#include "generate/delaunay_kernel.h"
#include "generate/hilbert.h"

#include <algorithm>
#include <utility>

namespace kropla {

namespace {

using delaunay::Cell, delaunay::ghost, delaunay::is_ghost, delaunay::Kernel, delaunay::Mark, delaunay::none, delaunay::others;
using std::uint32_t;

constexpr uint32_t points_at_once = 4096;  // between two looks at the watch: some milliseconds

/// Brings four points that are not coplanar, positively oriented, to the front of the order, the others
/// unchanged behind them. Returns false if there are none.
bool bring_tet_to_front(std::span<const Vec3> points, std::vector<Vertex>& order) {
    const auto place = [&](std::size_t i) { return points[static_cast<std::size_t>(order[i].value)]; };
    const auto collinear = [](const Vec3& a, const Vec3& b, const Vec3& c) {  // in all three projections
        return orient3d({a.x, a.y, 0}, {b.x, b.y, 0}, {c.x, c.y, 0}, {a.x, a.y, 1}) == 0 &&
               orient3d({a.y, a.z, 0}, {b.y, b.z, 0}, {c.y, c.z, 0}, {a.y, a.z, 1}) == 0 &&
               orient3d({a.z, a.x, 0}, {b.z, b.x, 0}, {c.z, c.x, 0}, {a.z, a.x, 1}) == 0;
    };
    const auto bring = [&](std::size_t from, std::size_t to) {
        const auto begin = order.begin();
        std::rotate(begin + static_cast<std::ptrdiff_t>(to), begin + static_cast<std::ptrdiff_t>(from),
                    begin + static_cast<std::ptrdiff_t>(from) + 1);
    };
    if (order.size() < 4) return false;
    std::size_t third = 2;
    while (third < order.size() && collinear(place(0), place(1), place(third))) ++third;
    if (third == order.size()) return false;
    bring(third, 2);
    std::size_t fourth = 3;
    while (fourth < order.size() && orient3d(place(0), place(1), place(2), place(fourth)) == 0) ++fourth;
    if (fourth == order.size()) return false;
    bring(fourth, 3);
    if (orient3d(place(0), place(1), place(2), place(3)) < 0) std::swap(order[0], order[1]);
    return true;
}

/// The first tet, of sites 1 ... 4, and the four ghosts around it, joined.
void start(Kernel& k) {
    k.cells.push_back({{1, 2, 3, 4}, {}});
    for (const auto& o : others) {
        const auto& v = k.cells[0].vertex;
        k.cells.push_back({{v[o[0]], v[o[1]], v[o[2]], ghost}, {}});
    }
    const auto opposite = [&](uint32_t t, std::size_t corner) {  // the sites of the facet, ascending
        std::array<uint32_t, 3> sites;
        for (std::size_t i = 0; i < 3; ++i) sites[i] = k.cells[t].vertex[others[corner][i]];
        std::ranges::sort(sites);
        return sites;
    };
    for (uint32_t f = 0; f < 20; ++f)
        for (uint32_t g = 0; g < 20; ++g)
            if (f != g && opposite(f >> 2, f & 3) == opposite(g >> 2, g & 3))
                k.cells[f >> 2].across[f & 3] = g;
    k.mark.assign(k.cells.size(), Mark::unseen);
}

/// The finite cells, in their order, with vertices by the points' indices; what led to a ghost leads nowhere. In place,
/// and the kernel goes: a triangulation of many points takes the most room at its end.
std::vector<Cell> finite_cells(Kernel k) {
    for (const uint32_t t : k.free_cells) k.cells[t].vertex[0] = none;
    const auto across_of = [&](uint32_t facet) -> uint32_t& { return k.cells[facet >> 2].across[facet & 3]; };
    for (const Cell& c : k.cells)
        if (is_ghost(c) && c.vertex[0] != none) across_of(c.across[3]) = none;
    uint32_t to = 0;
    for (const Cell& c : k.cells) {
        if (c.vertex[0] == none || is_ghost(c)) continue;
        Cell moved = c;
        for (uint32_t& v : moved.vertex) v = static_cast<uint32_t>(k.sites[v].rank);
        for (uint32_t i = 0; i < 4; ++i)
            if (moved.across[i] != none) across_of(moved.across[i]) = 4 * to + i;
        k.cells[to++] = moved;
    }
    k.cells.resize(to);
    return std::move(k.cells);
}

Triangulation triangulation_of(const std::vector<Cell>& cells) {
    Triangulation result;
    result.tets.reserve(cells.size());
    result.neighbour.reserve(cells.size());
    for (const Cell& c : cells) {
        std::array<Vertex, 4> vertices;
        std::array<Tet, 4> neighbours;
        for (std::size_t i = 0; i < 4; ++i) {
            vertices[i] = Vertex(std::size_t{c.vertex[i]});
            if (c.across[i] != none) neighbours[i] = Tet(std::size_t{c.across[i] >> 2});
        }
        result.tets.push_back(vertices);
        result.neighbour.push_back(neighbours);
    }
    return result;
}

}  // namespace

Triangulation triangulate_in_order(std::span<const Vec3> points, std::span<const Vertex> order,
                                   const Watch* watch) {
    heed(watch);
    std::vector<Vertex> sequence(order.begin(), order.end());
    if (!bring_tet_to_front(points, sequence)) return {};
    Kernel k;
    k.sites.reserve(sequence.size() + 1);
    k.sites.push_back({});
    for (const Vertex v : sequence) k.sites.push_back({points[static_cast<std::size_t>(v.value)], v.value});
    const std::size_t cells = 7 * sequence.size() + 100;  // 6.77 n for random points, and the ghosts
    k.cells.reserve(cells);
    k.mark.reserve(cells);
    start(k);
    for (uint32_t p = 5; p < k.sites.size(); ++p) {
        if ((p - 5) % points_at_once == 0) heed(watch);
        delaunay::insert(k, p);
    }
    const std::vector<Cell> finite = finite_cells(std::move(k));
    return triangulation_of(finite);
}

Triangulation triangulate(std::span<const Vec3> points, const Watch* watch) {
    SpatialOrder spatial = hilbert_order(points);
    Triangulation result = triangulate_in_order(points, in_random_rounds(spatial.order), watch);
    result.same_as = std::move(spatial.same_as);
    return result;
}

}  // namespace kropla
