#pragma once

#include "transfer/overlap.h"
#include "transfer/slot_map.h"

#include <span>
#include <vector>

namespace kropla {

/// Connected groups of changed cells, each within one region: what is projected at once. A cluster may grow
/// by cells that did not change, so that more of its vertices are free; clusters that meet become one.
class Clusters {
public:
    Clusters() = default;
    Clusters(const Mesh& after, const ChangedCells& changed);
    /// Gives each old cell to the cluster that has the largest part of it.
    void share_out(const ChangedCells& changed, const Overlaps& overlaps);

    /// Numbers of clusters go from 0 to count() - 1; one that was taken in by another has no cells any more.
    [[nodiscard]] std::size_t count() const { return cells_.size(); }
    [[nodiscard]] std::int32_t cluster_of(Tet t) const {
        return t.exists() ? owner(owner_.find(t.value)) : -1;
    }
    [[nodiscard]] std::span<const Tet> cells(std::size_t cluster) const { return cells_[cluster]; }
    /// The old cells that fill the place of its changed ones, by their places in ChangedCells::gone; none
    /// before they are shared out.
    [[nodiscard]] std::span<const std::int32_t> gone(std::size_t cluster) const { return gone_[cluster]; }
    /// The cluster that has taken this one in; itself, if none has.
    [[nodiscard]] std::size_t now(std::size_t cluster) const {
        return static_cast<std::size_t>(owner(static_cast<std::int32_t>(cluster)));
    }

    /// Whether it has a vertex whose ball is all in it and that no interface or layer holds.
    [[nodiscard]] bool has_free_vertex(const Mesh& after, std::size_t cluster);

    /// Takes in the balls of the vertices at its rim that no interface or layer holds: of those that no other
    /// cluster shares; if there are none, of all; and if there are none of these either, as in a gap of one
    /// cell between two interfaces, the cells beyond its rim. Returns whether that added any cell: if not, it
    /// fills its region. It may be another cluster's from then on: see `now`.
    bool grow(const Mesh& after, std::size_t cluster);

private:
    [[nodiscard]] std::int32_t owner(std::int32_t cluster) const {
        while (cluster >= 0 && taken_by_[static_cast<std::size_t>(cluster)] != cluster)
            cluster = taken_by_[static_cast<std::size_t>(cluster)];
        return cluster;
    }
    [[nodiscard]] bool is_alone(std::span<const Tet> ball, std::size_t cluster) const;
    void claim(Tet t, std::size_t cluster);
    void unite(std::size_t a, std::size_t b);

    SlotMap owner_;
    std::vector<std::int32_t> taken_by_;
    std::vector<std::vector<Tet>> cells_;
    std::vector<std::vector<std::int32_t>> gone_;
    std::vector<bool> has_free_;  // known to; it stays so when it grows
};

/// The vertices of the cluster that are held: as it ends there, or as they are of an interface or a layer's
/// shell.
[[nodiscard]] SlotMap held_vertices(const Mesh& after, const Clusters& clusters, std::size_t cluster);

}  // namespace kropla
