#include "transfer/transfer.h"

#include "mesh/topology.h"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>

namespace kropla {
namespace {

/// A tet of the old mesh in the region of the new cell, near it.
Tet old_tet_near(const TransferPlan& plan, std::size_t come) {
    std::int32_t nearest = -1;
    double most = -1;
    for (const CellShare& share : plan.overlaps.cell(come))
        if (share.share > most) {
            most = share.share;
            nearest = share.gone;
        }
    return nearest < 0 ? Tet{} : plan.changed.gone[static_cast<std::size_t>(nearest)];
}

/// Vertices of changed cells that are not free and do not stand where they stood.
std::vector<GivenVertex> given_vertices(const TransferPlan& plan, const Watch* watch) {
    std::vector<GivenVertex> given;
    for (const MassBlock& block : plan.blocks)
        for (const MassCell& cell : block.cells) {
            if (cell.come < 0) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const Vertex v = plan.after->tets[cell.tet][k];
                if (cell.unknown[k] >= 0 || same_vertex(*plan.before, *plan.after, v)) continue;
                const Tet start = old_tet_near(plan, static_cast<std::size_t>(cell.come));
                if (!start.exists()) continue;
                heed(watch);  // a walk may end in a search
                const Location found = locate(*plan.before, plan.after->position[v], start);
                given.push_back({v, plan.before->tets[found.tet], found.weights});
            }
        }
    std::ranges::stable_sort(given, {}, &GivenVertex::vertex);
    const auto repeated = std::ranges::unique(given, {}, &GivenVertex::vertex);
    given.erase(repeated.begin(), repeated.end());
    return given;
}

/// Clusters without a free vertex grow until they have one, or fill their region.
void grow_where_nothing_is_free(TransferPlan& plan, const Watch* watch) {
    for (std::size_t c = 0; c < plan.clusters.count(); ++c)
        while (!plan.clusters.has_free_vertex(*plan.after, plan.clusters.now(c))) {
            heed(watch);
            if (!plan.clusters.grow(*plan.after, plan.clusters.now(c))) break;
        }
}

TransferPlan plan_of(const Mesh& before, const Mesh& after, ChangedCells changed, const Watch* watch) {
    heed(watch);
    TransferPlan plan;
    plan.before = &before;
    plan.after = &after;
    plan.changed = std::move(changed);
    tbb::parallel_invoke([&] { plan.overlaps = overlaps(before, after, plan.changed, watch); },
                         [&] {
                             plan.clusters = Clusters(after, plan.changed);
                             grow_where_nothing_is_free(plan, watch);
                         });
    plan.clusters.share_out(plan.changed, plan.overlaps);
    const SlotMap come = places_of(plan.changed.come);
    plan.blocks.resize(plan.clusters.count());
    tbb::parallel_for(std::size_t{0}, plan.blocks.size(), [&](std::size_t c) {
        heed(watch);
        plan.blocks[c] = mass_block(before, after, plan.changed, come, plan.clusters, c);
    });
    plan.given = given_vertices(plan, watch);
    for (const MassBlock& block : plan.blocks) plan.cells += block.cells.size();
    return plan;
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
