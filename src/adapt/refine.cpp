// Splitting and collapsing edges towards the target size. The new vertex of a split goes to the best place inside
// the shell instead of the edge's middle: the shell is a star-shaped polyhedron (star.cpp).

#include "adapt/adapt.h"
#include "adapt/star.h"
#include "base/tetrahedron.h"
#include "mesh/quality.h"

#include <algorithm>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The vertices of `t` with `to` in the place of `from`.
std::array<Vertex, 4> with_replaced(const Mesh& mesh, Tet t, Vertex from, Vertex to) {
    auto v = mesh.tets[t];
    v[at(corner_of(mesh, t, from))] = to;
    return v;
}

double aspect_ratio_of(const Mesh& mesh, const std::array<Vertex, 4>& v) {
    return tet_aspect_ratio(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]);
}

/// A vertex may be pulled along an edge that is held by all that holds the vertex.
bool may_collapse(const Mesh& mesh, Vertex from, Vertex to, std::span<const Tet> around) {
    const Constraint held = constraint(mesh, from, around);
    if (held.free()) return true;
    if (held.rigid()) return false;
    const auto with_edge = std::ranges::find_if(around, [&](Tet t) { return corner_of(mesh, t, to) >= 0; });
    if (with_edge == around.end()) return false;
    return constraint(mesh, shell(mesh, {from, to}, *with_edge)).patches == held.patches;
}

}  // namespace

std::optional<Cavity> edge_collapse(const Mesh& mesh, Vertex from, Vertex to, double worst_allowed) {
    Cavity cavity;
    ball(mesh, from, cavity.removed);
    if (!may_collapse(mesh, from, to, cavity.removed)) return std::nullopt;
    for (Tet t : cavity.removed) {
        if (corner_of(mesh, t, to) >= 0) continue;
        cavity.worst_after = std::max(cavity.worst_after, aspect_ratio_of(mesh, with_replaced(mesh, t, from, to)));
        if (cavity.worst_after > worst_allowed || cavity.worst_after == infinity) return std::nullopt;
    }
    for (Tet t : cavity.removed)
        if (corner_of(mesh, t, to) < 0)
            cavity.added.push_back({with_replaced(mesh, t, from, to), mesh.region[t], mesh.patch[t]});
    cavity.worst_before = worst_aspect_ratio(mesh, cavity.removed);
    return cavity;
}

std::optional<Cavity> edge_split(const Mesh& mesh, const Shell& shell, Edge edge, double worst_allowed) {
    const Constraint held = constraint(mesh, shell);
    if (held.rigid()) return std::nullopt;
    std::vector<StarFacet> star;
    for (Tet t : shell.tets)
        for (Vertex end : {edge.a, edge.b}) {
            const auto [a, b, c] = facet_vertices(mesh, {t, corner_of(mesh, t, end)});
            star.push_back({mesh.position[a], mesh.position[b], mesh.position[c]});
        }
    const Vec3 middle = (mesh.position[edge.a] + mesh.position[edge.b]) / 2;
    const Place place = best_place(star, middle, freedom(held), 0.8 * worst_allowed);
    if (place.worst > worst_allowed) return std::nullopt;

    Cavity cavity;
    cavity.removed = shell.tets;
    cavity.inserted = {place.x};
    const Vertex inserted = next_vertex(mesh);
    for (Tet t : shell.tets)
        for (Vertex end : {edge.a, edge.b})
            cavity.added.push_back({with_replaced(mesh, t, end, inserted), mesh.region[t], mesh.patch[t]});
    cavity.worst_before = worst_aspect_ratio(mesh, shell.tets);
    cavity.worst_after = place.worst;
    return cavity;
}

namespace {

struct SizedEdge {
    Edge edge;
    double ratio;  // of its length to the target size
};

/// Lengths in target sizes; the size is asked once per vertex, as it costs a search for the nearest body.
class EdgeMeasure {
public:
    EdgeMeasure(const Mesh& mesh, const Snapshot& at_time) : mesh_(mesh), at_time_(at_time) {}

    double ratio(Edge e) { return distance(mesh_.position[e.a], mesh_.position[e.b]) / ((size(e.a) + size(e.b)) / 2); }

private:
    double size(Vertex v) {
        if (sizes_.size() < mesh_.position.size()) sizes_.resize(mesh_.position.size(), {});
        auto& known = sizes_[v];
        if (!(known.at == mesh_.position[v]) || known.size == 0)
            known = {mesh_.position[v], target_size(at_time_, mesh_.position[v])};
        return known.size;
    }
    struct Known {
        Vec3 at;
        double size = 0;
    };
    const Mesh& mesh_;
    const Snapshot& at_time_;
    Array<Vertex, Known> sizes_;
};

std::vector<Edge> edges_of(const Mesh& mesh, std::span<const Tet> cells) {
    std::vector<Edge> edges;
    edges.reserve(6 * cells.size());
    for (Tet t : cells) {
        if (!alive(mesh, t)) continue;
        for (const auto& [i, j] : tet_edges) {
            const auto [a, b] = std::minmax(mesh.tets[t][at(i)], mesh.tets[t][at(j)]);
            edges.push_back({a, b});
        }
    }
    std::ranges::sort(edges, {}, [](Edge e) { return std::pair(e.a, e.b); });
    const auto repeated = std::ranges::unique(edges);
    edges.erase(repeated.begin(), repeated.end());
    return edges;
}

bool makes_long_edge(const Cavity& cavity, Vertex to, EdgeMeasure& measure, double longest) {
    for (const NewTet& t : cavity.added)
        for (Vertex v : t.vertices)
            if (v != to && measure.ratio({v, to}) > longest) return true;
    return false;
}

/// The better of the two ways to collapse the edge, if one is allowed.
std::optional<Cavity> collapse_either_way(const Mesh& mesh, Edge e, EdgeMeasure& measure, const AdaptOptions& o) {
    std::optional<Cavity> best;
    for (const auto& [from, to] : {std::pair(e.a, e.b), std::pair(e.b, e.a)}) {
        auto cavity = edge_collapse(mesh, from, to, best ? best->worst_after : infinity);
        if (!cavity || cavity->worst_after > std::max(o.passing, cavity->worst_before)) continue;
        if (makes_long_edge(*cavity, to, measure, 0.95 * o.split_above)) continue;
        best = std::move(cavity);
    }
    return best;
}

std::optional<Cavity> split(const Mesh& mesh, Edge e, const AdaptOptions& o) {
    const auto around = shell(mesh, e);
    if (!around) return std::nullopt;
    return edge_split(mesh, *around, e, std::max(o.passing, worst_aspect_ratio(mesh, around->tets)));
}

void carry_out(Mesh& mesh, const Cavity& cavity, Changes& changes) {
    const auto added = replace_cells(mesh, cavity);
    changes.cells.insert(changes.cells.end(), added.begin(), added.end());
    changes.cells_replaced += static_cast<int>(cavity.removed.size());
    changes.vertices_inserted += static_cast<int>(cavity.inserted.size());
}

}  // namespace

Changes adapt_to_size(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options) {
    Changes changes;
    EdgeMeasure measure(mesh, at_time);
    std::vector<SizedEdge> wrong;
    for (Edge e : edges_of(mesh, cells))
        if (const double r = measure.ratio(e); r > options.split_above || r < options.collapse_below)
            wrong.push_back({e, r});
    // Crowds are thinned before gaps are filled; the shortest and the longest edges come first.
    std::ranges::sort(wrong, {}, [](const SizedEdge& w) {
        return std::tuple(w.ratio > 1, w.ratio > 1 ? -w.ratio : w.ratio, w.edge.a, w.edge.b);
    });

    for (const auto& [edge, found] : wrong) {
        if (!alive(mesh, edge.a) || !alive(mesh, edge.b) || measure.ratio(edge) != found) continue;
        if (found > 1) {
            const auto cavity = split(mesh, edge, options);
            if (!cavity) continue;
            changes.vertices.push_back(next_vertex(mesh));
            carry_out(mesh, *cavity, changes);
            ++changes.splits;
        } else if (shell(mesh, edge)) {
            const auto cavity = collapse_either_way(mesh, edge, measure, options);
            if (!cavity) continue;
            carry_out(mesh, *cavity, changes);
            ++changes.collapses;
        }
    }
    return changes;
}

}  // namespace kropla
