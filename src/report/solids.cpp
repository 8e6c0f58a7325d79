#include "report/solids.h"

#include <kropla/mesh/prisms.h>

#include <algorithm>

namespace kropla {
namespace {

constexpr int none = -1, several = -2;

/// The number of the region in which a vertex is, none for a free slot, or several for one between regions.
Array<Vertex, int> regions_at_vertices(const Mesh& mesh) {
    Array<Vertex, int> region_at(mesh.position.size(), none);
    const auto note = [&](Vertex v, Region region) {
        int& at = region_at[v];
        at = at == none || at == region.value ? region.value : several;
    };
    for (const Tet t : mesh.tets.indices())
        for (std::size_t corner = 0; corner < 4 && alive(mesh, t); ++corner)
            note(mesh.tets[t][corner], mesh.region[t]);
    for (const Prism& prism : all_prisms(mesh))
        for (const Vertex v : prism_vertices(mesh, prism)) note(v, layer_of(mesh, prism.layer).region);
    return region_at;
}

int largest_region(const Mesh& mesh) {
    int most = 0;
    for (const Tet t : mesh.tets.indices())
        if (alive(mesh, t)) most = std::max(most, mesh.region[t].value);
    for (const Prism& prism : all_prisms(mesh))
        most = std::max(most, layer_of(mesh, prism.layer).region.value);
    return most;
}

}  // namespace

std::vector<bool> solid_regions(const Mesh& mesh, const Array<Vertex, double>& pressure) {
    std::vector<bool> solid(static_cast<std::size_t>(largest_region(mesh)) + 1, true);
    solid[0] = false;
    const Array<Vertex, int> region_at = regions_at_vertices(mesh);
    for (const Vertex v : region_at.indices())
        if (region_at[v] > 0 && pressure[v] != 0) solid[static_cast<std::size_t>(region_at[v])] = false;
    return solid;
}

}  // namespace kropla
