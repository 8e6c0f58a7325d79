// A mesh without a size field has the size of its cells: where new points are needed, they have the distances of the
// vertices around.

#include <kropla/step/improve_mesh.h>

#include "adapt/budget.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace kropla {
namespace {

constexpr double no_size = std::numeric_limits<double>::max() / 4;  // [m] which bounds nothing

/// One size everywhere.
Snapshot of_size(double size) {
    const Vec3 corner{no_size, no_size, no_size};
    return {.box = {-corner, corner}, .size = {size, 0, size}, .shapes = {}};
}

/// The median length of the edges of the cells around this one [m].
double size_around(const Mesh& mesh, Tet t) {
    std::vector<double> lengths;
    for (const Tet n : with_ring(mesh, std::vector{t}))
        for (const auto& [a, b] : tet_edges) {
            const auto& v = mesh.tets[n];
            lengths.push_back(distance(mesh.position[v[as_size(a)]], mesh.position[v[as_size(b)]]));
        }
    const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
    std::nth_element(lengths.begin(), middle, lengths.end());
    return *middle;
}

std::vector<Tet> worse_than(const Mesh& mesh, double ratio) {
    std::vector<std::pair<double, Tet>> bad;
    for (const Tet t : all_tets(mesh))
        if (const double r = aspect_ratio(mesh, t); !(r <= ratio)) bad.emplace_back(-r, t);
    std::ranges::sort(bad);
    std::vector<Tet> worst_first;
    for (const auto& [r, t] : bad) worst_first.push_back(t);
    return worst_first;
}

}  // namespace

Changes improve_mesh(Mesh& mesh, const AdaptOptions& options) {
    AdaptOptions alone = options;
    alone.clusters = false;  // for these a size is needed
    Changes changes = improve(mesh, all_tets(mesh), of_size(no_size), alone);
    const double most_cut_out = cells_to_cut_out(as_size(count_tets(mesh)), options);
    for (const Tet t : worse_than(mesh, options.good_enough)) {
        heed(options.watch);
        if (changes.cut_out > most_cut_out) break;
        if (!alive(mesh, t) || aspect_ratio(mesh, t) <= options.good_enough) continue;
        changes += improve(mesh, std::vector{t}, of_size(size_around(mesh, t)), options);
    }
    return changes;
}

}  // namespace kropla
