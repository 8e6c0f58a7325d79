// Splitting and collapsing edges towards the target size. The new vertex of a split goes to the best place
// inside the shell instead of the edge's middle: the shell is a star-shaped polyhedron (star.cpp).

#include "adapt/constants.h"
#include "base/for_all.h"
#include "adapt/propose.h"
#include "adapt/zone.h"
#include "base/tetrahedron.h"
#include "mesh/four_cells.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace kropla {
namespace {

/// The vertices of `t` with `to` in the place of `from`.
std::array<Vertex, 4> with_replaced(const Mesh& mesh, Tet t, Vertex from, Vertex to) {
    auto v = mesh.tets[t];
    v[as_size(corner_of(mesh, t, from))] = to;
    return v;
}

double aspect_ratio_of(const Mesh& mesh, const std::array<Vertex, 4>& v) {
    return tet_aspect_ratio(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]);
}

Vec3 middle_of(const Mesh& mesh, std::span<const Vertex> vertices) {
    Vec3 sum;
    for (Vertex v : vertices) sum += mesh.position[v];
    return sum / static_cast<double>(vertices.size());
}

/// A vertex may be pulled along an edge that is held by all that holds the vertex.
bool may_collapse(const Mesh& mesh, Vertex from, Vertex to, std::span<const Tet> around) {
    const Constraint held = constraint(mesh, from, around);
    if (held.free()) return true;
    if (held.rigid()) return false;
    const auto with_edge = std::ranges::find_if(around, [&](Tet t) { return corner_of(mesh, t, to) >= 0; });
    if (with_edge == around.end()) return false;
    return constraint(mesh, shell(mesh, {from, to}, *with_edge)).patches == held.patches;
}

}  // namespace

std::optional<Cavity> edge_collapse(const Mesh& mesh, Vertex from, Vertex to, double worst_allowed) {
    return edge_collapse(mesh, from, to, ball(mesh, from), worst_allowed);
}

std::optional<Cavity> edge_collapse(const Mesh& mesh, Vertex from, Vertex to, std::span<const Tet> around,
                                    double worst_allowed) {
    if (!may_collapse(mesh, from, to, around)) return std::nullopt;
    double worst = 0;
    for (Tet t : around) {
        if (corner_of(mesh, t, to) >= 0) continue;
        worst = std::max(worst, aspect_ratio_of(mesh, with_replaced(mesh, t, from, to)));
        if (worst > worst_allowed || worst == infinity) return std::nullopt;
    }
    Cavity cavity;
    cavity.removed.assign(around.begin(), around.end());
    cavity.worst_after = worst;
    for (Tet t : cavity.removed)
        if (corner_of(mesh, t, to) < 0)
            cavity.added.push_back({with_replaced(mesh, t, from, to), mesh.region[t], mesh.patch[t]});
    cavity.worst_before = worst_aspect_ratio(mesh, cavity.removed);
    return cavity;
}

std::optional<Cavity> edge_split(const Mesh& mesh, const Shell& shell, Edge edge, double worst_allowed) {
    const Constraint held = constraint(mesh, shell);
    if (held.rigid()) return std::nullopt;
    std::vector<StarFacet> star;
    for (Tet t : shell.tets)
        for (Vertex end : {edge.a, edge.b}) {
            const auto [a, b, c] = facet_vertices(mesh, {t, corner_of(mesh, t, end)});
            star.push_back({mesh.position[a], mesh.position[b], mesh.position[c]});
        }
    const Vec3 middle = (mesh.position[edge.a] + mesh.position[edge.b]) / 2;
    const Freedom free = freedom(held);
    Place place = best_place(star, middle, free, split_goal * worst_allowed);
    if (place.worst > flat)  // the edge of a cell that is so: the middle is in its plane
        place = best_place(star, middle + restricted(middle_of(mesh, shell.ring) - middle, free) / 2, free, split_goal * worst_allowed);
    if (place.worst > worst_allowed || place.worst == infinity) return std::nullopt;

    Cavity cavity;
    cavity.removed = shell.tets;
    cavity.inserted = {place.x};
    for (Tet t : shell.tets)
        for (Vertex end : {edge.a, edge.b})
            cavity.added.push_back({with_replaced(mesh, t, end, inserted_vertex(0)), mesh.region[t], mesh.patch[t]});
    cavity.worst_before = worst_aspect_ratio(mesh, shell.tets);
    cavity.worst_after = place.worst;
    return cavity;
}

namespace {

struct WrongEdge {
    Edge edge;
    Tet cell;      // that had it when it was found
    double ratio;  // of its length to the target size
};

/// Lengths in target sizes. The zone knows the sizes at its vertices, which cost a search for the nearest
/// body.
class EdgeMeasure {
public:
    EdgeMeasure(const Mesh& mesh, const Zone& zone, const ZoneMotion& motion, const Snapshot& at_time)
        : mesh_(mesh), zone_(zone), motion_(motion), at_time_(at_time) {}

    [[nodiscard]] double ratio(Edge e) const {
        return distance(mesh_.position[e.a], mesh_.position[e.b]) / ((size(e.a) + size(e.b)) / 2);
    }
    [[nodiscard]] bool is_longer(Edge e, double ratio) const {
        const double longest = ratio * (size(e.a) + size(e.b)) / 2;
        return squared_norm(mesh_.position[e.a] - mesh_.position[e.b]) > longest * longest;
    }

private:
    [[nodiscard]] double size(Vertex v) const {
        if (zone_.has.contains(v) && motion_.place[v] == mesh_.position[v]) return motion_.size[v];
        return target_size(at_time_, mesh_.position[v]);
    }
    const Mesh& mesh_;
    const Zone& zone_;
    const ZoneMotion& motion_;
    const Snapshot& at_time_;
};

/// What is not a number breaks no bound.
bool is_out_of(SquaredBounds bounds, double square, double size) {
    return square > bounds.most * (size * size) || square < bounds.least * (size * size);
}

void find_wrong_edges(const Mesh& mesh, const ZoneMotion& motion, Tet t, SquaredBounds bounds,
                      std::vector<WrongEdge>& wrong) {
    for (std::size_t k = 0; k < tet_edges.size(); ++k) {
        const auto [a, b] = tet_edge(mesh, t, k);
        const double size = (motion.size[a] + motion.size[b]) / 2;
        const double square = squared_norm(motion.place[a] - motion.place[b]);
        if (!is_out_of(bounds, square, size)) continue;
        wrong.push_back({{std::min(a, b), std::max(a, b)}, t, std::sqrt(square) / size});
    }
}

void find_wrong_edges_of_four(const Mesh& mesh, const ZoneMotion& motion, std::span<const Tet> cells, std::size_t first,
                              SquaredBounds bounds, std::vector<WrongEdge>& wrong) {
    std::array<FourNumbers, 4> sizes;  // per corner, per tet
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& v = mesh.tets[cells[std::min(first + i, cells.size() - 1)]];
        for (std::size_t k = 0; k < 4; ++k) sizes[k][i] = motion.size[v[k]];
    }
    const auto is_wrong = have_edge_out_of(bounds, four_cells(cells, mesh, first, motion.place), sizes);
    for (std::size_t i = 0; i < 4 && first + i < cells.size(); ++i)
        if (is_wrong[i]) find_wrong_edges(mesh, motion, cells[first + i], bounds, wrong);
}

/// Those of all cells, each as often as it has cells.
void find_wrong_edges(const Mesh& mesh, const ZoneMotion& motion, std::span<const Tet> cells, SquaredBounds bounds,
                      std::vector<WrongEdge>& wrong) {
    constexpr std::size_t at_once = 4096;
    std::vector<std::vector<WrongEdge>> parts((cells.size() + at_once - 1) / at_once);
    for_all(parts.size(), [&](std::size_t part) {
        const std::size_t end = std::min(cells.size(), at_once * (part + 1));
        for (std::size_t i = at_once * part; i < end; i += 4)
            find_wrong_edges_of_four(mesh, motion, cells, i, bounds, parts[part]);
    }, 1);
    for (const auto& part : parts) wrong.insert(wrong.end(), part.begin(), part.end());
}

/// The edges of the motion's cells, and of those beyond, that are too long or too short. Crowds are thinned before gaps
/// are filled; the shortest and the longest edges come first.
std::vector<WrongEdge> wrong_edges(const Mesh& mesh, const ZoneMotion& motion, const AdaptOptions& o) {
    const SquaredBounds bounds{o.collapse_below * o.collapse_below, o.split_above * o.split_above};
    std::vector<WrongEdge> wrong;
    find_wrong_edges(mesh, motion, motion.cells, bounds, wrong);
    find_wrong_edges(mesh, motion, motion.beyond, bounds, wrong);
    const auto rank = [](double ratio) { return ratio > 1 ? 1 + 1 / ratio : ratio; };
    std::ranges::sort(wrong, {}, [&](const WrongEdge& w) {
        return std::tuple(rank(w.ratio), w.edge.a, w.edge.b, w.cell);
    });
    const auto is_same = [](const WrongEdge& a, const WrongEdge& b) { return a.edge == b.edge; };
    wrong.erase(std::unique(wrong.begin(), wrong.end(), is_same), wrong.end());
    return wrong;
}

/// A cell that has the edge, if it still is one.
std::optional<Tet> cell_at(const Mesh& mesh, const WrongEdge& wrong) {
    const auto has_edge = [&](Tet t) {
        return alive(mesh, t) && corner_of(mesh, t, wrong.edge.a) >= 0 && corner_of(mesh, t, wrong.edge.b) >= 0;
    };
    if (!alive(mesh, wrong.edge.a) || !alive(mesh, wrong.edge.b)) return std::nullopt;
    if (has_edge(wrong.cell)) return wrong.cell;
    const auto around = ball(mesh, wrong.edge.a);
    const auto found = std::ranges::find_if(around, has_edge);
    return found == around.end() ? std::nullopt : std::optional(*found);
}

/// The ball of a vertex while the mesh still has the cells of the zone, of which the balls of vertices that move are
/// known.
void ball_at_start(const Mesh& mesh, const Zone& zone, const ZoneMotion& motion, Vertex v, std::vector<Tet>& tets) {
    if (zone.has.contains(v) && !freedom(zone, motion, v).none()) tets = zone.ball[v];
    else ball(mesh, v, tets);
}

/// Would an edge from `to` to a neighbour of `from` become too long?
bool makes_long_edge(const Mesh& mesh, std::span<const Tet> around, Vertex from, Vertex to, const EdgeMeasure& measure,
                     double longest) {
    for (Tet t : around) {
        if (corner_of(mesh, t, to) >= 0) continue;
        for (Vertex v : mesh.tets[t])
            if (v != from && measure.is_longer({v, to}, longest)) return true;
    }
    return false;
}

/// The better of the two ways to collapse the edge, if one is allowed. `ball_of` finds the ball of a vertex.
template <class BallOf>
std::optional<Cavity> collapse_either_way(const Mesh& mesh, Edge e, const EdgeMeasure& measure, const AdaptOptions& o,
                                          BallOf ball_of) {
    std::optional<Cavity> best;
    std::vector<Tet> around;
    for (const auto& [from, to] : {std::pair(e.a, e.b), std::pair(e.b, e.a)}) {
        ball_of(from, around);
        if (makes_long_edge(mesh, around, from, to, measure, longest_by_size * o.split_above)) continue;
        auto cavity = edge_collapse(mesh, from, to, around, best ? best->worst_after : infinity);
        if (!cavity || cavity->worst_after > std::max(o.passing, cavity->worst_before)) continue;
        best = std::move(cavity);
    }
    return best;
}

std::optional<Cavity> split(const Mesh& mesh, Edge e, Tet t, const AdaptOptions& o) {
    const Shell around = shell(mesh, e, t);
    return edge_split(mesh, around, e, std::max(o.passing, worst_aspect_ratio(mesh, around.tets)));
}

}  // namespace

Changes adapt_to_size(Mesh& mesh, const Zone& zone, const ZoneMotion& motion, const Snapshot& at_time,
                      const AdaptOptions& options, bool tangled) {
    Changes changes;
    const EdgeMeasure measure(mesh, zone, motion, at_time);
    const auto wrong = wrong_edges(mesh, motion, options);
    const auto first_long = std::ranges::find_if(wrong, [](const WrongEdge& w) { return w.ratio > 1; });
    const auto shorts = static_cast<std::size_t>(first_long - wrong.begin());
    const auto can_be_done = [&](const std::optional<Cavity>& cavity) {
        return cavity && (!tangled || fits(mesh, *cavity));
    };
    const auto collapse = [&](std::size_t i, auto ball_of) {
        return collapse_either_way(mesh, wrong[i].edge, measure, options, ball_of);
    };
    const auto in_zone = [&](Vertex v, std::vector<Tet>& tets) { ball_at_start(mesh, zone, motion, v, tets); };
    const auto in_mesh = [&](Vertex v, std::vector<Tet>& tets) { ball(mesh, v, tets); };
    Replaced replaced;
    for (auto& [i, proposed] : propose_all(shorts, [&](std::size_t i) { return collapse(i, in_zone); },
                                            options.watch)) {
        heed(options.watch);
        std::optional<Cavity> cavity = std::move(proposed);
        if (replaced.outdates(*cavity)) cavity = cell_at(mesh, wrong[i]) ? collapse(i, in_mesh) : std::nullopt;
        if (!can_be_done(cavity)) continue;
        replaced.add(*cavity);
        carry_out(mesh, *cavity, changes);
        ++changes.collapses;
    }
    for (std::size_t i = shorts; i < wrong.size(); ++i) {
        heed(options.watch);
        const auto cell = cell_at(mesh, wrong[i]);
        if (!cell || measure.ratio(wrong[i].edge) != wrong[i].ratio) continue;
        const auto cavity = split(mesh, wrong[i].edge, *cell, options);
        if (!can_be_done(cavity)) continue;
        carry_out(mesh, *cavity, changes);
        ++changes.splits;
    }
    return changes;
}

Changes adapt_to_size(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options) {
    const auto [zone, motion] = movable(mesh, cells, &at_time);
    return adapt_to_size(mesh, zone, motion, at_time, options, is_tangled(mesh, cells));
}

}  // namespace kropla
