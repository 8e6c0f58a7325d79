// One step of incremental Delaunay triangulation, after
//   [Bowyer 1981], [Watson 1981]: a new point replaces the tets whose spheres hold it, the cavity;
//   [Amenta, Choi, Rote 2003]: the order of insertion, so that each point is near the one before;
//   [Devillers, Pion, Teillaud 2002]: the visibility walk, which ends in any Delaunay triangulation;
//   [Marot, Pellerin, Remacle 2019]: flat arrays, vertices copied in order of insertion, a small table to
//   join tets.
// Ours: the ties are broken by raising the lifts only (predicates.h). Orientations stay exact, and a ghost
// tet, whose facet on the hull is coplanar with the point, is in conflict if the finite tet behind that facet
// is: their spheres meet the plane in the same circle, so that all tets at it agree. Hence no flat tet is
// ever made.

#include "generate/delaunay_kernel.h"

#include <kropla/base/predicates.h>
#include "base/predicates_filter.h"

#include <algorithm>
#include <stdexcept>

namespace kropla::delaunay {

namespace {

int side_of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int s = filter::orient3d(a, b, c, d);
    return s != 0 ? s : orient3d(a, b, c, d);
}

/// A cell in conflict with `p`: the tet that holds it, or the ghost at the facet where the walk left the
/// hull. No cell is met twice [Edelsbrunner 1990, "An acyclicity theorem for cell complexes in d dimension"], unless the
/// predicates are wrong.
uint32_t locate(const Kernel& k, const Vec3& p) {
    uint32_t t = k.last;
    std::size_t entered = 4, left = k.cells.size();
    while (!is_ghost(k.cells[t])) {
        if (left-- == 0) throw std::invalid_argument("coordinates are too small or too large for the predicates (base/predicates.h)");
        const Cell& c = k.cells[t];
        const auto beyond = [&](std::size_t corner) {
            const auto& o = others[corner];
            const auto place = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[o[i]]].at; };
            return side_of(p, place(0), place(1), place(2)) < 0;
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
    const auto place = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[i]].at; };
    const int side = side_of(place(0), place(1), place(2), p.at);
    return side != 0 ? side > 0 : holds_exactly(k, k.cells[c.across[3] >> 2], p);
}

bool in_conflict(const Kernel& k, const Cell& c, const Site& p) {
    if (is_ghost(c)) return ghost_in_conflict(k, c, p);
    const auto place = [&](std::size_t i) -> const Vec3& { return k.sites[c.vertex[i]].at; };
    const int s = filter::insphere(place(0), place(1), place(2), place(3), p.at);
    return s != 0 ? s > 0 : holds_exactly(k, c, p);
}

/// Looks across a facet of a cell in the cavity: the cell there joins the cavity, or the facet the rim. Which
/// of them is a toss-up, so there is no branch for it.
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
    look_across(k, k.cells[start], 0, p);  // elsewhere this facet leads back and need not be looked across
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

}  // namespace

void insert(Kernel& k, uint32_t site) {
    dig(k, locate(k, k.sites[site].at), k.sites[site]);
    fill(k, site);
}

}  // namespace kropla::delaunay
