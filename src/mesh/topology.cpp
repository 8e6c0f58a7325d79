#include <kropla/mesh/topology.h>

#include <algorithm>
#include <cassert>

namespace kropla {
namespace {

/// The two corners of `t` that are neither `a` nor `b`, as vertices (c, d) with det(b-a, c-a, d-a) > 0.
std::array<Vertex, 2> opposite_edge(const Mesh& mesh, Tet t, Vertex a, Vertex b) {
    // per ordered pair of corners (i, j), the others in the order that keeps the orientation
    static constexpr int others[4][4][2] = {{{-1, -1}, {2, 3}, {3, 1}, {1, 2}},
                                            {{3, 2}, {-1, -1}, {0, 3}, {2, 0}},
                                            {{1, 3}, {3, 0}, {-1, -1}, {0, 1}},
                                            {{2, 1}, {0, 2}, {1, 0}, {-1, -1}}};
    const auto& o = others[corner_of(mesh, t, a)][corner_of(mesh, t, b)];
    return {mesh.tets[t][as_size(o[0])], mesh.tets[t][as_size(o[1])]};
}

/// Walks around the edge from `start` across the facet opposite `leaving`, until the boundary or `start`
/// again. Calls `visit(t, v)` for each further tet; `v` is the vertex of it that the last tet did not have.
template <class Visit>
bool walk_round(const Mesh& mesh, Edge e, Tet start, Vertex leaving, Vertex staying, Visit visit) {
    Tet t = start;
    for (;;) {
        const Tet next = mesh.neighbour[t][as_size(corner_of(mesh, t, leaving))];
        if (!next.exists()) return false;
        if (next == start) return true;
        const auto [c, d] = opposite_edge(mesh, next, e.a, e.b);
        const Vertex entered = staying;
        staying = c == entered ? d : c;
        leaving = entered;
        visit(next, staying);
        t = next;
    }
}

}  // namespace

int corner_of(const Mesh& mesh, Tet t, Vertex v) {
    const auto& c = mesh.tets[t];
    return c[0] == v ? 0 : c[1] == v ? 1 : c[2] == v ? 2 : c[3] == v ? 3 : -1;
}

std::array<Vertex, 3> facet_vertices(const Mesh& mesh, Facet f) { return facet_vertices(mesh.tets[f.tet], f.corner); }

int mirror_corner(const Mesh& mesh, Facet f) {
    const auto& across = mesh.neighbour[mesh.neighbour[f.tet][as_size(f.corner)]];
    return across[0] == f.tet ? 0 : across[1] == f.tet ? 1 : across[2] == f.tet ? 2 : 3;
}

std::vector<Tet> all_tets(const Mesh& mesh, Region only) {
    std::vector<Tet> tets;
    tets.reserve(mesh.tets.size());
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t) && (!only.exists() || mesh.region[t] == only)) tets.push_back(t);
    return tets;
}

namespace {

/// The tets of a list that grows, to be found again: a small table, past whose room the list is looked through.
class Seen {
public:
    explicit Seen(const std::vector<Tet>& list) : list_(list) { slots_.fill(Tet{}); }

    /// Whether `t` is not in the list yet; it is about to be.
    bool add(Tet t) {
        if (list_.size() >= room) return std::ranges::find(list_, t) == list_.end();
        std::size_t slot = as_size(t.value) % slots_.size();
        for (; slots_[slot].exists(); slot = (slot + 1) % slots_.size())
            if (slots_[slot] == t) return false;
        slots_[slot] = t;
        return true;
    }

private:
    static constexpr std::size_t room = 64;
    const std::vector<Tet>& list_;
    std::array<Tet, 2 * room> slots_;
};

}  // namespace

void ball(const Mesh& mesh, Vertex v, std::vector<Tet>& tets) {
    tets.clear();
    if (!mesh.tet_at[v].exists()) return;
    Seen seen(tets);
    seen.add(mesh.tet_at[v]);
    tets.push_back(mesh.tet_at[v]);
    for (std::size_t i = 0; i < tets.size(); ++i) {
        const Tet t = tets[i];
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (n.exists() && mesh.tets[t][as_size(corner)] != v && seen.add(n)) tets.push_back(n);
        }
    }
}

std::vector<Tet> ball(const Mesh& mesh, Vertex v) {
    std::vector<Tet> tets;
    ball(mesh, v, tets);
    return tets;
}

std::vector<Facet> link(const Mesh& mesh, Vertex v) {
    std::vector<Facet> facets;
    for (Tet t : ball(mesh, v)) facets.push_back({t, corner_of(mesh, t, v)});
    return facets;
}

std::vector<Vertex> adjacent_vertices(const Mesh& mesh, Vertex v) {
    std::vector<Vertex> vertices;
    for (Tet t : ball(mesh, v))
        for (Vertex w : mesh.tets[t])
            if (w != v) vertices.push_back(w);
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

void shell(const Mesh& mesh, Edge e, Tet t, Shell& s) {
    const auto [c, d] = opposite_edge(mesh, t, e.a, e.b);
    s.tets.assign({t});
    s.ring.assign({c, d});
    s.closed = walk_round(mesh, e, t, c, d, [&](Tet next, Vertex staying) {
        s.tets.push_back(next);
        s.ring.push_back(staying);
    });
    if (s.closed) {
        s.ring.pop_back();  // the walk came back to c
        return;
    }
    const auto seen = static_cast<std::ptrdiff_t>(s.tets.size());
    walk_round(mesh, e, t, d, c, [&](Tet next, Vertex staying) {
        s.tets.push_back(next);
        s.ring.push_back(staying);
    });
    // The tets found last, backwards, come before the first.
    std::ranges::reverse(s.tets.begin() + seen, s.tets.end());
    std::rotate(s.tets.begin(), s.tets.begin() + seen, s.tets.end());
    std::ranges::reverse(s.ring.begin() + seen + 1, s.ring.end());
    std::rotate(s.ring.begin(), s.ring.begin() + seen + 1, s.ring.end());
}

Shell shell(const Mesh& mesh, Edge e, Tet t) {
    Shell s;
    shell(mesh, e, t, s);
    return s;
}

std::optional<Shell> shell(const Mesh& mesh, Edge e) {
    for (Tet t : ball(mesh, e.a))
        if (corner_of(mesh, t, e.b) >= 0) return shell(mesh, e, t);
    return std::nullopt;
}

Constraint constraint(const Mesh& mesh, Vertex v, std::span<const Tet> ball) {
    Constraint c;
    for (Tet t : ball) {
        c.on_interface |= mesh.region[t] != mesh.region[ball.front()];
        for (int i = 0; i < 4; ++i) {
            const Patch p = mesh.patch[t][as_size(i)];
            if (p.exists() && mesh.tets[t][as_size(i)] != v) c.patches |= 1u << p.value;
        }
    }
    return c;
}

Constraint constraint(const Mesh& mesh, const Shell& shell) {
    Constraint c;
    for (Tet t : shell.tets) c.on_interface |= mesh.region[t] != mesh.region[shell.tets.front()];
    if (shell.closed) return c;
    // The two facets where the shell ends are the only ones of the boundary that hold the edge.
    const Tet first = shell.tets.front(), last = shell.tets.back();
    const Vertex after_first = shell.ring[1], before_last = shell.ring[shell.ring.size() - 2];
    c.patches |= 1u << mesh.patch[first][as_size(corner_of(mesh, first, after_first))].value;
    c.patches |= 1u << mesh.patch[last][as_size(corner_of(mesh, last, before_last))].value;
    return c;
}

}  // namespace kropla
