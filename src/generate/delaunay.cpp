// Incremental Delaunay triangulation, after
//   [Bowyer 1981], [Watson 1981]: a new point replaces the tets whose spheres hold it, the cavity;
//   [Amenta, Choi, Rote 2003]: the order of insertion, so that each point is near the one before;
//   [Devillers, Pion, Teillaud 2002]: the visibility walk, which ends in any Delaunay triangulation;
//   [Marot, Pellerin, Remacle 2019]: flat arrays, vertices copied in order of insertion, a small table to join tets.
// Ours: the ties are broken by raising the lifts only (predicates.h). Orientations stay exact, and a ghost tet, whose
// facet on the hull is coplanar with the point, is in conflict if the finite tet behind that facet is: their
// spheres meet the plane in the same circle, so that all tets at it agree. Hence no flat tet is ever made.

#include "generate/delaunay.h"

#include "base/predicates.h"
#include "base/predicates_filter.h"
#include "generate/hilbert.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace kropla {

namespace {

using std::uint32_t;

constexpr uint32_t none = 0xffffffff;
constexpr uint32_t ghost = 0;  // the site at infinity, to which all facets of the hull are joined

/// A point to be inserted, in the order of insertion; half a cache line.
struct alignas(32) Site {
    Vec3 at;
    std::int32_t rank = -1;  // the point's index in the input
    uint32_t local = none;   // its number among the vertices of the rim, while the cavity is filled
};

/// A positively oriented tet; half a cache line. A ghost stands at corner 3 only: then corners 0 1 2 are a facet of
/// the hull, and a point d lies strictly beyond it if (0, 1, 2, d) is positively oriented.
struct alignas(32) Cell {
    std::array<uint32_t, 4> vertex;
    std::array<uint32_t, 4> across;  // 4 * cell + corner: the cell across the facet opposite each corner, and which
                                     // of its corners is opposite that facet
};

/// A facet around the cavity: (p, a, b, c) will be a positive tet; the ghost is c, if it is one of them.
struct RimFacet {
    uint32_t a, b, c;
    uint32_t outside;  // 4 * cell + corner of the cell that stays
};

/// For each corner the three others, such that all four are an even permutation and corner 3 comes last.
constexpr std::array<std::array<std::size_t, 3>, 4> others = {{{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}}};

constexpr std::size_t table_side = 64;  // cavities with more vertices are joined by sorting

/// A stack for inner loops: room is made ahead, and an item is kept or not without a branch.
template <class T>
struct Stack {
    std::vector<T> slots;
    std::size_t size = 0;

    void make_room(std::size_t more) {
        if (size + more > slots.size()) slots.resize(2 * (size + more));
    }
    void push_if(bool wanted, const T& item) {
        slots[size] = item;
        size += wanted;
    }
    void push(const T& item) {
        make_room(1);
        push_if(true, item);
    }
    T& operator[](std::size_t i) { return slots[i]; }
};

enum class Mark : std::uint8_t { unseen, inside, outside };

/// An edge of the rim as a new tet sees it, and 4 * cell + corner of the facet it spans with the new point.
struct RimEdge {
    uint32_t low, high, facet;
};

struct Kernel {
    std::vector<Site> sites;  // the ghost, then the points
    std::vector<Cell> cells;
    std::vector<uint32_t> free_cells;
    std::vector<Mark> mark;  // per cell, of the cavity: unseen again when it is filled
    uint32_t last = 0;       // a finite cell, where the next walk starts
    Stack<uint32_t> cavity;  // the cells in conflict, breadth first, as 4 * cell + corner to the one it was found from
    Stack<RimFacet> rim;
    std::vector<uint32_t> slots;  // for the new cells, one per facet of the rim
    Stack<uint32_t> rim_vertices;
    std::vector<RimEdge> rim_edges;  // for large cavities
    std::array<uint32_t, table_side * table_side> facet_at_edge;  // by local numbers, in the direction of the new tet
};

bool is_ghost(const Cell& c) { return c.vertex[3] == ghost; }

int side_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int s = filter::orient3d(a, b, c, d);
    return s != 0 ? s : orient3d(a, b, c, d);
}

/// A cell in conflict with `p`: the tet that holds it, or the ghost at the facet where the walk left the hull.
uint32_t locate(const Kernel& k, const Vec3& p) {
    uint32_t t = k.last;
    std::size_t entered = 4;
    while (!is_ghost(k.cells[t])) {
        const Cell& c = k.cells[t];
        const auto beyond = [&](std::size_t corner) {
            const auto& o = others[corner];
            const auto at = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[o[i]]].at; };
            return side_of(p, at(0), at(1), at(2)) < 0;
        };
        std::size_t exit = 0;
        while (exit < 4 && (exit == entered || !beyond(exit))) ++exit;
        if (exit == 4) return t;
        entered = c.across[exit] & 3;
        t = c.across[exit] >> 2;
    }
    return t;
}

/// Whether the sphere of a finite cell holds `p`, exact and never undecided.
[[gnu::noinline]] bool holds_exactly(const Kernel& k, const Cell& c, const Site& p) {
    const auto site = [&](std::size_t i) -> const Site& { return k.sites[c.vertex[i]]; };
    return insphere_perturbed({&site(0).at, &site(1).at, &site(2).at, &site(3).at, &p.at},
                              {site(0).rank, site(1).rank, site(2).rank, site(3).rank, p.rank}) > 0;
}

[[gnu::noinline]] bool ghost_in_conflict(const Kernel& k, const Cell& c, const Site& p) {
    const auto at = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[i]].at; };
    const int side = side_of(at(0), at(1), at(2), p.at);
    return side != 0 ? side > 0 : holds_exactly(k, k.cells[c.across[3] >> 2], p);
}

bool in_conflict(const Kernel& k, const Cell& c, const Site& p) {
    if (is_ghost(c)) return ghost_in_conflict(k, c, p);
    const auto at = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[i]].at; };
    const int s = filter::insphere(at(0), at(1), at(2), at(3), p.at);
    return s != 0 ? s > 0 : holds_exactly(k, c, p);
}

/// Looks across a facet of a cell in the cavity: the cell there joins the cavity, or the facet the rim. Which of them
/// is a toss-up, so there is no branch for it.
inline void look_across(Kernel& k, const Cell& c, std::size_t corner, const Site& p) {
    const uint32_t across = c.across[corner], t = across >> 2;
    if (k.mark[t] == Mark::inside) return;
    bool conflict = false;
    if (k.mark[t] == Mark::unseen) {
        const Cell& there = k.cells[t];  // if in conflict, the cells behind are asked for soon
        for (const std::size_t i : others[across & 3]) __builtin_prefetch(&k.cells[there.across[i] >> 2]);
        conflict = in_conflict(k, there, p);
        k.mark[t] = static_cast<Mark>(2 - conflict);
    }
    const auto& o = others[corner];
    k.cavity.push_if(conflict, across);
    k.rim.push_if(!conflict, {c.vertex[o[0]], c.vertex[o[1]], c.vertex[o[2]], across});
}

/// Finds the cavity of `p` from one of its cells, and the rim.
void dig(Kernel& k, uint32_t start, const Site& p) {
    k.cavity.size = k.rim.size = 0;
    k.cavity.push(4 * start);
    k.mark[start] = Mark::inside;
    k.cavity.make_room(1);
    k.rim.make_room(1);
    look_across(k, k.cells[start], 0, p);  // from the others, where the search came from need not be looked at
    for (std::size_t i = 0; i < k.cavity.size; ++i) {
        k.cavity.make_room(3);
        k.rim.make_room(3);
        const Cell& c = k.cells[k.cavity[i] >> 2];
        for (const std::size_t corner : others[k.cavity[i] & 3]) look_across(k, c, corner, p);
    }
}

/// Gives the vertices of the rim local numbers 0, 1, ...
void number_rim(Kernel& k) {
    k.rim_vertices.size = 0;
    k.rim_vertices.make_room(3 * k.rim.size);
    const auto number = [&](uint32_t v) {
        uint32_t& local = k.sites[v].local;
        const bool first_seen = local == none;
        local = first_seen ? static_cast<uint32_t>(k.rim_vertices.size) : local;
        k.rim_vertices.push_if(first_seen, v);
    };
    for (std::size_t i = 0; i < k.rim.size; ++i) {
        number(k.rim[i].a);
        number(k.rim[i].b);
        number(k.rim[i].c);
    }
}

/// Finds as many free slots as the rim has facets: first those of the removed cells.
void take_slots(Kernel& k) {
    k.slots.clear();
    for (std::size_t i = 0; i < k.cavity.size; ++i) {
        const uint32_t t = k.cavity[i] >> 2;
        k.mark[t] = Mark::unseen;
        (i < k.rim.size ? k.slots : k.free_cells).push_back(t);
    }
    while (k.slots.size() < k.rim.size && !k.free_cells.empty()) {
        k.slots.push_back(k.free_cells.back());
        k.free_cells.pop_back();
    }
    while (k.slots.size() < k.rim.size) {
        k.slots.push_back(static_cast<uint32_t>(k.cells.size()));
        k.cells.emplace_back();
        k.mark.push_back(Mark::unseen);
    }
}

/// Joins the new cells to each other: each edge of the rim is seen by two of them, in opposite directions.
void join_by_table(Kernel& k) {
    const auto local = [&](uint32_t v) { return std::size_t{k.sites[v].local}; };
    for (std::size_t i = 0; i < k.rim.size; ++i) {
        const std::size_t a = local(k.rim[i].a), b = local(k.rim[i].b), c = local(k.rim[i].c);
        const uint32_t facet = 4 * k.slots[i];
        k.facet_at_edge[b * table_side + c] = facet + 1;
        k.facet_at_edge[c * table_side + a] = facet + 2;
        k.facet_at_edge[a * table_side + b] = facet + 3;
    }
    for (std::size_t i = 0; i < k.rim.size; ++i) {
        const std::size_t a = local(k.rim[i].a), b = local(k.rim[i].b), c = local(k.rim[i].c);
        auto& across = k.cells[k.slots[i]].across;
        across[1] = k.facet_at_edge[c * table_side + b];
        across[2] = k.facet_at_edge[a * table_side + c];
        across[3] = k.facet_at_edge[b * table_side + a];
    }
}

void join_by_sorting(Kernel& k) {
    k.rim_edges.clear();
    const auto add = [&](uint32_t v, uint32_t w, uint32_t facet) {
        k.rim_edges.push_back({std::min(v, w), std::max(v, w), facet});
    };
    for (std::size_t i = 0; i < k.rim.size; ++i) {
        const RimFacet& f = k.rim[i];
        add(f.b, f.c, 4 * k.slots[i] + 1);
        add(f.c, f.a, 4 * k.slots[i] + 2);
        add(f.a, f.b, 4 * k.slots[i] + 3);
    }
    std::ranges::sort(k.rim_edges, {}, [](const RimEdge& e) { return std::uint64_t{e.low} << 32 | e.high; });
    for (std::size_t i = 0; i < k.rim_edges.size(); i += 2) {
        const uint32_t f = k.rim_edges[i].facet, g = k.rim_edges[i + 1].facet;
        k.cells[f >> 2].across[f & 3] = g;
        k.cells[g >> 2].across[g & 3] = f;
    }
}

/// Replaces the cavity by the tets of site `p` and the facets of the rim.
void fill(Kernel& k, uint32_t p) {
    number_rim(k);
    take_slots(k);
    for (std::size_t i = 0; i < k.rim.size; ++i) {
        const RimFacet& f = k.rim[i];
        const uint32_t t = k.slots[i];
        k.cells[t] = {{p, f.a, f.b, f.c}, {f.outside, none, none, none}};
        k.cells[f.outside >> 2].across[f.outside & 3] = 4 * t;
        k.mark[f.outside >> 2] = Mark::unseen;
        if (f.c != ghost) k.last = t;
    }
    if (k.rim_vertices.size <= table_side) join_by_table(k);
    else join_by_sorting(k);
    for (std::size_t i = 0; i < k.rim_vertices.size; ++i) k.sites[k.rim_vertices[i]].local = none;
}

/// Brings four points that are not coplanar, positively oriented, to the front of the order, the others unchanged
/// behind them. Returns false if there are none.
bool bring_tet_to_front(std::span<const Vec3> points, std::vector<Vertex>& order) {
    const auto at = [&](std::size_t i) -> const Vec3& { return points[static_cast<std::size_t>(order[i].value)]; };
    const auto collinear = [&](const Vec3& a, const Vec3& b, const Vec3& c) {  // if the projections on all planes are
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
    while (third < order.size() && collinear(at(0), at(1), at(third))) ++third;
    if (third == order.size()) return false;
    bring(third, 2);
    std::size_t fourth = 3;
    while (fourth < order.size() && orient3d(at(0), at(1), at(2), at(fourth)) == 0) ++fourth;
    if (fourth == order.size()) return false;
    bring(fourth, 3);
    if (orient3d(at(0), at(1), at(2), at(3)) < 0) std::swap(order[0], order[1]);
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
            if (f != g && opposite(f >> 2, f & 3) == opposite(g >> 2, g & 3)) k.cells[f >> 2].across[f & 3] = g;
    k.mark.assign(k.cells.size(), Mark::unseen);
}

/// The finite cells, by the points' indices.
Triangulation finite_part(const Kernel& k) {
    constexpr uint32_t left_out = none;
    std::vector<uint32_t> name(k.cells.size(), 0);
    for (const uint32_t t : k.free_cells) name[t] = left_out;
    uint32_t count = 0;
    for (std::size_t t = 0; t < name.size(); ++t)
        name[t] = name[t] == left_out || is_ghost(k.cells[t]) ? left_out : count++;
    Triangulation result;
    result.tets.reserve(count);
    result.neighbour.reserve(count);
    for (std::size_t t = 0; t < name.size(); ++t) {
        if (name[t] == left_out) continue;
        std::array<Vertex, 4> vertices;
        std::array<Tet, 4> neighbours;
        for (std::size_t i = 0; i < 4; ++i) {
            vertices[i] = Vertex(k.sites[k.cells[t].vertex[i]].rank);
            const uint32_t across = name[k.cells[t].across[i] >> 2];
            if (across != left_out) neighbours[i] = Tet(std::size_t{across});
        }
        result.tets.push_back(vertices);
        result.neighbour.push_back(neighbours);
    }
    return result;
}

}  // namespace

Triangulation triangulate_in_order(std::span<const Vec3> points, std::span<const Vertex> order) {
    std::vector<Vertex> sequence(order.begin(), order.end());
    if (!bring_tet_to_front(points, sequence)) return {};
    Kernel k;
    k.sites.reserve(sequence.size() + 1);
    k.sites.push_back({});
    for (const Vertex v : sequence) k.sites.push_back({points[static_cast<std::size_t>(v.value)], v.value});
    const std::size_t cells = 7 * sequence.size() + 100;  // 6.77 n for points at random in space, and the ghosts
    k.cells.reserve(cells);
    k.mark.reserve(cells);
    start(k);
    for (uint32_t p = 5; p < k.sites.size(); ++p) {
        dig(k, locate(k, k.sites[p].at), k.sites[p]);
        fill(k, p);
    }
    return finite_part(k);
}

Triangulation triangulate(std::span<const Vec3> points) {
    SpatialOrder spatial = hilbert_order(points);
    Triangulation result = triangulate_in_order(points, in_random_rounds(spatial.order));
    result.same_as = std::move(spatial.same_as);
    return result;
}

}  // namespace kropla
