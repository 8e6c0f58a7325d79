// Improvement of the worst cells first: for each, the operators in the order of what they cost the solution
// (a swap keeps all vertices, smoothing moves one, a collapse loses one, a split adds one), after the
// schedule of [Klingner, Shewchuk 2007], "Aggressive tetrahedral mesh improvement", here cell by cell, so that
// work is proportional to the bad cells. What helps is asked, by several threads, for those at once that share no
// vertex with a worse one, and carried out the worst first; what has been overtaken by others is asked anew. Each
// step lowers the worst aspect ratio of what it replaces; that it ends soon, in any mesh, is due to a budget.

#include "adapt/budget.h"
#include "adapt/constants.h"
#include "adapt/propose.h"
#include "adapt/star.h"
#include "adapt/zone.h"
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <iterator>

namespace kropla {
namespace {

enum class Kind { swap, move, collapse, split };

/// What helps a bad cell: other cells in the place of some; or another place for a vertex, whose ball then stands
/// as what is removed, with nothing added.
struct Operation {
    Kind kind;
    Cavity cavity;
    Vertex moved = {};
    Vec3 place = {};
};

struct BadCell {
    double ratio;
    Tet cell;
};

/// What replaces the cell must be better than this.
double bound(const BadCell& bad) { return (1 - least_gain) * bad.ratio; }

bool comes_before(const BadCell& a, const BadCell& b) {
    return std::pair(-a.ratio, a.cell) < std::pair(-b.ratio, b.cell);
}

/// Adds those of the cells that are bad to the list, which stays in order: the worst first, ties by number. None of
/// them is there yet.
void add_bad(const Mesh& mesh, std::vector<Tet> cells, double above, std::vector<BadCell>& bad) {
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const auto known = static_cast<std::ptrdiff_t>(bad.size());
    for (Tet t : cells)
        if (alive(mesh, t))
            if (const double ratio = aspect_ratio(mesh, t); ratio > above) bad.push_back({ratio, t});
    std::sort(bad.begin() + known, bad.end(), comes_before);
    std::inplace_merge(bad.begin(), bad.begin() + known, bad.end(), comes_before);
}

std::array<double, 6> squared_edges(const Mesh& mesh, Tet t) {
    std::array<double, 6> lengths;
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [a, b] = tet_edge(mesh, t, k);
        const double square = squared_norm(mesh.position[a] - mesh.position[b]);
        lengths[k] = square >= 0 ? square : infinity;  // of places that are not finite
    }
    return lengths;
}

/// The edges of the cell, as in tet_edges, the longest first.
std::array<std::size_t, 6> edges_by_length(const Mesh& mesh, Tet t) {
    const auto lengths = squared_edges(mesh, t);
    std::array<std::size_t, 6> edges = {0, 1, 2, 3, 4, 5};
    std::ranges::sort(edges, [&](std::size_t a, std::size_t b) {
        return lengths[a] > lengths[b] || (lengths[a] == lengths[b] && a < b);
    });
    return edges;
}

std::size_t longest_edge(const Mesh& mesh, Tet t) {
    const auto lengths = squared_edges(mesh, t);
    return static_cast<std::size_t>(std::ranges::max_element(lengths) - lengths.begin());
}

bool is_obtuse_at(const Mesh& mesh, Tet t, std::size_t edge) {
    const auto place = [&](int corner) { return mesh.position[mesh.tets[t][as_size(corner)]]; };
    const auto [i, j] = tet_edges[edge];
    const auto [k, l] = tet_edges[5 - edge];
    const Vec3 along = place(j) - place(i);
    return dot(cross(along, place(k) - place(i)), cross(along, place(l) - place(i))) < 0;
}

/// The vertex across the facet opposite the corner, if it is not on the boundary.
Vertex vertex_across(const Mesh& mesh, Tet t, int corner) {
    const Tet n = mesh.neighbour[t][as_size(corner)];
    return n.exists() ? mesh.tets[n][as_size(mirror_corner(mesh, {t, corner}))] : Vertex{};
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
    const double diagonal = std::min(length(v[as_size(k)], across_k), length(v[as_size(l)], across_l));
    return diagonal < diagonal_tolerance * diagonal_tolerance * length(v[as_size(i)], v[as_size(j)]);
}

/// The swap at a cell that is for the energy: away with its longest edge, where it is obtuse, if three or four
/// cells stand around it. (Longer rings, shorter edges and facets, tried on the default case, make 80 % of the
/// questions and 5 % of the swaps.)
std::optional<Cavity> swap_longest_edge(const Mesh& mesh, Tet t, double limit) {
    const std::size_t longest = longest_edge(mesh, t);
    if (!is_obtuse_at(mesh, t, longest) || !may_be_swapped(mesh, t, longest)) return std::nullopt;
    const Edge e = tet_edge(mesh, t, longest);
    const Shell around = shell(mesh, e, t);
    if (around.ring.size() > 4) return std::nullopt;
    return edge_removal(mesh, around, e, {true, limit});
}

/// Asked for what helps; sees the mesh, and the cells that are new or have moved already.
struct Operators {
    const Mesh& mesh;
    const Snapshot& at_time;
    const AdaptOptions& options;
    const IndexSet<Tet>& changed;
    bool may_split;

    [[nodiscard]] std::optional<Operation> first_that_helps(const BadCell& bad) const;
    [[nodiscard]] std::optional<Operation> move(Tet t) const;
    [[nodiscard]] std::optional<Cavity> collapse(const BadCell& bad) const;
    [[nodiscard]] std::optional<Cavity> split(const BadCell& bad) const;
    [[nodiscard]] bool makes_long_edge(const Cavity& cavity, Vertex to) const;
};

std::optional<Operation> Operators::first_that_helps(const BadCell& bad) const {
    // By one of the three longest edges: in the default case they make 96 % of the swaps, for a third of the work.
    const auto edges = edges_by_length(mesh, bad.cell);
    const auto swap = [&](std::span<const std::size_t> some, bool facets) {
        return best_swap(mesh, bad.cell, some, facets, bound(bad));
    };
    if (auto cavity = swap(std::span(edges).first(3), false)) return Operation{Kind::swap, std::move(*cavity)};
    if (auto other_place = move(bad.cell)) return other_place;
    if (auto cavity = swap(std::span(edges).last(3), true)) return Operation{Kind::swap, std::move(*cavity)};
    if (auto cavity = collapse(bad)) return Operation{Kind::collapse, std::move(*cavity)};
    if (!may_split) return std::nullopt;
    if (auto cavity = split(bad)) return Operation{Kind::split, std::move(*cavity)};
    return std::nullopt;
}

/// Moves the vertex that makes the cell good enough at the least cost to the solution, as each cell at it that is
/// still as it was has to be projected; or, if none does, makes it the best.
std::optional<Operation> Operators::move(Tet t) const {
    struct Candidate {
        std::ptrdiff_t cost;
        Vertex vertex;
        std::vector<Tet> around;
    };
    std::array<Candidate, 4> by_cost;
    for (std::size_t i = 0; i < 4; ++i) {
        auto& [cost, v, around] = by_cost[i];
        v = mesh.tets[t][i];
        ball(mesh, v, around);
        cost = std::ranges::count_if(around, [&](Tet n) { return !changed.contains(n); });
    }
    std::ranges::sort(by_cost, {}, [](const Candidate& c) { return std::pair(c.cost, c.vertex); });
    Candidate* chosen = nullptr;
    Place best{{}, infinity};
    for (Candidate& candidate : by_cost) {
        const Place place = better_place(mesh, candidate.vertex, candidate.around, smoothing_goal * options.good_enough);
        if (place.x == mesh.position[candidate.vertex] || place.worst >= best.worst) continue;
        chosen = &candidate;
        best = place;
        if (best.worst <= options.good_enough) break;
    }
    if (!chosen) return std::nullopt;
    Operation operation{Kind::move, {}, chosen->vertex, best.x};
    operation.cavity.removed = std::move(chosen->around);
    return operation;
}

bool Operators::makes_long_edge(const Cavity& cavity, Vertex to) const {
    const Vec3 place = mesh.position[to];
    const double longest = longest_by_quality * target_size(at_time, place);
    return std::ranges::any_of(cavity.added, [&](const NewTet& t) {
        return std::ranges::any_of(t.vertices, [&](Vertex v) { return distance(mesh.position[v], place) > longest; });
    });
}

std::optional<Cavity> Operators::collapse(const BadCell& bad) const {
    std::optional<Cavity> best;
    std::vector<Tet> around;
    for (Vertex from : mesh.tets[bad.cell]) {
        ball(mesh, from, around);
        for (Vertex to : mesh.tets[bad.cell]) {
            if (from == to) continue;
            auto cavity = edge_collapse(mesh, from, to, around, best ? best->worst_after : bound(bad));
            if (cavity && !makes_long_edge(*cavity, to)) best = std::move(cavity);
        }
    }
    return best;
}

std::optional<Cavity> Operators::split(const BadCell& bad) const {
    std::optional<Cavity> best;
    Shell around;
    for (std::size_t k = 0; k < tet_edges.size(); ++k) {
        const Edge e = tet_edge(mesh, bad.cell, k);
        shell(mesh, e, bad.cell, around);
        auto cavity = edge_split(mesh, around, e, best ? best->worst_after : bound(bad));
        if (cavity && (!best || cavity->worst_after < best->worst_after)) best = std::move(cavity);
    }
    return best;
}

/// Carries the operation out and notes it. Returns the cells that are new or have moved.
std::vector<Tet> apply(Mesh& mesh, Operation& operation, Changes& changes) {
    if (operation.kind == Kind::move) {
        mesh.position[operation.moved] = operation.place;
        ++changes.moved;
        changes.vertices.push_back(operation.moved);
        return std::move(operation.cavity.removed);
    }
    int& count = operation.kind == Kind::swap       ? changes.swaps
                 : operation.kind == Kind::collapse ? changes.collapses
                                                    : changes.splits;
    ++count;
    const auto known = static_cast<std::ptrdiff_t>(changes.cells.size());
    carry_out(mesh, operation.cavity, changes);
    return {changes.cells.begin() + known, changes.cells.end()};
}

/// Takes out those of `bad` that share no vertex with a worse one: what helps one of them may help those beside.
std::vector<BadCell> take_apart(const Mesh& mesh, std::vector<BadCell>& bad) {
    std::vector<BadCell> apart, rest;
    IndexSet<Vertex> taken;
    for (const BadCell& b : bad) {
        const auto& v = mesh.tets[b.cell];
        const bool is_beside = std::ranges::any_of(v, [&](Vertex corner) { return taken.contains(corner); });
        (is_beside ? rest : apart).push_back(b);
        for (Vertex corner : v) taken.insert(corner);
    }
    bad = std::move(rest);
    return apart;
}

/// What improvement may do.
struct Allowed {
    Budget treatments{least_treatments}, splits{least_splits};

    void add_for(std::size_t bad, const AdaptOptions& options) {
        treatments.add(options.treatments * static_cast<double>(bad));
        splits.add(splits_per_bad_cell * static_cast<double>(bad));
    }
};

/// Treats the bad cells until none is left that anything helps, or what is allowed has been done. Returns those that are
/// left; `changed` and `changes` grow.
std::vector<Tet> treat(Mesh& mesh, std::vector<BadCell> bad, const Snapshot& at_time, const AdaptOptions& options,
                       Allowed& allowed, IndexSet<Tet>& changed, Changes& changes) {
    std::vector<Tet> stuck;
    const bool tangled = !bad.empty() && bad.front().ratio == infinity;
    while (!bad.empty()) {
        heed(options.watch);
        if (allowed.treatments.spent()) {
            for (const BadCell& b : bad) stuck.push_back(b.cell);
            break;
        }
        const auto asked = take_apart(mesh, bad);
        allowed.treatments.take(static_cast<double>(asked.size()));
        changes.treated += static_cast<int>(asked.size());
        const Operators operators{mesh, at_time, options, changed, !allowed.splits.spent()};
        const auto ask = [&](std::size_t i) { return operators.first_that_helps(asked[i]); };
        auto operations = propose_all(asked.size(), ask, options.watch);
        std::vector<Tet> again;
        Replaced replaced;
        std::size_t i = 0;
        for (auto& [which, operation] : operations) {
            for (; i < which; ++i) stuck.push_back(asked[i].cell);
            ++i;
            if (replaced.outdates(operation.cavity)) {
                again.push_back(asked[which].cell);
                continue;
            }
            if (tangled && operation.kind != Kind::move && !fits(mesh, operation.cavity)) {
                stuck.push_back(asked[which].cell);
                continue;
            }
            replaced.add(operation.cavity);
            if (operation.kind == Kind::split) allowed.splits.take(1);
            for (Tet t : apply(mesh, operation, changes)) {
                changed.insert(t);
                again.push_back(t);
            }
        }
        for (; i < asked.size(); ++i) stuck.push_back(asked[i].cell);
        std::erase_if(bad, [&](const BadCell& b) { return replaced.contains(b.cell); });
        add_bad(mesh, std::move(again), options.good_enough, bad);
    }
    return stuck;
}

/// Re-triangulates the cell with the ring around it; with two, which costs far more, if it is far from good.
void retriangulate(Mesh& mesh, const BadCell& bad, const Snapshot& at_time, const AdaptOptions& options,
                   Budget& budget, Changes& changes) {
    std::vector<Tet> cluster = {bad.cell};
    const int rings = bad.ratio > two_rings_above * options.good_enough ? 2 : 1;
    for (int ring = 1; ring <= rings; ++ring) {
        cluster = with_ring(mesh, cluster);
        const auto cavity = cluster_remesh(mesh, cluster, at_time, options, budget);
        if (!cavity || cavity->worst_after > bound(bad)) continue;
        carry_out(mesh, *cavity, changes);
        ++changes.local_remeshes;
        changes.largest_ring = std::max(changes.largest_ring, ring);
        return;
    }
}

/// The same for all cells that nothing else has helped. Returns whether the budget is spent.
bool retriangulate(Mesh& mesh, const std::vector<Tet>& stuck, const Snapshot& at_time, const AdaptOptions& options,
                   std::size_t cells, Changes& changes) {
    const double allowed = cells_to_cut_out(cells, options);
    Budget budget(allowed);
    for (Tet t : stuck) {
        heed(options.watch);
        if (budget.spent()) break;
        if (!alive(mesh, t)) continue;
        if (const double ratio = aspect_ratio(mesh, t); ratio > options.good_enough)
            retriangulate(mesh, BadCell{ratio, t}, at_time, options, budget, changes);
    }
    changes.cut_out += static_cast<int>(allowed - budget.left());
    return budget.spent();
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
    treated += other.treated;
    cut_out += other.cut_out;
    given_up += other.given_up;
    return *this;
}

void carry_out(Mesh& mesh, const Cavity& cavity, Changes& changes) {
    const auto [added, inserted] = replace_cells(mesh, cavity);
    changes.vertices.insert(changes.vertices.end(), inserted.begin(), inserted.end());
    changes.cells.insert(changes.cells.end(), added.begin(), added.end());
    changes.removed.insert(changes.removed.end(), cavity.removed.begin(), cavity.removed.end());
    changes.cells_replaced += static_cast<int>(cavity.removed.size());
    changes.vertices_inserted += static_cast<int>(cavity.inserted.size());
}

Changes swap_for_energy(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options) {
    return swap_for_energy(mesh, cells, options, is_tangled(mesh, cells));
}

Changes swap_for_energy(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options, bool tangled) {
    const double limit = passable_after_swap * options.good_enough;
    Changes changes;
    std::vector<Tet> tried;
    std::ranges::copy_if(cells, std::back_inserter(tried), [&](Tet t) { return alive(mesh, t); });
    for (int round = 0; round < most_swap_rounds && !tried.empty(); ++round) {
        const auto proposals =
            propose_all(tried.size(), [&](std::size_t i) { return swap_longest_edge(mesh, tried[i], limit); },
                        options.watch);
        Replaced replaced;
        std::vector<Tet> again;
        const std::size_t known = changes.cells.size();
        for (const auto& [i, cavity] : proposals) {
            if (replaced.outdates(cavity)) {
                again.push_back(tried[i]);
                continue;
            }
            if (tangled && !fits(mesh, cavity)) continue;
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
                std::span<const Tet> known_changed) {
    Changes changes = swap_for_energy(mesh, cells, options);
    IndexSet<Tet> changed;
    for (Tet t : known_changed) changed.insert(t);
    for (Tet t : changes.cells) changed.insert(t);
    std::vector<Tet> left(cells.begin(), cells.end());
    left.insert(left.end(), changes.cells.begin(), changes.cells.end());
    const auto swapped = static_cast<std::ptrdiff_t>(changes.cells.size());
    Allowed allowed;
    for (int round = 0; round < most_rounds && !left.empty(); ++round) {
        const std::size_t before = changes.cells.size() + changes.vertices.size();
        std::vector<BadCell> bad;
        add_bad(mesh, std::move(left), options.good_enough, bad);
        if (round == 0) allowed.add_for(bad.size(), options);
        left = treat(mesh, std::move(bad), at_time, options, allowed, changed, changes);
        if (changes.cells.size() + changes.vertices.size() == before) break;
    }
    bool spent = allowed.treatments.spent();
    if (options.clusters) spent |= retriangulate(mesh, left, at_time, options, cells.size(), changes);
    if (spent) changes.given_up += count_worse(mesh, left, options.good_enough);
    const std::vector<Tet> added(changes.cells.begin() + swapped, changes.cells.end());
    changes += swap_for_energy(mesh, added, options);
    return changes;
}

}  // namespace kropla
