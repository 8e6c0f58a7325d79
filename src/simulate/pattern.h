#pragma once

#include "simulate/linear_system.h"
#include "simulate/partition.h"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <type_traits>
#include <utility>
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
    Cells cells;      // those with an unknown of the rank, but for
    Cells upper;      // those at the upper side of an interface, where there are sides
    SparseRows rows;  // unknowns that share a cell
    CellsAtRows<4> tets;
    CellsAtRows<6> prisms;
    // Of `upper`, each corner twice: the second time with its further row, if it has one.
    CellsAtRows<8> upper_tets;
    CellsAtRows<12> upper_prisms;

    /// Of a vertex that has an unknown.
    [[nodiscard]] std::size_t piece_of(Vertex v) const { return rows.piece_of(static_cast<std::size_t>(numbering.row[v])); }
};

/// `cells` are all of them, the same on each rank. With `upper`, vertices of interfaces have a further row.
[[nodiscard]] Pattern make_pattern(const Mesh& mesh, const Cells& cells, const Ranks& ranks, UpperSides upper = {});

/// The rows of a cell's corners; with m twice their number, then the further ones, -1 where there is none.
template <std::size_t m, class Name>
[[nodiscard]] std::array<int, m> corner_rows(const Numbering& numbering, const Mesh& mesh, const Name& cell) {
    const auto vertices = cell_vertices(mesh, cell);
    constexpr std::size_t n = std::tuple_size_v<std::remove_cv_t<decltype(vertices)>>;
    static_assert(m == n || m == 2 * n);
    std::array<int, m> rows;
    for (std::size_t i = 0; i < n; ++i) {
        rows[i] = numbering.row[vertices[i]];
        if constexpr (m > n)
            rows[n + i] = numbering.is_upper(vertices[i], cell_region(mesh, cell)) ? rows[i] + 1 : -1;
    }
    return rows;
}

}  // namespace kropla
