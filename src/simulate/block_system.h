#pragma once

#include "base/for_all.h"
#include <kropla/base/watch.h>
#include "simulate/pattern.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <span>
#include <vector>

namespace kropla {

/// Unknowns a vertex of a block system: three of velocity and the pressure.
inline constexpr std::size_t block_size = 4;
inline constexpr std::size_t block_entries = block_size * block_size;

/// What a cell of n corners adds to the rows of its corners: the block of row i and column j from
/// block_entries * (n i + j) on, column by column as PETSc keeps blocks, and the residual of row i.
template <std::size_t n>
struct CellBlocks {
    alignas(32) std::array<double, block_entries * n * n> matrix;
    std::array<double, block_size * n> residual;

    [[nodiscard]] double* block(std::size_t i, std::size_t j) {
        return matrix.data() + block_entries * (n * i + j);
    }
};

/// A pattern whose rows are shared out in parts, near each other in space, with the cells at each: what one
/// thread assembles by itself. Cells astride two parts are asked for by both, so that nothing is kept of a
/// cell, every row has its sum in the cells' order and no two threads write to one row: the same bits for any
/// number of threads and of ranks.
struct BlockPattern {
    struct Part {
        std::size_t first_row, end_row;            // owned rows
        std::vector<std::uint32_t> tets, prisms;  // places in Pattern::cells, ascending
        std::vector<std::uint32_t> upper_tets, upper_prisms;  // in Pattern::upper
    };
    Pattern pattern;
    std::vector<Part> parts;
};
[[nodiscard]] BlockPattern make_block_pattern(const Mesh& mesh, const Cells& cells, const Ranks& ranks,
                                              UpperSides upper = {});

/// The rows of a block system that one rank owns.
struct BlockSystem {
    std::span<double> value;       // block_entries for each of the pattern's rows.column, as in CellBlocks
    std::vector<double> residual;  // block_size per owned row

    [[nodiscard]] double* block(std::size_t place) { return value.data() + block_entries * place; }
};

/// Adds the residual of one cell, and its blocks if they are wanted, to the rows of the part. `next` is, for
/// each row of the part, the place of its next cell in `at.cells`.
template <std::size_t n>
void add_cell(const SparseRows& rows, const CellsAtRows<n>& at, const BlockPattern::Part& part,
              std::size_t cell, const std::array<std::size_t, n>& row_of_corner, CellBlocks<n>& blocks,
              bool matrix, std::vector<std::size_t>& next, BlockSystem& system) {
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t row = row_of_corner[i];  // huge if before the first
        if (row < part.first_row || row >= part.end_row) continue;
        const CellAtRow<n>& here = at.cells[next[row - part.first_row]++];
        assert(here.cell == cell && here.corner == i);
        (void)cell;
        for (std::size_t k = 0; k < block_size; ++k)
            system.residual[block_size * row + k] += blocks.residual[block_size * i + k];
        if (!matrix) continue;
        const auto begin = static_cast<std::size_t>(rows.begin[row]);
        for (std::size_t j = 0; j < n; ++j) {
            double* const to = system.block(begin + here.place[j]);
            const double* const from = blocks.block(i, j);
            for (std::size_t k = 0; k < block_entries; ++k) to[k] += from[k];
        }
    }
}

/// Of a cell at the upper side of an interface: the last of the unknowns, which is once per side, has the further rows
/// of the corners that have one, behind all others.
template <std::size_t n>
void part_sides(const CellBlocks<n>& whole, const std::array<int, 2 * n>& rows, bool matrix, CellBlocks<2 * n>& parted) {
    constexpr std::size_t last = block_size - 1;
    if (matrix) parted.matrix.fill(0);
    parted.residual.fill(0);
    const auto corner_of = [&](std::size_t i, std::size_t k) { return k == last && rows[n + i] >= 0 ? n + i : i; };
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < block_size; ++k) {
            const std::size_t row = corner_of(i, k);
            parted.residual[block_size * row + k] = whole.residual[block_size * i + k];
            for (std::size_t j = 0; matrix && j < n; ++j)
                for (std::size_t c = 0; c < block_size; ++c)
                    parted.block(row, corner_of(j, c))[block_size * c + k] =
                        whole.matrix[block_entries * (n * i + j) + block_size * c + k];
        }
}

/// Fills the residual, and the matrix if it is wanted (else it stays), by `kernel(cell, CellBlocks<n>&)`,
/// which is asked from several threads at once and sets all that is wanted of a cell. If it can, it is asked for the
/// residuals alone of four tets at once, `kernel(std::array<Tet, 4>, std::array<CellBlocks<4>, 4>&)`, which is to give the
/// same bits. Throws Interrupted if the watch says so.
template <class Kernel>
void assemble_blocks(const Mesh& mesh, const BlockPattern& blocks, const Kernel& kernel, bool matrix,
                     BlockSystem& system, const Watch* watch) {
    const Pattern& pattern = blocks.pattern;
    system.residual.resize(block_size * pattern.rows.count());
    const auto add_all = [&]<std::size_t n>(const BlockPattern::Part& part, const CellsAtRows<n>& at,
                                            const auto& names, const std::vector<std::uint32_t>& cells) {
        std::vector<std::size_t> next(at.begin.begin() + static_cast<std::ptrdiff_t>(part.first_row),
                                      at.begin.begin() + static_cast<std::ptrdiff_t>(part.end_row));
        const auto rows_of = [&](std::uint32_t c) { return corner_rows<n>(pattern.numbering, mesh, names[c]); };
        const auto add = [&](std::uint32_t c, const std::array<int, n>& rows, CellBlocks<n>& of_cell) {
            std::array<std::size_t, n> row;
            for (std::size_t i = 0; i < n; ++i) row[i] = static_cast<std::size_t>(rows[i] - pattern.rows.first_row);
            add_cell(pattern.rows, at, part, c, row, of_cell, matrix, next, system);
        };
        std::size_t k = 0;
        if constexpr (n == 4 && requires(std::array<Tet, 4> four, std::array<CellBlocks<4>, 4>& parts) { kernel(four, parts); }) {
            std::array<CellBlocks<4>, 4> of_cells;
            for (; !matrix && k + 4 <= cells.size(); k += 4) {
                if (k % 4096 == 0) heed(watch);
                const std::uint32_t* const c = cells.data() + k;
                kernel(std::array{names[c[0]], names[c[1]], names[c[2]], names[c[3]]}, of_cells);
                for (std::size_t which = 0; which < 4; ++which) add(c[which], rows_of(c[which]), of_cells[which]);
            }
        }
        CellBlocks<n> of_cell;
        for (; k < cells.size(); ++k) {
            if (k % 4096 == 0) heed(watch);
            const std::array<int, n> rows = rows_of(cells[k]);
            if constexpr (n > 6) {
                CellBlocks<n / 2> whole;
                kernel(names[cells[k]], whole);
                part_sides(whole, rows, matrix, of_cell);
            } else {
                kernel(names[cells[k]], of_cell);
            }
            add(cells[k], rows, of_cell);
        }
    };
    for_all(blocks.parts.size(), [&](std::size_t p) {
        const BlockPattern::Part& part = blocks.parts[p];
        const auto rows = [&](std::size_t row) { return static_cast<std::ptrdiff_t>(row); };
        std::fill(system.residual.begin() + rows(block_size * part.first_row),
                  system.residual.begin() + rows(block_size * part.end_row), 0.0);
        if (matrix)
            std::fill(system.block(static_cast<std::size_t>(pattern.rows.begin[part.first_row])),
                      system.block(static_cast<std::size_t>(pattern.rows.begin[part.end_row])), 0.0);
        add_all(part, pattern.tets, pattern.cells.tets, part.tets);
        add_all(part, pattern.prisms, pattern.cells.prisms, part.prisms);
        add_all(part, pattern.upper_tets, pattern.upper.tets, part.upper_tets);
        add_all(part, pattern.upper_prisms, pattern.upper.prisms, part.upper_prisms);
    }, 1);
}

}  // namespace kropla
