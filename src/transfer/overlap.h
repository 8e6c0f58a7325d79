#pragma once

#include <kropla/base/watch.h>
#include "transfer/changed.h"
#include <kropla/transfer/transfer.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// What one vertex of the old mesh gives to a new cell: the integrals over the cell of its shape function
/// times each of the cell's four [m^3].
struct NodalShare {
    Vertex from;
    std::array<double, 4> weight;
};
/// What the new cell has in common with one old cell.
struct CellShare {
    std::int32_t gone;  // place in ChangedCells::gone
    double share;       // [-] of the new cell's volume
};

/// The common refinement of old and new cells, as sums per new cell, by its place in ChangedCells::come.
struct Overlaps {
    static constexpr std::size_t chunk_size = 128;  // cells
    struct Chunk {
        std::vector<std::uint32_t> nodal_end, cell_end;  // per new cell
        std::vector<NodalShare> nodal;
        std::vector<CellShare> cell;
        std::size_t searched = 0;
        double worst_gap = 0;
    };
    std::vector<Chunk> chunks;
    std::size_t searched = 0;  // cells for which walking was not enough
    double worst_gap = 0;      // [-] the most that a new cell's shares miss 1, before they are scaled

    [[nodiscard]] std::span<const NodalShare> nodal(std::size_t come) const;
    [[nodiscard]] std::span<const CellShare> cell(std::size_t come) const;
};

/// Intersects each new cell with the old ones it overlaps, within its region. The old cells are found from
/// neighbour to neighbour, starting from where the new cell's centre is; if their parts do not add up to the
/// new cell to 1e-12, all old cells of the region near it are tried. What is left, where the region's surface has changed,
/// is shared out as the rest is; a cell within no old one gets all from the nearest. Parts that meet at a facet of the old mesh share
/// their cut, computed from the same plane by the same operations, so that they leave no gap and do not
/// overlap, but for the rounding of the corners of the parts. The result does not depend on the number of
/// threads. Throws Interrupted if the watch says so.
[[nodiscard]] Overlaps overlaps(const Mesh& before, const Mesh& after, const ChangedCells& changed,
                                const Watch* watch = nullptr);

/// Where these places are among the old cells, of whatever region: in the cell whose weights are least negative, if none
/// has it inside.
[[nodiscard]] std::vector<Location> locate_in_gone(const Mesh& before, const ChangedCells& changed,
                                                   std::span<const Vec3> places);

}  // namespace kropla
