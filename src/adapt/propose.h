#pragma once

#include <kropla/adapt/adapt.h>
#include "base/for_all.h"
#include "mesh/index_set.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

namespace kropla {

/// What is proposed, and the number for which it was asked.
template <class What>
struct Proposal {
    std::size_t asked;
    What what;
};

/// What `propose` says for 0 ... count - 1, in this order, where it says something (it returns an optional); asked
/// by several threads at once on a mesh that nothing changes meanwhile: the same for any number of threads. Throws
/// Interrupted if the watch says so.
template <class Propose>
[[nodiscard]] auto propose_all(std::size_t count, Propose propose, const Watch* watch = nullptr) {
    using What = typename decltype(propose(count))::value_type;
    constexpr std::size_t at_once = 64;
    std::vector<std::vector<Proposal<What>>> parts((count + at_once - 1) / at_once);
    for_all(parts.size(), [&](std::size_t part) {
        heed(watch);
        for (std::size_t i = at_once * part; i < std::min(count, at_once * (part + 1)); ++i)
            if (auto what = propose(i)) parts[part].push_back({i, std::move(*what)});
    }, 1);
    std::vector<Proposal<What>> all;
    for (auto& part : parts) std::ranges::move(part, std::back_inserter(all));
    return all;
}

/// Cells that have been replaced or have moved since proposals were made: a proposal that would replace one of
/// them is out of date, all others are as good as they were.
class Replaced {
public:
    void add(const Cavity& cavity) {
        for (Tet t : cavity.removed) cells_.insert(t);
    }
    [[nodiscard]] bool contains(Tet t) const { return cells_.contains(t); }
    [[nodiscard]] bool outdates(const Cavity& cavity) const {
        return std::ranges::any_of(cavity.removed, [&](Tet t) { return cells_.contains(t); });
    }

private:
    IndexSet<Tet> cells_;
};

/// The best of the swaps that take one of these edges of the cell away, or, if so asked, one of its facets, and whose worst
/// cell is better than `bound`.
[[nodiscard]] std::optional<Cavity> best_swap(const Mesh& mesh, Tet t, std::span<const std::size_t> edges, bool facets,
                                              double bound);

/// Fills what an edge leaves on one side of a surface, between this and the others of its shell's ring, in the order of
/// the ring from one end on the surface to the other, with cells that do not have the edge: the best. Returns false, and
/// adds none, if that cannot be, or the ring is longer than `longest_ring`.
[[nodiscard]] bool fill_half(const Mesh& mesh, Edge edge, std::span<const Vertex> ring, Region region, Cavity& cavity);

/// Is the cell still there, and worse than that [-] R/r? How many are?
[[nodiscard]] bool is_worse(const Mesh& mesh, Tet t, double than);
[[nodiscard]] int count_worse(const Mesh& mesh, std::span<const Tet> cells, double than);

/// Is one of the cells turned over, flat, or not finite?
[[nodiscard]] bool is_tangled(const Mesh& mesh, std::span<const Tet> cells);

/// Would the mesh still be one: each facet between two cells or on the boundary as before, and no edge or facet of the
/// added cells elsewhere already? For a proposal of positive cells this goes without saying if all cells of the mesh are
/// positive, too; but not in one that is tangled, where cells lie over each other.
[[nodiscard]] bool fits(const Mesh& mesh, const Cavity& cavity);

}  // namespace kropla
