#include "adapt/propose.h"

#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace kropla {
namespace {

/// How often a facet stands in the cells removed and added, and whether it has a patch where it is on the boundary.
struct Uses {
    int removed = 0, added = 0;
    bool bounds_removed = false, bounds_added = false;
};

using FacetUses = std::map<std::array<Vertex, 3>, Uses>;

FacetUses facet_uses(const Mesh& mesh, const Cavity& cavity) {
    FacetUses uses;
    const auto of = [&](const std::array<Vertex, 4>& v, int corner) -> Uses& {
        auto facet = facet_vertices(v, corner);
        std::ranges::sort(facet);
        return uses[facet];
    };
    for (int corner = 0; corner < 4; ++corner) {
        for (Tet t : cavity.removed) {
            Uses& facet = of(mesh.tets[t], corner);
            ++facet.removed;
            facet.bounds_removed |= !mesh.neighbour[t][as_size(corner)].exists();
        }
        for (const NewTet& t : cavity.added) {
            Uses& facet = of(t.vertices, corner);
            ++facet.added;
            facet.bounds_added |= t.patch[as_size(corner)].exists();
        }
    }
    return uses;
}

bool closes(const Uses& facet) {
    if (facet.removed == 1) return facet.added == 1 || (facet.added == 0 && facet.bounds_removed);
    return facet.added == 0 || facet.added == 2 || (facet.added == 1 && facet.bounds_added);
}

/// Has a cell that is not removed all of these vertices?
bool stands_elsewhere(const Mesh& mesh, std::span<const Vertex> vertices, const std::set<Tet>& removed) {
    const auto is_known = [&](Vertex v) { return v.exists() && alive(mesh, v); };
    if (!std::ranges::all_of(vertices, is_known)) return false;
    const auto around = ball(mesh, vertices.front());
    return std::ranges::any_of(around, [&](Tet t) {
        return !removed.contains(t) &&
               std::ranges::all_of(vertices, [&](Vertex v) { return corner_of(mesh, t, v) >= 0; });
    });
}

}  // namespace

std::optional<Cavity> best_swap(const Mesh& mesh, Tet t, std::span<const std::size_t> edges, bool facets, double bound) {
    std::optional<Cavity> best;
    Shell around;
    const auto keep_better = [&](std::optional<Cavity> cavity) {
        if (!cavity || cavity->worst_after >= bound) return;
        bound = cavity->worst_after;
        best = std::move(cavity);
    };
    for (std::size_t k : edges) {
        const Edge edge = tet_edge(mesh, t, k);
        shell(mesh, edge, t, around);
        keep_better(edge_removal(mesh, around, edge, {false, bound}));
    }
    for (int i = 0; facets && i < 4; ++i) keep_better(face_removal(mesh, {t, i}, {false, bound}));
    return best;
}

bool is_worse(const Mesh& mesh, Tet t, double than) { return alive(mesh, t) && aspect_ratio(mesh, t) > than; }

int count_worse(const Mesh& mesh, std::span<const Tet> cells, double than) {
    return static_cast<int>(std::ranges::count_if(cells, [&](Tet t) { return is_worse(mesh, t, than); }));
}

bool is_tangled(const Mesh& mesh, std::span<const Tet> cells) {
    return std::ranges::any_of(cells, [&](Tet t) { return alive(mesh, t) && !std::isfinite(aspect_ratio(mesh, t)); });
}

bool fits(const Mesh& mesh, const Cavity& cavity) {
    const std::set<Tet> removed(cavity.removed.begin(), cavity.removed.end());
    std::set<std::array<Vertex, 2>> edges;  // of the cells removed
    const auto edges_of = [](const std::array<Vertex, 3>& f) {
        return std::array{std::array{f[0], f[1]}, std::array{f[0], f[2]}, std::array{f[1], f[2]}};
    };
    const auto uses = facet_uses(mesh, cavity);
    for (const auto& [facet, use] : uses) {
        if (!closes(use)) return false;
        if (use.removed > 0)
            for (const auto& edge : edges_of(facet)) edges.insert(edge);
    }
    for (const auto& [facet, use] : uses) {
        if (use.removed > 0) continue;
        if (stands_elsewhere(mesh, facet, removed)) return false;
        for (const auto& edge : edges_of(facet))
            if (!edges.contains(edge) && stands_elsewhere(mesh, edge, removed)) return false;
    }
    return !cavity.added.empty();
}

}  // namespace kropla
