#include "transfer/geometry.h"

#include <kropla/mesh/topology.h>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace kropla {
namespace {

/// A tet of the old mesh in the region of the new cell, near it.
Tet old_tet_near(const TransferGeometry& geometry, std::size_t come) {
    std::int32_t nearest = -1;
    double most = -1;
    for (const CellShare& share : geometry.overlaps.cell(come))
        if (share.share > most) {
            most = share.share;
            nearest = share.gone;
        }
    return nearest < 0 ? Tet{} : geometry.changed.gone[static_cast<std::size_t>(nearest)];
}

/// Vertices of changed cells that are not free and do not stand where they stood.
std::vector<GivenVertex> given_vertices(const TransferGeometry& geometry, const Mesh& before, const Mesh& after,
                                        const Watch* watch) {
    std::vector<GivenVertex> given;
    for (const MassBlock& block : geometry.blocks)
        for (const MassCell& cell : block.cells) {
            if (cell.come < 0) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const Vertex v = after.tets[cell.tet][k];
                if (cell.unknown[k] >= 0 || same_vertex(before, after, v)) continue;
                const Tet start = old_tet_near(geometry, static_cast<std::size_t>(cell.come));
                if (!start.exists()) continue;
                heed(watch);  // a walk may end in a search
                const Location found = locate(before, after.position[v], start);
                given.push_back({v, before.tets[found.tet], found.weights});
            }
        }
    std::ranges::stable_sort(given, {}, &GivenVertex::vertex);
    const auto is_same = [](const GivenVertex& a, const GivenVertex& b) { return a.vertex == b.vertex; };
    given.erase(std::unique(given.begin(), given.end(), is_same), given.end());
    return given;
}

/// Clusters without a free vertex grow until they have one, or fill their region.
void grow_where_nothing_is_free(Clusters& clusters, const Mesh& after, const Watch* watch) {
    for (std::size_t c = 0; c < clusters.count(); ++c)
        while (!clusters.has_free_vertex(after, clusters.now(c))) {
            heed(watch);
            if (!clusters.grow(after, clusters.now(c))) break;
        }
}

TransferPlan plan_of(const Mesh& before, const Mesh& after, ChangedCells changed, const Watch* watch) {
    heed(watch);
    auto planned = std::make_shared<TransferGeometry>();
    TransferGeometry& geometry = *planned;
    geometry.changed = std::move(changed);
    tbb::parallel_invoke([&] { geometry.overlaps = overlaps(before, after, geometry.changed, watch); },
                         [&] {
                             geometry.clusters = Clusters(after, geometry.changed);
                             grow_where_nothing_is_free(geometry.clusters, after, watch);
                         });
    geometry.clusters.share_out(geometry.changed, geometry.overlaps);
    const SlotMap come = places_of(geometry.changed.come);
    geometry.blocks.resize(geometry.clusters.count());
    tbb::parallel_for(std::size_t{0}, geometry.blocks.size(), [&](std::size_t c) {
        heed(watch);
        geometry.blocks[c] = mass_block(before, after, geometry.changed, come, geometry.clusters, c);
    });
    geometry.given = given_vertices(geometry, before, after, watch);
    std::size_t cells = 0;
    for (const MassBlock& block : geometry.blocks) cells += block.cells.size();
    return {&before, &after, cells, std::move(planned)};
}

}  // namespace

TransferPlan plan_transfer(const Mesh& before, const Mesh& after, std::span<const Tet> cells,
                           std::span<const Vertex> vertices, const Watch* watch) {
    return plan_of(before, after, changed_cells(before, after, cells, vertices), watch);
}

TransferPlan plan_transfer(const Mesh& before, const Mesh& after, const Watch* watch) {
    const auto slots = std::max(before.tets.size(), after.tets.size());
    std::vector<Tet> all;
    for (std::size_t i = 0; i < slots; ++i) all.push_back(Tet(i));
    return plan_of(before, after, changed_cells(before, after, all, {}), watch);
}

}  // namespace kropla
