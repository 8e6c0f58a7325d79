#include "mesh/topology.h"
#include "transfer/transfer.h"

#include <algorithm>

namespace kropla {
namespace {

bool same_place(const Mesh& before, const Mesh& after, Vertex v) {
    const auto slot = static_cast<std::size_t>(v.value);
    return slot < before.position.size() && alive(before, v) && before.position[v] == after.position[v];
}

/// A tet of the old mesh near the vertex, in the same region: at a vertex that both meshes have in one place.
Tet old_tet_near(const Mesh& before, const Mesh& after, Vertex v) {
    const Region region = after.region[after.tet_at[v]];
    std::vector<Vertex> seen{v};
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (same_place(before, after, seen[i]))
            for (Tet t : ball(before, seen[i]))
                if (before.region[t] == region) return t;
        for (Vertex w : adjacent_vertices(after, seen[i]))
            if (std::ranges::find(seen, w) == seen.end()) seen.push_back(w);
    }
    const auto tets = before.tets.indices();  // nothing stayed in place: start anywhere in the region
    return *std::ranges::find_if(tets, [&](Tet t) { return alive(before, t) && before.region[t] == region; });
}

}  // namespace

std::vector<Interpolation> interpolations(const Mesh& before, const Mesh& after, std::span<const Vertex> changed) {
    std::vector<Vertex> vertices(changed.begin(), changed.end());
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);
    vertices.erase(repeated.begin(), repeated.end());

    std::vector<Interpolation> result;
    for (Vertex v : vertices) {
        if (!alive(after, v) || same_place(before, after, v)) continue;
        const Location found = locate(before, after.position[v], old_tet_near(before, after, v));
        result.push_back({v, before.tets[found.tet], found.weights});
    }
    return result;
}

Array<Vertex, double> carry(const Array<Vertex, double>& values, const Mesh& after,
                            std::span<const Interpolation> interpolations) {
    Array<Vertex, double> result = values;
    result.resize(after.position.size());
    for (const auto& [vertex, from, weights] : interpolations) {
        double sum = 0;
        for (std::size_t i = 0; i < 4; ++i) sum += weights[i] * values[from[i]];
        result[vertex] = sum;
    }
    return result;
}

}  // namespace kropla
