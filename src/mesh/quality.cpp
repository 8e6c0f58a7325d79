#include <kropla/mesh/quality.h>

#include "base/tetrahedron.h"
#include "mesh/four_cells.h"
#include <kropla/mesh/prisms.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace kropla {
namespace {

std::array<Vec3, 4> corners(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return {mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]};
}

}  // namespace

double aspect_ratio(const Mesh& mesh, Tet t) {
    const auto [a, b, c, d] = corners(mesh, t);
    return tet_aspect_ratio(a, b, c, d);
}

double volume(const Mesh& mesh, Tet t) {
    const auto [a, b, c, d] = corners(mesh, t);
    return tet_volume(a, b, c, d);
}

Vec3 centroid(const Mesh& mesh, Tet t) {
    const auto [a, b, c, d] = corners(mesh, t);
    return (a + b + c + d) / 4;
}

double worst_aspect_ratio(const Mesh& mesh, std::span<const Tet> tets) {
    double worst = 0;
    for (std::size_t first = 0; first < tets.size(); first += 4)
        worst = std::max(worst, std::ranges::max(tet_aspect_ratios(four_cells(tets, mesh, first, mesh.position))));
    return worst;
}

QualitySummary summarise_quality(const Mesh& mesh, Region only) {
    QualitySummary summary;
    Array<Vertex, char> seen(mesh.position.size(), 0);
    std::vector<double> ratios;
    ratios.reserve(mesh.tets.size());
    double sum = 0;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t) || (only.exists() && mesh.region[t] != only)) continue;
        const auto [a, b, c, d] = corners(mesh, t);
        const double ratio = tet_aspect_ratio(a, b, c, d);
        if (ratio > summary.max_aspect_ratio) {
            summary.max_aspect_ratio = ratio;
            summary.worst = t;
        }
        ratios.push_back(ratio);
        for (Vertex v : mesh.tets[t]) seen[v] = 1;
        sum += ratio;
        const auto [least, largest] = tet_dihedral_range(a, b, c, d);
        summary.min_dihedral = std::min(summary.min_dihedral, least * 180 / std::numbers::pi);
        summary.max_dihedral = std::max(summary.max_dihedral, largest * 180 / std::numbers::pi);
    }
    for (const PrismLayer& layer : mesh.layers)
        if (!only.exists() || layer.region == only)
            for (Vertex v : layer.columns) seen[v] = 1;
    summary.tets = static_cast<int>(ratios.size());
    summary.vertices = static_cast<int>(std::ranges::count(seen, 1));
    if (ratios.empty()) return summary;
    summary.mean_aspect_ratio = sum / static_cast<double>(ratios.size());
    const auto rank = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(ratios.size() - 1));
    std::nth_element(ratios.begin(), ratios.begin() + rank, ratios.end());
    summary.p999_aspect_ratio = ratios[static_cast<std::size_t>(rank)];
    return summary;
}

double region_volume(const Mesh& mesh, Region region) {
    double sum = 0;
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t) && mesh.region[t] == region) sum += volume(mesh, t);
    for (const Prism& prism : all_prisms(mesh))
        if (layer_of(mesh, prism.layer).region == region) sum += prism_volume(prism_corners(mesh, prism));
    return sum;
}

std::vector<double> region_volumes(const Mesh& mesh, std::size_t regions) {
    std::vector<double> sums(regions, 0);
    const auto add = [&](Region region, double volume) {
        if (as_size(region.value) < regions) sums[as_size(region.value)] += volume;
    };
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t)) add(mesh.region[t], volume(mesh, t));
    for (const Prism& prism : all_prisms(mesh))
        add(layer_of(mesh, prism.layer).region, prism_volume(prism_corners(mesh, prism)));
    return sums;
}

}  // namespace kropla
