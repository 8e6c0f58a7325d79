// Improvement of the worst cells first: for each, the operators in the order of what they cost the solution (a swap
// keeps all vertices, smoothing moves one, a collapse loses one, a split adds one), after the schedule of [Klingner,
// Shewchuk 2007], "Aggressive tetrahedral mesh improvement", here cell by cell from a queue, so that work is
// proportional to the bad cells. It ends, as each step lowers the worst aspect ratio of what it replaces.

#include "adapt/adapt.h"
#include "mesh/quality.h"

#include <algorithm>
#include <queue>

namespace kropla {
namespace {

constexpr double least_gain = 1e-3;
constexpr double swap_gain = 0.08;              // relative, of a swap where no cell is bad
constexpr double longest_after_collapse = 2.0;  // [target sizes]
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
    std::optional<Tet> take() {
        while (!queue_.empty()) {
            const auto [ratio, minus_name] = queue_.top();
            queue_.pop();
            const Tet t(-minus_name);
            if (alive(mesh_, t) && aspect_ratio(mesh_, t) == ratio) return t;
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
    BadCells& bad;
    Changes changes;

    void carry_out(const Cavity& cavity) {
        changes.cells_replaced += static_cast<int>(cavity.removed.size());
        changes.vertices_inserted += static_cast<int>(cavity.inserted.size());
        for (std::size_t k = 0; k < cavity.inserted.size(); ++k)
            changes.vertices.push_back(next_vertex(mesh, k));
        for (Tet t : replace_cells(mesh, cavity)) {
            changes.cells.push_back(t);
            bad.add(t);
        }
    }
};

void keep_better(std::optional<Cavity>& best, std::optional<Cavity> other) {
    if (other && (!best || other->worst_after < best->worst_after)) best = std::move(other);
}

bool swap_at(Improvement& work, Tet t) {
    const Mesh& mesh = work.mesh;
    const double ratio = aspect_ratio(mesh, t);
    std::optional<Cavity> best;
    for (int i = 0; i < 4; ++i) keep_better(best, face_removal(mesh, {t, i}));
    for (const auto& [i, j] : tet_edges) {
        const Edge e{mesh.tets[t][at(i)], mesh.tets[t][at(j)]};
        keep_better(best, edge_removal(mesh, shell(mesh, e, t), e));
    }
    const bool bad = ratio > work.options.good_enough;
    if (!best || (!bad && best->worst_after > (1 - swap_gain) * best->worst_before)) return false;
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

bool collapse_at(Improvement& work, Tet t) {
    const double bound = (1 - least_gain) * aspect_ratio(work.mesh, t);
    std::optional<Cavity> best;
    for (Vertex from : work.mesh.tets[t])
        for (Vertex to : work.mesh.tets[t]) {
            if (from == to) continue;
            auto cavity = edge_collapse(work.mesh, from, to, best ? best->worst_after : bound);
            if (cavity && !makes_long_edge(work, *cavity, to)) best = std::move(cavity);
        }
    if (!best) return false;
    work.carry_out(*best);
    ++work.changes.collapses;
    return true;
}

bool split_at(Improvement& work, Tet t) {
    const Mesh& mesh = work.mesh;
    const double bound = (1 - least_gain) * aspect_ratio(mesh, t);
    std::optional<Cavity> best;
    for (const auto& [i, j] : tet_edges) {
        const Edge e{mesh.tets[t][at(i)], mesh.tets[t][at(j)]};
        keep_better(best, edge_split(mesh, shell(mesh, e, t), e, best ? best->worst_after : bound));
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

Changes improve(Mesh& mesh, std::span<const Tet> cells, const Snapshot& at_time, const AdaptOptions& options) {
    BadCells bad(mesh, std::min(options.swap_above, options.good_enough));
    Improvement work{mesh, at_time, options, bad, {}};
    for (Tet t : cells) bad.add(t);
    for (int round = 0; round < most_rounds; ++round) {
        std::vector<Tet> stuck;
        bool progress = false;
        while (const auto t = bad.take()) {
            const bool bad_cell = aspect_ratio(mesh, *t) > options.good_enough;
            if (swap_at(work, *t)) progress = true;
            else if (!bad_cell) continue;
            else if (smooth_at(work, *t) || collapse_at(work, *t) || split_at(work, *t)) progress = true;
            else stuck.push_back(*t);
        }
        if (!progress || stuck.empty()) break;
        for (Tet t : stuck) bad.add(t);
    }
    return std::move(work.changes);
}

namespace {

/// The vertices of the cells worse than `above`, in order.
std::vector<Vertex> vertices_of_worse(const Mesh& mesh, std::span<const Tet> cells, double above) {
    std::vector<Vertex> vertices;
    for (Tet t : cells)
        if (aspect_ratio(mesh, t) > above)
            vertices.insert(vertices.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);
    vertices.erase(repeated.begin(), repeated.end());
    return vertices;
}

}  // namespace

Changes optimise_places(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    Changes changes;
    const auto note = [&](std::span<const Vertex> moved) {
        changes.vertices.insert(changes.vertices.end(), moved.begin(), moved.end());
        changes.moved += static_cast<int>(moved.size());
        changes.smoothing_sweeps += moved.empty() ? 0 : 1;
    };
    const auto poor = vertices_of_worse(mesh, cells, options.smooth_above);
    for (const LaplaceWeights& weights : {LaplaceWeights{0, 1}, LaplaceWeights{1, 0}})
        note(smooth_guarded(mesh, poor, weights));
    for (int sweep = 0; sweep < options.relaxations; ++sweep) note(relax(mesh, poor));

    std::vector<Vertex> optimised;
    for (Vertex v : vertices_of_worse(mesh, cells, options.good_enough))
        if (optimise_vertex(mesh, v, 0.9 * options.good_enough)) optimised.push_back(v);
    note(optimised);
    return changes;
}

}  // namespace kropla
