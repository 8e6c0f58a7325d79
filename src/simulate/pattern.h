#pragma once

#include "simulate/linear_system.h"
#include "simulate/partition.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kropla {

/// A cell that has a row's vertex as a corner.
template <std::size_t n>
struct CellAtRow {
    std::uint32_t cell;                  // its place in Pattern::cells
    std::uint32_t corner;                // which the vertex is
    std::array<std::uint16_t, n> place;  // in the row, of the columns of its corners
};

template <std::size_t n>
struct CellsAtRows {
    std::vector<std::size_t> begin;  // owned rows + 1
    std::vector<CellAtRow<n>> cells;

    [[nodiscard]] std::span<const CellAtRow<n>> of(std::size_t row) const {
        return std::span(cells).subspan(begin[row], begin[row + 1] - begin[row]);
    }
};

/// The unknowns of a set of cells, one a vertex, and where each cell adds to the rows of a system: what there is to
/// know of a connectivity before anything is assembled on it.
struct Pattern {
    Numbering numbering;
    Cells cells;      // those with an unknown of the rank
    SparseRows rows;  // unknowns that share a cell
    CellsAtRows<4> tets;
    CellsAtRows<6> prisms;
};

/// `cells` are all of them, the same on each rank.
[[nodiscard]] Pattern make_pattern(const Mesh& mesh, const Cells& cells, const Ranks& ranks);

}  // namespace kropla
