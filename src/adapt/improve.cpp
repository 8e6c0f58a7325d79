// Improvement of the worst cells first: for each, the operators in the order of what they cost the solution
// (a swap keeps all vertices, smoothing moves one, a collapse loses one, a split adds one), after the
// schedule of [Klingner, Shewchuk 2007], "Aggressive tetrahedral mesh improvement", here cell by cell from a
// queue, so that work is proportional to the bad cells. It ends, as each step lowers the worst aspect ratio
// of what it replaces.

#include "adapt/propose.h"
#include "adapt/star.h"
#include "mesh/quality.h"

#include <algorithm>
#include <iterator>
#include <queue>

namespace kropla {
namespace {

constexpr double least_gain = 1e-3;
constexpr double passable_after_swap = 0.96;    // of good_enough: no swap for the energy makes a worse cell
constexpr double longest_after_collapse = 2.0;  // [target sizes]
constexpr double slightly_longer = 1.05;        // an edge may be than another that takes its place
constexpr int most_swap_rounds = 6;             // of those that others have overtaken
constexpr int most_rounds = 3;                  // a cell found stuck is tried again when others have changed

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The work list: bad cells, the worst first, ties by number.
class BadCells {
public:
    BadCells(const Mesh& mesh, double above) : mesh_(mesh), above_(above) {}

    void add(Tet t) {
        if (!alive(mesh_, t)) return;
        if (const double ratio = aspect_ratio(mesh_, t); ratio > above_) queue_.push({ratio, -t.value});
    }
    /// The worst cell, if one is left; entries whose cell has changed since are passed over.
    std::optional<std::pair<Tet, double>> take() {
        while (!queue_.empty()) {
            const auto [ratio, minus_name] = queue_.top();
            queue_.pop();
            const Tet t(-minus_name);
            if (alive(mesh_, t) && aspect_ratio(mesh_, t) == ratio) return std::pair(t, ratio);
        }
        return std::nullopt;
    }

private:
    const Mesh& mesh_;
    double above_;
    std::priority_queue<std::pair<double, std::int32_t>> queue_;
};

/// One improvement of a mesh under way.
struct Improvement {
    Mesh& mesh;
    const Snapshot& at_time;
    const AdaptOptions& options;
    BadCells bad;
    IndexSet<Tet> changed = {};  // cells that are new or have moved
    Shell around = {};           // room for questions
    Changes changes = {};

    void carry_out(const Cavity& cavity) {
        const std::size_t known = changes.cells.size();
        kropla::carry_out(mesh, cavity, changes);
        for (std::size_t i = known; i < changes.cells.size(); ++i) {
            bad.add(changes.cells[i]);
            changed.insert(changes.cells[i]);
        }
    }
};

void keep_better(std::optional<Cavity>& best, std::optional<Cavity> other) {
    if (!other) return;
    const auto gain = [](const Cavity& c) { return c.worst_before - c.worst_after; };
    if (!best || gain(*other) > gain(*best)) best = std::move(other);
}

/// The longest edge of the cell, as in tet_edges.
std::size_t longest_edge(const Mesh& mesh, Tet t) {
    std::array<double, 6> lengths;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = tet_edges[k];
        lengths[k] = squared_norm(mesh.position[mesh.tets[t][at(i)]] - mesh.position[mesh.tets[t][at(j)]]);
    }
    return static_cast<std::size_t>(std::ranges::max_element(lengths) - lengths.begin());
}

bool is_obtuse_at(const Mesh& mesh, Tet t, std::size_t edge) {
    const auto place = [&](int corner) { return mesh.position[mesh.tets[t][at(corner)]]; };
    const auto [i, j] = tet_edges[edge];
    const auto [k, l] = tet_edges[5 - edge];
    const Vec3 along = place(j) - place(i);
    return dot(cross(along, place(k) - place(i)), cross(along, place(l) - place(i))) < 0;
}

/// The vertex across the facet opposite the corner, if it is not on the boundary.
Vertex vertex_across(const Mesh& mesh, Tet t, int corner) {
    const Tet n = mesh.neighbour[t][at(corner)];
    return n.exists() ? mesh.tets[n][at(mirror_corner(mesh, {t, corner}))] : Vertex{};
}

/// Of the ways to cut an octahedron into four cells, the one along its shortest diagonal is nearly always the
/// best. May one be shorter than this edge of the cell, or do only three cells stand around it?
bool may_be_swapped(const Mesh& mesh, Tet t, std::size_t edge) {
    const auto [i, j] = tet_edges[edge];
    const auto [k, l] = tet_edges[5 - edge];
    const auto length = [&](Vertex a, Vertex b) { return squared_norm(mesh.position[a] - mesh.position[b]); };
    const auto& v = mesh.tets[t];
    const Vertex across_k = vertex_across(mesh, t, k), across_l = vertex_across(mesh, t, l);
    if (!across_k.exists() || !across_l.exists() || across_k == across_l) return true;
    const double diagonal = std::min(length(v[at(k)], across_k), length(v[at(l)], across_l));
    return diagonal < slightly_longer * slightly_longer * length(v[at(i)], v[at(j)]);
}

/// The swap at a cell that is for the energy: away with its longest edge, where it is obtuse, if three or four
/// cells stand around it. (Longer rings, shorter edges and facets, tried on the default case, make 80 % of the
/// questions and 5 % of the swaps.)
std::optional<Cavity> swap_longest_edge(const Mesh& mesh, Tet t, double limit) {
    const std::size_t longest = longest_edge(mesh, t);
    if (!is_obtuse_at(mesh, t, longest) || !may_be_swapped(mesh, t, longest)) return std::nullopt;
    const auto [i, j] = tet_edges[longest];
    const Edge e{mesh.tets[t][at(i)], mesh.tets[t][at(j)]};
    const Shell around = shell(mesh, e, t);
    if (around.ring.size() > 4) return std::nullopt;
    return edge_removal(mesh, around, e, {true, limit});
}

bool swap_at(Improvement& work, Tet t) {
    const Mesh& mesh = work.mesh;
    std::optional<Cavity> best;
    for (int i = 0; i < 4; ++i) keep_better(best, face_removal(mesh, {t, i}));
    for (const auto& [i, j] : tet_edges) {
        const Edge e{mesh.tets[t][at(i)], mesh.tets[t][at(j)]};
        shell(mesh, e, t, work.around);
        keep_better(best, edge_removal(mesh, work.around, e));
    }
    if (!best) return false;
    work.carry_out(*best);
    ++work.changes.swaps;
    return true;
}

/// What a move costs the solution: each cell at the vertex that is still as it was has to be projected.
std::ptrdiff_t count_unchanged(const Improvement& work, std::span<const Tet> around) {
    return std::ranges::count_if(around, [&](Tet t) { return !work.changed.contains(t); });
}

/// Moves the vertex that makes the cell good enough at the least cost; or, if none does, makes it the best.
bool smooth_at(Improvement& work, Tet t) {
    struct Candidate {
        std::ptrdiff_t cost;
        Vertex vertex;
        std::vector<Tet> around;
    };
    std::array<Candidate, 4> by_cost;
    for (std::size_t i = 0; i < 4; ++i) {
        auto& [cost, v, around] = by_cost[i];
        v = work.mesh.tets[t][i];
        ball(work.mesh, v, around);
        cost = count_unchanged(work, around);
    }
    std::ranges::sort(by_cost, {}, [](const Candidate& c) { return std::pair(c.cost, c.vertex); });
    const Candidate* chosen = nullptr;
    Place best{{}, std::numeric_limits<double>::infinity()};
    for (const Candidate& candidate : by_cost) {
        const Place place = better_place(work.mesh, candidate.vertex, candidate.around, 0.9 * work.options.good_enough);
        if (place.x == work.mesh.position[candidate.vertex] || place.worst >= best.worst) continue;
        chosen = &candidate;
        best = place;
        if (best.worst <= work.options.good_enough) break;
    }
    if (!chosen) return false;
    work.mesh.position[chosen->vertex] = best.x;
    ++work.changes.moved;
    work.changes.vertices.push_back(chosen->vertex);
    for (Tet moved : chosen->around) {
        work.bad.add(moved);
        work.changed.insert(moved);
    }
    return true;
}

bool makes_long_edge(const Improvement& work, const Cavity& cavity, Vertex to) {
    const Vec3 place = work.mesh.position[to];
    const double longest = longest_after_collapse * target_size(work.at_time, place);
    return std::ranges::any_of(cavity.added, [&](const NewTet& t) {
        return std::ranges::any_of(
            t.vertices, [&](Vertex v) { return distance(work.mesh.position[v], place) > longest; });
    });
}

bool collapse_at(Improvement& work, Tet t, double ratio) {
    const double bound = (1 - least_gain) * ratio;
    std::optional<Cavity> best;
    std::vector<Tet> around;
    for (Vertex from : work.mesh.tets[t]) {
        ball(work.mesh, from, around);
        for (Vertex to : work.mesh.tets[t]) {
            if (from == to) continue;
            auto cavity = edge_collapse(work.mesh, from, to, around, best ? best->worst_after : bound);
            if (cavity && !makes_long_edge(work, *cavity, to)) best = std::move(cavity);
        }
    }
    if (!best) return false;
    work.carry_out(*best);
    ++work.changes.collapses;
    return true;
}

bool split_at(Improvement& work, Tet t, double ratio) {
    const Mesh& mesh = work.mesh;
    const double bound = (1 - least_gain) * ratio;
    std::optional<Cavity> best;
    for (const auto& [i, j] : tet_edges) {
        const Edge e{mesh.tets[t][at(i)], mesh.tets[t][at(j)]};
        shell(mesh, e, t, work.around);
        auto cavity = edge_split(mesh, work.around, e, best ? best->worst_after : bound);
        if (cavity && (!best || cavity->worst_after < best->worst_after)) best = std::move(cavity);
    }
    if (!best) return false;
    work.carry_out(*best);
    ++work.changes.splits;
    return true;
}

}  // namespace

Changes& Changes::operator+=(const Changes& other) {
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    cells.insert(cells.end(), other.cells.begin(), other.cells.end());
    removed.insert(removed.end(), other.removed.begin(), other.removed.end());
    smoothing_sweeps += other.smoothing_sweeps;
    moved += other.moved;
    swaps += other.swaps;
    splits += other.splits;
    collapses += other.collapses;
    local_remeshes += other.local_remeshes;
    largest_ring = std::max(largest_ring, other.largest_ring);
    global_remeshes += other.global_remeshes;
    cells_replaced += other.cells_replaced;
    vertices_inserted += other.vertices_inserted;
    return *this;
}

void carry_out(Mesh& mesh, const Cavity& cavity, Changes& changes) {
    for (std::size_t k = 0; k < cavity.inserted.size(); ++k) changes.vertices.push_back(next_vertex(mesh, k));
    const auto added = replace_cells(mesh, cavity);
    changes.cells.insert(changes.cells.end(), added.begin(), added.end());
    changes.removed.insert(changes.removed.end(), cavity.removed.begin(), cavity.removed.end());
    changes.cells_replaced += static_cast<int>(cavity.removed.size());
    changes.vertices_inserted += static_cast<int>(cavity.inserted.size());
}

Changes swap_for_energy(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    const double limit = passable_after_swap * options.good_enough;
    Changes changes;
    std::vector<Tet> tried;
    std::ranges::copy_if(cells, std::back_inserter(tried), [&](Tet t) { return alive(mesh, t); });
    for (int round = 0; round < most_swap_rounds && !tried.empty(); ++round) {
        const auto proposals =
            propose_all(tried.size(), [&](std::size_t i) { return swap_longest_edge(mesh, tried[i], limit); });
        Replaced replaced;
        std::vector<Tet> again;
        const std::size_t known = changes.cells.size();
        for (const auto& [i, cavity] : proposals) {
            if (replaced.outdates(cavity)) {
                again.push_back(tried[i]);
                continue;
            }
            replaced.add(cavity);
            kropla::carry_out(mesh, cavity, changes);
            ++changes.swaps;
        }
        again.insert(again.end(), changes.cells.begin() + static_cast<std::ptrdiff_t>(known), changes.cells.end());
        std::erase_if(again, [&](Tet t) { return !alive(mesh, t); });
        tried = std::move(again);
    }
    return changes;
}

Changes improve(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options,
                std::span<const Tet> changed) {
    Improvement work{mesh, at_time, options, BadCells(mesh, options.good_enough)};
    work.changes = swap_for_energy(mesh, cells, options);
    for (Tet t : changed) work.changed.insert(t);
    for (Tet t : work.changes.cells) work.changed.insert(t);
    for (Tet t : cells) work.bad.add(t);
    const std::size_t swapped = work.changes.cells.size();
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Tet> stuck;
        bool progress = false;
        while (const auto worst = work.bad.take()) {
            const auto [t, ratio] = *worst;
            if (swap_at(work, t) || smooth_at(work, t) || collapse_at(work, t, ratio) || split_at(work, t, ratio))
                progress = true;
            else stuck.push_back(t);
        }
        if (!progress || stuck.empty()) break;
        for (Tet t : stuck) work.bad.add(t);
    }
    const std::vector<Tet> added(work.changes.cells.begin() + static_cast<std::ptrdiff_t>(swapped), work.changes.cells.end());
    work.changes += swap_for_energy(mesh, added, options);
    return std::move(work.changes);
}

}  // namespace kropla
