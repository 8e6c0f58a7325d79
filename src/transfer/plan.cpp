#include "transfer/geometry.h"
#include "transfer/on_interface.h"

#include <kropla/mesh/topology.h>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <algorithm>
#include <memory>
#include <utility>

namespace kropla {
namespace {

/// Vertices of changed cells that are not free and do not stand where they stood.
std::vector<GivenVertex> given_vertices(const TransferGeometry& geometry, const Mesh& before, const Mesh& after) {
    std::vector<Vertex> vertices;
    for (const MassBlock& block : geometry.blocks)
        for (const MassCell& cell : block.cells)
            for (std::size_t k = 0; k < 4; ++k)
                if (const Vertex v = after.tets[cell.tet][k];
                    cell.come >= 0 && cell.unknown[k] < 0 && !same_vertex(before, after, v))
                    vertices.push_back(v);
    if (vertices.empty() || geometry.changed.gone.empty()) return {};
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::vector<Vec3> places;
    for (Vertex v : vertices) places.push_back(after.position[v]);
    // What is told of an interface is told by the old one, wherever the new one lies beside it: as volumes are kept on both
    // sides, so are then, but for the second power of the distance, the integrals of what changes steeply there.
    const std::vector<Location> on_old = nearest_on_interface(before, geometry.changed, places);
    const std::vector<Location> in_old = locate_in_gone(before, geometry.changed, places);
    std::vector<GivenVertex> given;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const bool stands_on = on_old[i].tet.exists() && constraint(after, vertices[i], ball(after, vertices[i])).on_interface;
        const Location& found = stands_on ? on_old[i] : in_old[i];
        given.push_back({vertices[i], before.tets[found.tet], found.weights});
    }
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
    geometry.given = given_vertices(geometry, before, after);
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
