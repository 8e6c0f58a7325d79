// Optimisation of the places of the vertices of a zone (the paper's modification steps, Fig. 5: equalise
// volumes, then smooth for quality), for little: all vertices go at once to the barycentres of their balls,
// weighted by volume in target volumes; then the cells are measured, each once; where one has come near the
// floor, its vertices go back; and what is there still is optimised vertex by vertex. Cells that are bad but
// far from the floor are left to the operators that change connectivity: moving vertices for the worst of
// them crowds vertices elsewhere, which costs more cells than it saves. Weighting as in the centroidal patch
// tessellation of [Chen, Holst 2011], "Efficient mesh optimization schemes based on Optimal Delaunay
// Triangulations".

#include "adapt/constants.h"
#include "adapt/for_all.h"
#include "adapt/zone.h"

#include "base/tetrahedron.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

namespace kropla {
namespace {

/// Returns whether all cells had a volume; else nothing is moved.
bool equalise_volumes(Zone& zone, const Mesh& mesh) {
    std::atomic<bool> valid = true;
    for_all(zone.cells.size(), [&](std::size_t c) {
        const Tet t = zone.cells[c];
        const auto& v = mesh.tets[t];
        const Vec3 &p = zone.place[v[0]], &q = zone.place[v[1]], &r = zone.place[v[2]], &s = zone.place[v[3]];
        const double size = zone.size[v[0]] + zone.size[v[1]] + zone.size[v[2]] + zone.size[v[3]];
        const double weight = determinant(q - p, r - p, s - p) / (size * size * size);
        zone.pull[t] = {weight / 4 * (p + q + r + s), weight};
        if (!(weight > 0)) valid = false;
    });
    if (!valid) return false;
    for_all(zone.vertices.size(), [&](std::size_t i) {
        const Vertex v = zone.vertices[i];
        const Freedom free = freedom(zone, v);
        if (free.none()) return;
        Pull sum{};
        for (Tet t : zone.ball[v]) {
            sum.moment += zone.pull[t].moment;
            sum.weight += zone.pull[t].weight;
        }
        zone.place[v] += restricted(sum.moment / sum.weight - zone.place[v], free);
    });
    return true;
}

void measure_ball(Zone& zone, const Mesh& mesh, Vertex v) {
    for (Tet t : zone.ball[v]) zone.ratio[t] = aspect_ratio(zone, mesh, t);
}

/// Takes the vertices of cells worse than `above` back to `places`, by number of `vertices`. Returns whether there
/// were any.
bool retreat(Zone& zone, const Mesh& mesh, const std::vector<Vec3>& places, double above) {
    std::vector<Vertex> back;
    for (Vertex v : vertices_of_worse(zone, mesh, above)) {
        const auto number = std::ranges::lower_bound(zone.vertices, v) - zone.vertices.begin();
        const Vec3& place = places[static_cast<std::size_t>(number)];
        if (zone.place[v] == place) continue;
        zone.place[v] = place;
        back.push_back(v);
    }
    for (Vertex v : back) measure_ball(zone, mesh, v);
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
int optimise_worst(Zone& zone, const Mesh& mesh, double above, const Watch* watch) {
    const auto is_bad = [&](Tet t) { return zone.ratio[t] > above; };
    std::atomic<int> moved = 0;
    auto vertices = vertices_of_worse(zone, mesh, above);
    while (!vertices.empty()) {
        heed(watch);
        const auto apart = take_apart(zone, vertices);
        for_all(apart.size(), [&](std::size_t i) {
            std::vector<StarFacet> star;
            star_of_ball(zone, mesh, apart[i], star);
            Vec3& place = zone.place[apart[i]];
            const Place best = best_place(star, place, freedom(zone, apart[i]), smoothing_goal * above);
            if (best.x == place) return;
            place = best.x;
            measure_ball(zone, mesh, apart[i]);
            ++moved;
        }, 16);
        std::erase_if(vertices, [&](Vertex v) { return std::ranges::none_of(zone.ball[v], is_bad); });
    }
    return moved;
}

}  // namespace

void measure(Zone& zone, const Mesh& mesh) {
    const std::size_t count = zone.cells.size();
    for_all((count + 3) / 4, [&](std::size_t four) {
        const std::size_t first = 4 * four;
        Four ratios;
        tet_aspect_ratios(four_cells(zone.cells, mesh, first, zone.place), ratios);
        for (std::size_t i = 0; i < 4 && first + i < count; ++i) zone.ratio[zone.cells[first + i]] = ratios[i];
    });
}

std::optional<Changes> optimise_places(Zone& zone, const Mesh& mesh, const AdaptOptions& options) {
    std::vector<Vec3> moved;
    for (Vertex v : zone.vertices) moved.push_back(zone.place[v]);
    const auto take_back = [&] {
        for (std::size_t i = 0; i < moved.size(); ++i) zone.place[zone.vertices[i]] = moved[i];
    };
    for (int i = 0; i < options.relaxations; ++i) {
        heed(options.watch);
        if (!equalise_volumes(zone, mesh)) {
            take_back();
            break;
        }
    }
    measure(zone, mesh);
    const double spoilt = std::max(options.good_enough, near_the_floor * options.floor);
    for (int i = 0; i < most_retreats && retreat(zone, mesh, moved, spoilt); ++i) heed(options.watch);
    if (std::ranges::any_of(zone.cells, [&](Tet t) { return !std::isfinite(zone.ratio[t]); })) {
        take_back();
        return std::nullopt;
    }
    Changes changes;
    changes.smoothing_sweeps = options.relaxations;
    for (int i = 0; i < most_passes; ++i) {
        const int more = optimise_worst(zone, mesh, spoilt, options.watch);
        changes.moved += more;
        if (more == 0) break;
    }
    return changes;
}

Changes optimise_places(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    Zone zone;
    gather(zone, mesh, cells);
    for (Vertex v : zone.vertices) zone.size[v] = 1;
    Changes changes;
    if (!optimise_places(zone, mesh, options)) return changes;
    for (Vertex v : zone.vertices)
        if (zone.place[v] != mesh.position[v]) changes.vertices.push_back(v);
    changes.moved = static_cast<int>(changes.vertices.size());
    changes.smoothing_sweeps = options.relaxations;
    write_places(zone, mesh);
    return changes;
}

}  // namespace kropla
