#include "transfer/cluster.h"

#include <kropla/mesh/topology.h>

#include <algorithm>

namespace kropla {
namespace {

/// The facets across which the cluster's region goes on without it.
std::vector<Facet> rim(const Mesh& after, const Clusters& clusters, std::size_t cluster) {
    std::vector<Facet> facets;
    for (Tet t : clusters.cells(cluster))
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = after.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n.exists() || after.region[n] != after.region[t]) continue;
            if (clusters.cluster_of(n) != static_cast<std::int32_t>(cluster)) facets.push_back({t, corner});
        }
    return facets;
}

/// Their vertices, each once.
std::vector<Vertex> vertices_of(const Mesh& after, std::span<const Facet> facets) {
    std::vector<Vertex> vertices;
    for (const Facet facet : facets)
        for (Vertex v : facet_vertices(after, facet)) vertices.push_back(v);
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

}  // namespace

Clusters::Clusters(const Mesh& after, const ChangedCells& changed) : owner_(2 * changed.come.size()) {
    constexpr std::int32_t not_yet = 1 << 30;
    for (Tet t : changed.come) owner_.insert(t.value, not_yet);
    for (Tet seed : changed.come) {
        if (owner_.find(seed.value) != not_yet) continue;
        const auto number = static_cast<std::int32_t>(cells_.size());
        std::vector<Tet> cells{seed};
        owner_.assign(seed.value, number);
        for (std::size_t i = 0; i < cells.size(); ++i)
            for (Tet n : after.neighbour[cells[i]]) {
                if (!n.exists() || owner_.find(n.value) != not_yet || after.region[n] != after.region[seed])
                    continue;
                owner_.assign(n.value, number);
                cells.push_back(n);
            }
        cells_.push_back(std::move(cells));
        taken_by_.push_back(number);
    }
    gone_.resize(cells_.size());
    has_free_.assign(cells_.size(), false);
}

void Clusters::share_out(const ChangedCells& changed, const Overlaps& overlaps) {
    std::vector<std::pair<double, std::int32_t>> most(changed.gone.size(), {0, -1});  // share, cluster
    for (std::size_t i = 0; i < changed.come.size(); ++i)
        for (const CellShare& share : overlaps.cell(i)) {
            auto& [largest, cluster] = most[static_cast<std::size_t>(share.gone)];
            if (share.share <= largest) continue;
            largest = share.share;
            cluster = cluster_of(changed.come[i]);
        }
    for (std::size_t i = 0; i < most.size(); ++i)
        if (most[i].second >= 0)
            gone_[static_cast<std::size_t>(most[i].second)].push_back(static_cast<std::int32_t>(i));
}

SlotMap held_vertices(const Mesh& after, const Clusters& clusters, std::size_t cluster) {
    const auto cells = clusters.cells(cluster);
    SlotMap held(cells.size() / 2);
    for (Tet t : cells)
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = after.neighbour[t][static_cast<std::size_t>(corner)];
            const bool ends = n.exists()
                                  ? clusters.cluster_of(n) != static_cast<std::int32_t>(cluster)
                                  : after.patch[t][static_cast<std::size_t>(corner)].value >= box_faces;
            if (!ends) continue;
            for (Vertex v : facet_vertices(after, {t, corner})) held.insert(v.value, 0);
        }
    return held;
}

bool Clusters::has_free_vertex(const Mesh& after, std::size_t cluster) {
    if (has_free_[cluster]) return true;
    const SlotMap held = held_vertices(after, *this, cluster);
    has_free_[cluster] = std::ranges::any_of(cells_[cluster], [&](Tet t) {
        return std::ranges::any_of(
            after.tets[t], [&](Vertex v) { return !held.contains(v.value) && !after.layer_at[v].exists(); });
    });
    return has_free_[cluster];
}

bool Clusters::grow(const Mesh& after, std::size_t cluster) {
    const std::size_t size = cells_[cluster].size();
    std::vector<Tet> tets;
    std::vector<Vertex> shared;
    const std::vector<Facet> facets = rim(after, *this, cluster);
    for (Vertex v : vertices_of(after, facets)) {
        if (after.layer_at[v].exists()) continue;
        ball(after, v, tets);
        const Region region = after.region[tets.front()];
        if (!std::ranges::all_of(tets, [&](Tet t) { return after.region[t] == region; })) continue;
        if (!is_alone(tets, cluster))
            shared.push_back(v);
        else
            for (Tet t : tets) claim(t, cluster);
    }
    if (cells_[cluster].size() > size) return true;
    for (Vertex v : shared) {
        ball(after, v, tets);
        for (Tet t : tets) claim(t, now(cluster));
    }
    if (cells_[now(cluster)].size() > size) return true;
    for (const auto [t, corner] : facets)
        claim(after.neighbour[t][static_cast<std::size_t>(corner)], now(cluster));
    return !facets.empty();
}

bool Clusters::is_alone(std::span<const Tet> ball, std::size_t cluster) const {
    return std::ranges::all_of(ball, [&](Tet t) {
        const std::int32_t of = cluster_of(t);
        return of < 0 || of == static_cast<std::int32_t>(cluster);
    });
}

void Clusters::claim(Tet t, std::size_t cluster) {
    const std::int32_t other = cluster_of(t);
    if (other >= 0) {
        unite(cluster, static_cast<std::size_t>(other));
        return;
    }
    owner_.insert(t.value, static_cast<std::int32_t>(cluster));
    cells_[cluster].push_back(t);
}

void Clusters::unite(std::size_t a, std::size_t b) {
    if (a == b) return;
    if (cells_[a].size() < cells_[b].size()) std::swap(a, b);
    cells_[a].insert(cells_[a].end(), cells_[b].begin(), cells_[b].end());
    gone_[a].insert(gone_[a].end(), gone_[b].begin(), gone_[b].end());
    has_free_[a] = has_free_[a] || has_free_[b];
    cells_[b].clear();
    gone_[b].clear();
    taken_by_[b] = static_cast<std::int32_t>(a);
}

}  // namespace kropla
