#include "app/interface_patches.h"

#include <kropla/mesh/topology.h>

#include <algorithm>
#include <map>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

Triangle in_file(const FixedMesh& fixed, Triangle triangle) {
    for (Vertex& v : triangle) v = fixed.in_file[v];
    return sorted(triangle);
}

/// The triangles of the file that have a patch, and which.
std::map<Triangle, int> patches_of(const FileCells& cells) {
    std::map<Triangle, int> patches;
    for (const PatchFacet& facet : cells.facets)
        if (!facet.vertices[3].exists()) patches[sorted({facet.vertices[0], facet.vertices[1], facet.vertices[2]})] = facet.patch;
    return patches;
}

}  // namespace

std::vector<LooseInterface> loose_interfaces(const FixedMesh& fixed, const FileCells& cells) {
    const std::map<Triangle, int> patches = patches_of(cells);
    std::vector<LooseInterface> loose;
    for (Interface& surface : interfaces(fixed.mesh)) {
        if (!surface.is_apart) continue;
        std::map<int, std::size_t> found;
        for (const Triangle& triangle : surface.triangles)
            if (const auto at = patches.find(in_file(fixed, triangle)); at != patches.end()) ++found[at->second];
        const bool whole = found.size() == 1 && found.begin()->second == surface.triangles.size();
        if (!found.empty() && !whole) continue;
        const auto patch = whole ? std::optional(found.begin()->first) : std::nullopt;
        loose.push_back({std::move(surface), patch});
    }
    return loose;
}

void take_facets(const FixedMesh& fixed, std::span<const LooseInterface> loose, FileCells& cells) {
    std::vector<Triangle> taken;
    for (const auto& [interface, patch] : loose)
        if (patch)
            for (const Triangle& triangle : interface.triangles) taken.push_back(in_file(fixed, triangle));
    std::ranges::sort(taken);
    std::erase_if(cells.facets, [&](const PatchFacet& facet) {
        const auto& v = facet.vertices;
        return !v[3].exists() && std::ranges::binary_search(taken, sorted({v[0], v[1], v[2]}));
    });
}

void give_facets(std::span<const LooseInterface> loose, FileCells& cells) {
    const FixedMesh now = fixed_mesh(cells);
    for (const Interface& surface : interfaces(now.mesh))
        for (const auto& [interface, patch] : loose) {
            if (!patch || interface.inner != surface.inner || interface.outer != surface.outer) continue;
            for (const auto& [a, b, c] : surface.triangles)
                cells.facets.push_back({{now.in_file[a], now.in_file[b], now.in_file[c], Vertex{}}, *patch});
        }
}

}  // namespace kropla
