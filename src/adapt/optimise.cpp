// Optimisation of the places of the vertices of a zone (the paper's modification steps, Fig. 5: equalise
// volumes, then smooth for quality), for little: all vertices go at once to the barycentres of their balls,
// weighted by volume in target volumes; then the cells are measured, each once; where one has come near the
// floor, its vertices go back; and what is there still is optimised vertex by vertex. Cells that are bad but
// far from the floor are left to the operators that change connectivity: moving vertices for the worst of
// them crowds vertices elsewhere, which costs more cells than it saves. Weighting as in the centroidal patch
// tessellation of [Chen, Holst 2011], "Efficient mesh optimization schemes based on Optimal Delaunay
// Triangulations".

#include "adapt/constants.h"
#include "base/for_all.h"
#include "adapt/zone.h"

#include "base/tetrahedron.h"
#include "mesh/four_cells.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

namespace kropla {
namespace {

/// Returns whether all cells had a volume; else nothing is moved.
bool equalise_volumes(const Zone& zone, ZoneMotion& motion, const Mesh& mesh) {
    std::atomic<bool> valid = true;
    for_all(motion.cells.size(), [&](std::size_t c) {
        const Tet t = motion.cells[c];
        const auto& v = mesh.tets[t];
        const Vec3 &p = motion.place[v[0]], &q = motion.place[v[1]], &r = motion.place[v[2]], &s = motion.place[v[3]];
        const double size = motion.size[v[0]] + motion.size[v[1]] + motion.size[v[2]] + motion.size[v[3]];
        const double weight = determinant(q - p, r - p, s - p) / (size * size * size);
        motion.centroid[t] = {weight / 4 * (p + q + r + s), weight};
        if (!(weight > 0)) valid = false;
    });
    if (!valid) return false;
    for_all(motion.vertices.size(), [&](std::size_t i) {
        const Vertex v = motion.vertices[i];
        const Freedom free = freedom(zone, motion, v);
        if (free.none()) return;
        WeightedCentroid sum{};
        for (Tet t : zone.ball[v]) {
            sum.moment += motion.centroid[t].moment;
            sum.weight += motion.centroid[t].weight;
        }
        motion.place[v] += restricted(sum.moment / sum.weight - motion.place[v], free);
    });
    return true;
}

/// Takes the vertices of cells worse than `above` back to `places`, by number of `vertices`. Returns whether there
/// were any.
bool retreat(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, const std::vector<Vec3>& places, double above) {
    std::vector<Vertex> back;
    for (Vertex v : vertices_of_worse(zone, motion, mesh, above)) {
        const auto number = std::ranges::lower_bound(motion.vertices, v) - motion.vertices.begin();
        const Vec3& place = places[static_cast<std::size_t>(number)];
        if (motion.place[v] == place) continue;
        motion.place[v] = place;
        back.push_back(v);
    }
    for (Vertex v : back) measure_ball(zone, motion, mesh, v);
    return !back.empty();
}

/// Takes those of `vertices` out, in order, that share no cell with each other.
std::vector<Vertex> take_apart(const Zone& zone, std::vector<Vertex>& vertices) {
    std::vector<Vertex> apart, rest;
    IndexSet<Tet> cells;
    for (Vertex v : vertices) {
        const auto& ball = zone.ball[v];
        const bool is_near = std::ranges::any_of(ball, [&](Tet t) { return cells.contains(t); });
        (is_near ? rest : apart).push_back(v);
        if (!is_near)
            for (Tet t : ball) cells.insert(t);
    }
    vertices = std::move(rest);
    return apart;
}

/// Moves the vertices of cells worse than `above`, each once, to their best places: at once those that share no
/// cell.
int optimise_worst(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, double above, const Watch* watch) {
    const auto is_bad = [&](Tet t) { return motion.ratio[t] > above; };
    std::atomic<int> moved = 0;
    auto vertices = vertices_of_worse(zone, motion, mesh, above);
    while (!vertices.empty()) {
        heed(watch);
        const auto apart = take_apart(zone, vertices);
        for_all(apart.size(), [&](std::size_t i) {
            std::vector<StarFacet> star;
            star_of_ball(mesh, motion.place, apart[i], zone.ball[apart[i]], star);
            Vec3& place = motion.place[apart[i]];
            const Place best = best_place(star, place, freedom(zone, motion, apart[i]), smoothing_goal * above);
            if (best.x == place) return;
            place = best.x;
            measure_ball(zone, motion, mesh, apart[i]);
            ++moved;
        }, 16);
        std::erase_if(vertices, [&](Vertex v) { return std::ranges::none_of(zone.ball[v], is_bad); });
    }
    return moved;
}

}  // namespace

void measure_ball(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, Vertex v) {
    for (Tet t : zone.ball[v]) motion.ratio[t] = aspect_ratio(motion, mesh, t);
}

void measure(ZoneMotion& motion, const Mesh& mesh) {
    const std::size_t count = motion.cells.size();
    for_all((count + 3) / 4, [&](std::size_t four) {
        const std::size_t first = 4 * four;
        const auto ratios = tet_aspect_ratios(four_cells(motion.cells, mesh, first, motion.place));
        for (std::size_t i = 0; i < 4 && first + i < count; ++i) motion.ratio[motion.cells[first + i]] = ratios[i];
    });
}

std::optional<Changes> optimise_places(const Zone& zone, ZoneMotion& motion, const Mesh& mesh,
                                       const AdaptOptions& options) {
    const auto moved = places(motion);
    for (int i = 0; i < options.relaxations; ++i) {
        heed(options.watch);
        if (!equalise_volumes(zone, motion, mesh)) {
            put_back(motion, moved);
            break;
        }
    }
    measure(motion, mesh);
    const double spoilt = std::max(options.good_enough, near_the_floor * options.floor);
    for (int i = 0; i < most_retreats && retreat(zone, motion, mesh, moved, spoilt); ++i) heed(options.watch);
    if (std::ranges::any_of(motion.cells, [&](Tet t) { return !std::isfinite(motion.ratio[t]); })) {
        put_back(motion, moved);
        return std::nullopt;
    }
    Changes changes;
    changes.smoothing_sweeps = options.relaxations;
    for (int i = 0; i < most_passes; ++i) {
        const int more = optimise_worst(zone, motion, mesh, spoilt, options.watch);
        changes.moved += more;
        if (more == 0) break;
    }
    return changes;
}

Changes optimise_places(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    auto [zone, motion] = movable(mesh, cells);
    Changes changes;
    if (!optimise_places(zone, motion, mesh, options)) return changes;
    for (Vertex v : motion.vertices)
        if (motion.place[v] != mesh.position[v]) changes.vertices.push_back(v);
    changes.moved = static_cast<int>(changes.vertices.size());
    changes.smoothing_sweeps = options.relaxations;
    write_places(motion, mesh);
    return changes;
}

}  // namespace kropla
