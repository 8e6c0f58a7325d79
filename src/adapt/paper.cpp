// The paper's own way with a step: the weighted Laplacian while cells are good, its three modification steps (Fig. 5)
// where they are about the limit of R/r, and the local cluster (1.3) where that does not do. The first of the three steps,
// the motion of all points within the body, is place_boundary. "On each stage, the Laplacian smoothing is performed unless
// finite elements keep appropriate quality, i.e. FE aspect ratio is much less than ten. When the ratio is about ten or more,
// the algorithm with three steps of mesh modifications is applied" (section 2). Here 3D, cell by cell instead of for the
// whole mesh at once, and smoothing for quality is guarded. Swaps by face and edge removal (swap.cpp), as the paper's
// conclusion names swapping.

#include "adapt/paper.h"

#include "adapt/constants.h"
#include "adapt/propose.h"
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace kropla {
namespace {

Vec3 laplacian_place(const Zone& zone, const ZoneMotion& motion, const Mesh& mesh, Vertex v,
                     const LaplaceWeights& weights) {
    std::vector<Vertex> around;
    for (Tet t : zone.ball[v])
        std::ranges::copy_if(mesh.tets[t], std::back_inserter(around), [v](Vertex w) { return w != v; });
    std::ranges::sort(around);
    around.erase(std::unique(around.begin(), around.end()), around.end());
    std::vector<Vec3> places;
    for (Vertex w : around) places.push_back(motion.place[w]);
    return motion.place[v] + restricted(laplacian_place(places, weights) - motion.place[v], freedom(zone, motion, v));
}

/// One sweep, each vertex seeing the new places of those before it; cells may turn over. Ratios are then to be measured.
void equalise_volumes(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, std::span<const Vertex> vertices) {
    for (Vertex v : vertices) motion.place[v] = laplacian_place(zone, motion, mesh, v, {.x1 = 0, .x2 = 1});
}

/// One sweep of moves that do not make the worst cell of the ball worse. Returns how many.
int smooth_for_quality(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, std::span<const Vertex> vertices,
                       const LaplaceWeights& weights) {
    int moved = 0;
    std::vector<StarFacet> star;
    for (Vertex v : vertices) {
        const Vec3 place = laplacian_place(zone, motion, mesh, v, weights);
        star_of_ball(mesh, motion.place, v, zone.ball[v], star);
        const double worst = worst_in_star(star, motion.place[v], infinity);
        if (place == motion.place[v] || worst_in_star(star, place, worst) > worst) continue;
        motion.place[v] = place;
        measure_ball(zone, motion, mesh, v);
        ++moved;
    }
    return moved;
}

double worst_ratio(const ZoneMotion& motion) {
    double worst = 0;
    for (Tet t : motion.cells) worst = std::max(worst, motion.ratio[t]);
    return worst;
}

/// Swaps cells worse than `above` away, and those that replace them.
Changes swap_worse(Mesh& mesh, std::span<const Tet> cells, double above, const Watch* watch) {
    constexpr std::array<std::size_t, 6> all_edges = {0, 1, 2, 3, 4, 5};
    Changes changes;
    std::vector<Tet> bad(cells.begin(), cells.end());
    for (std::size_t i = 0; i < bad.size(); ++i) {
        if (!is_worse(mesh, bad[i], above)) continue;
        heed(watch);
        const double bound = (1 - least_gain) * aspect_ratio(mesh, bad[i]);
        const auto cavity = best_swap(mesh, bad[i], all_edges, true, bound);
        if (!cavity) continue;
        const auto known = static_cast<std::ptrdiff_t>(changes.cells.size());
        carry_out(mesh, *cavity, changes);
        ++changes.swaps;
        bad.insert(bad.end(), changes.cells.begin() + known, changes.cells.end());
    }
    return changes;
}

}  // namespace

double about_the_limit(const AdaptOptions& options) {
    return std::min(options.floor, std::max(options.paper->about * options.floor, options.good_enough));
}

std::optional<Changes> smooth_places(const Zone& zone, ZoneMotion& motion, const Mesh& mesh,
                                     const AdaptOptions& options) {
    const PaperMethod& paper = *options.paper;
    const double good = std::max(paper.much_less * options.floor, options.swap_above);
    const double about_limit = about_the_limit(options);
    Changes changes;
    measure(motion, mesh);
    double worst = worst_ratio(motion);
    double least_worst = worst;
    auto best = places(motion);
    while (worst > good && changes.smoothing_sweeps < paper.sweeps) {
        heed(options.watch);
        const auto vertices = vertices_of_worse(zone, motion, mesh, good);
        if (worst > about_limit) {
            equalise_volumes(zone, motion, mesh, vertices);
            measure(motion, mesh);
            ++changes.smoothing_sweeps;
        }
        const int moved = smooth_for_quality(zone, motion, mesh, vertices, paper.weights);
        ++changes.smoothing_sweeps;
        changes.moved += moved;
        worst = worst_ratio(motion);
        if (worst <= least_worst) {
            least_worst = worst;
            best = places(motion);
        }
        if (moved == 0) break;
    }
    if (worst > least_worst) {
        put_back(motion, best);
        measure(motion, mesh);
    }
    if (!std::isfinite(least_worst)) return std::nullopt;
    return changes;
}

Changes remesh_clusters(Mesh& mesh, std::span<const Tet> cells, double above, const Snapshot& at_time,
                        const AdaptOptions& options) {
    Changes changes = swap_worse(mesh, cells, options.swap_above, options.watch);
    std::vector<Tet> poor(cells.begin(), cells.end());
    poor.insert(poor.end(), changes.cells.begin(), changes.cells.end());
    std::erase_if(poor, [&](Tet t) { return !is_worse(mesh, t, above); });
    AdaptOptions well = options;  // so that it lasts, where a small cluster does that
    well.floor = std::min(above, std::max(options.paper->remeshed * options.floor, options.good_enough));
    well.largest_ring = lasting_rings;
    well.whole_region = false;
    changes += repair(mesh, poor, at_time, well);
    AdaptOptions barely = options;
    barely.floor = above;
    std::vector<Tet> all(cells.begin(), cells.end());
    all.insert(all.end(), changes.cells.begin(), changes.cells.end());
    changes += repair(mesh, all, at_time, barely);
    return changes;
}

}  // namespace kropla
