// Improvement of the worst cells first: for each, the operators in the order of what they cost the solution
// (a swap keeps all vertices, smoothing moves one, a collapse loses one, a split adds one), after the
// schedule of [Klingner, Shewchuk 2007], "Aggressive tetrahedral mesh improvement", here cell by cell from a
// queue, so that work is proportional to the bad cells. It ends, as each step lowers the worst aspect ratio
// of what it replaces.

#include "adapt/propose.h"
#include "mesh/quality.h"

#include <algorithm>
#include <iterator>
#include <queue>

namespace kropla {
namespace {

constexpr double least_gain = 1e-3;
constexpr double passable_after_swap = 0.96;    // of good_enough: no swap for the energy makes a worse cell
constexpr double longest_after_collapse = 2.0;  // [target sizes]
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
    Shell around = {};  // room for questions
    Changes changes = {};

    void carry_out(const Cavity& cavity) {
        const std::size_t known = changes.cells.size();
        kropla::carry_out(mesh, cavity, changes);
        for (std::size_t i = known; i < changes.cells.size(); ++i) bad.add(changes.cells[i]);
    }
};

void keep_better(std::optional<Cavity>& best, std::optional<Cavity> other) {
    if (!other) return;
    const auto gain = [](const Cavity& c) { return c.worst_before - c.worst_after; };
    if (!best || gain(*other) > gain(*best)) best = std::move(other);
}

/// Which swaps can make a cell flatter than it should be better: an edge at which it is obtuse (a sliver, a
/// wedge), and a facet under all of whose edges it is not (a cap: the opposite corner stands above the
/// facet).
struct Promising {
    std::array<bool, 6> edge{};   // as tet_edges
    std::array<bool, 4> facet{};
};

Promising promising_swaps(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    const Vec3 &a = mesh.position[v[0]], &b = mesh.position[v[1]], &c = mesh.position[v[2]], &d = mesh.position[v[3]];
    const std::array<Vec3, 4> normal = {cross(c - b, d - b), cross(d - a, c - a), cross(b - a, d - a),
                                        cross(c - a, b - a)};  // outwards, by the opposite corner
    Promising promising;
    promising.facet.fill(true);
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [i, j] = tet_edges[5 - k];  // the facets at edge k are opposite the ends of the other edge
        if (dot(normal[at(i)], normal[at(j)]) <= 0) continue;
        promising.edge[k] = true;
        promising.facet[at(i)] = promising.facet[at(j)] = false;
    }
    return promising;
}

/// The swap at a passable cell that lowers the energy most.
std::optional<Cavity> best_for_energy(const Mesh& mesh, Tet t, double limit) {
    const SwapGoal goal{true, limit};
    const Promising promising = promising_swaps(mesh, t);
    std::optional<Cavity> best;
    for (int i = 0; i < 4; ++i)
        if (promising.facet[at(i)]) keep_better(best, face_removal(mesh, {t, i}, goal));
    Shell around;
    for (std::size_t k = 0; k < 6; ++k) {
        if (!promising.edge[k]) continue;
        const Edge e{mesh.tets[t][at(tet_edges[k][0])], mesh.tets[t][at(tet_edges[k][1])]};
        shell(mesh, e, t, around);
        keep_better(best, edge_removal(mesh, around, e, goal));
    }
    return best;
}

/// Swaps at passable cells, in the order given; where a swap has been overtaken by another, and at new cells,
/// again.
void swap_for_energy(Improvement& work, std::span<const Tet> cells) {
    const Mesh& mesh = work.mesh;
    const double limit = passable_after_swap * work.options.good_enough;
    const auto is_passable = [&](Tet t) {
        if (!alive(mesh, t)) return false;
        const double ratio = aspect_ratio(mesh, t);
        return ratio > work.options.swap_above && ratio <= work.options.good_enough;
    };
    std::vector<Tet> passable;
    std::ranges::copy_if(cells, std::back_inserter(passable), is_passable);
    for (int round = 0; round < most_swap_rounds && !passable.empty(); ++round) {
        auto proposals =
            propose_all(passable.size(), [&](std::size_t i) { return best_for_energy(mesh, passable[i], limit); });
        Replaced replaced;
        std::vector<Tet> again;
        for (std::size_t i = 0; i < passable.size(); ++i) {
            if (!proposals[i]) continue;
            if (replaced.outdates(*proposals[i])) {
                again.push_back(passable[i]);
                continue;
            }
            replaced.add(*proposals[i]);
            const std::size_t known = work.changes.cells.size();
            carry_out(work.mesh, *proposals[i], work.changes);
            ++work.changes.swaps;
            again.insert(again.end(), work.changes.cells.begin() + static_cast<std::ptrdiff_t>(known),
                         work.changes.cells.end());
        }
        std::erase_if(again, [&](Tet t) { return !is_passable(t); });
        passable = std::move(again);
    }
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

bool smooth_at(Improvement& work, Tet t) {
    bool moved = false;
    const auto corners = work.mesh.tets[t];
    for (Vertex v : corners) {
        if (!optimise_vertex(work.mesh, v, 0.9 * work.options.good_enough)) continue;
        moved = true;
        ++work.changes.moved;
        work.changes.vertices.push_back(v);
        for (Tet changed : ball(work.mesh, v)) work.bad.add(changed);
        if (aspect_ratio(work.mesh, t) <= work.options.good_enough) break;
    }
    return moved;
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

Changes improve(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options) {
    Improvement work{mesh, at_time, options, BadCells(mesh, options.good_enough)};
    swap_for_energy(work, cells);
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
    swap_for_energy(work, added);
    return std::move(work.changes);
}

}  // namespace kropla
