// Optimisation of the places of the vertices of a zone (the paper's modification steps, Fig. 5: equalise
// volumes, then smooth for quality), for little: all vertices go at once to the barycentres of their balls,
// weighted by volume in target volumes; then the cells are measured, each once; where one has come near the
// floor, its vertices go back; and what is there still is optimised vertex by vertex. Cells that are bad but
// far from the floor are left to the operators that change connectivity: moving vertices for the worst of
// them crowds vertices elsewhere, which costs more cells than it saves. Weighting as in the centroidal patch
// tessellation of [Chen, Holst 2011], "Efficient mesh optimization schemes based on Optimal Delaunay
// Triangulations".

#include "adapt/for_all.h"
#include "adapt/zone.h"

#include "base/tetrahedron.h"

#include <algorithm>
#include <atomic>
#include <span>
#include <unordered_set>

namespace kropla {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr int most_retreats = 5;       // vertices that are taken back may spoil the cells of others
constexpr int most_passes = 4;         // over the vertices of bad cells
constexpr double near_the_floor = 0.8;  // of it: cells above are put right by moving vertices

struct Pull {
    Vec3 moment;
    double weight;
};

void equalise_volumes(Zone& zone) {
    std::vector<Pull> pulls(zone.cells.size());
    for_all(zone.cells.size(), [&](std::size_t c) {
        const auto& v = zone.corners[c];
        const Vec3 &p = zone.place[at(v[0])], &q = zone.place[at(v[1])], &r = zone.place[at(v[2])],
                   &s = zone.place[at(v[3])];
        const double size = zone.size[at(v[0])] + zone.size[at(v[1])] + zone.size[at(v[2])] + zone.size[at(v[3])];
        const double weight = determinant(q - p, r - p, s - p) / (size * size * size);
        pulls[c] = {weight / 4 * (p + q + r + s), weight};
    });
    for_all(zone.vertices.size(), [&](std::size_t v) {
        if (zone.axes[v] == 0) return;
        Pull sum{};
        for (int i = zone.ball_begin[v]; i < zone.ball_begin[v + 1]; ++i) {
            const Pull& pull = pulls[at(zone.ball[at(i)])];
            sum.moment += pull.moment;
            sum.weight += pull.weight;
        }
        const Vec3 way = sum.moment / sum.weight - zone.place[v];
        zone.place[v] += restricted(way, freedom(zone, static_cast<int>(v)));
    });
}

void measure_ball(Zone& zone, int v) {
    for (int i = zone.ball_begin[at(v)]; i < zone.ball_begin[at(v) + 1]; ++i) {
        const int c = zone.ball[at(i)];
        zone.ratio[at(c)] = aspect_ratio(zone, c);
    }
}

std::vector<int> vertices_of_worse(const Zone& zone, double above) {
    std::vector<int> vertices;
    for (std::size_t c = 0; c < zone.cells.size(); ++c)
        if (zone.ratio[c] > above)
            for (int v : zone.corners[c])
                if (zone.axes[at(v)] != 0) vertices.push_back(v);
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);
    vertices.erase(repeated.begin(), repeated.end());
    return vertices;
}

std::span<const int> ball_of(const Zone& zone, int v) {
    return std::span(zone.ball).subspan(at(zone.ball_begin[at(v)]),
                                        at(zone.ball_begin[at(v) + 1] - zone.ball_begin[at(v)]));
}

/// Takes the vertices of cells worse than `above` back to `places`. Returns whether there were any.
bool retreat(Zone& zone, const std::vector<Vec3>& places, double above) {
    std::vector<char> has_moved(zone.cells.size(), false);
    bool any = false;
    for (int v : vertices_of_worse(zone, above)) {
        if (zone.place[at(v)] == places[at(v)]) continue;
        zone.place[at(v)] = places[at(v)];
        for (int c : ball_of(zone, v)) has_moved[at(c)] = true;
        any = true;
    }
    for_all(any ? has_moved.size() : 0, [&](std::size_t c) {
        if (has_moved[c] != 0) zone.ratio[c] = aspect_ratio(zone, static_cast<int>(c));
    });
    return any;
}

/// Takes those of `vertices` out, in order, that share no cell with each other.
std::vector<int> take_apart(const Zone& zone, std::vector<int>& vertices) {
    std::vector<int> apart, rest;
    std::unordered_set<int> cells;
    for (int v : vertices) {
        const auto ball = ball_of(zone, v);
        const bool is_near = std::ranges::any_of(ball, [&](int c) { return cells.contains(c); });
        (is_near ? rest : apart).push_back(v);
        if (!is_near) cells.insert(ball.begin(), ball.end());
    }
    vertices = std::move(rest);
    return apart;
}

/// Moves the vertices of cells worse than `above`, each once, to their best places: at once those that share no
/// cell.
int optimise_worst(Zone& zone, double above) {
    const auto is_bad = [&](int c) { return zone.ratio[at(c)] > above; };
    std::atomic<int> moved = 0;
    auto vertices = vertices_of_worse(zone, above);
    while (!vertices.empty()) {
        const auto apart = take_apart(zone, vertices);
        for_all(apart.size(), [&](std::size_t i) {
            std::vector<StarFacet> star;
            star_of_ball(zone, apart[i], star);
            Vec3& place = zone.place[at(apart[i])];
            const Place best = best_place(star, place, freedom(zone, apart[i]), 0.9 * above);
            if (best.x == place) return;
            place = best.x;
            measure_ball(zone, apart[i]);
            ++moved;
        }, 16);
        std::erase_if(vertices, [&](int v) { return std::ranges::none_of(ball_of(zone, v), is_bad); });
    }
    return moved;
}

}  // namespace

void measure(Zone& zone) {
    const std::size_t count = zone.cells.size();
    zone.ratio.resize(count);
    for_all((count + 3) / 4, [&](std::size_t four) {
        const std::size_t first = 4 * four;
        Four ratios;
        tet_aspect_ratios(four_cells(zone, first, zone.place), ratios);
        for (std::size_t i = 0; i < 4 && first + i < count; ++i) zone.ratio[first + i] = ratios[i];
    });
}

int optimise_places(Zone& zone, const AdaptOptions& options) {
    const std::vector<Vec3> moved = zone.place;
    for (int i = 0; i < options.relaxations; ++i) equalise_volumes(zone);
    measure(zone);
    const double spoilt = std::max(options.good_enough, near_the_floor * options.floor);
    for (int i = 0; i < most_retreats && retreat(zone, moved, spoilt); ++i) {}
    int count = 0;
    for (int i = 0; i < most_passes; ++i) {
        const int more = optimise_worst(zone, spoilt);
        count += more;
        if (more == 0) break;
    }
    return count;
}

Changes optimise_places(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    Zone zone;
    gather(zone, mesh, cells);
    zone.size.assign(zone.vertices.size(), 1);
    Changes changes;
    optimise_places(zone, options);
    for (std::size_t v = 0; v < zone.vertices.size(); ++v)
        if (zone.place[v] != zone.start[v]) changes.vertices.push_back(zone.vertices[v]);
    changes.moved = static_cast<int>(changes.vertices.size());
    changes.smoothing_sweeps = options.relaxations;
    write_places(zone, mesh);
    return changes;
}

}  // namespace kropla
