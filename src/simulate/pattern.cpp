#include "simulate/pattern.h"

#include "base/for_all.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace kropla {
namespace {

constexpr std::size_t parts = 64;         // that rows are shared out in, at most, and
constexpr std::size_t least_rows = 512;  // of a part

/// A mesh's cells of one kind at the rows from `first_row` on, in order; their places in the rows are not known yet.
template <std::size_t n, class Name>
CellsAtRows<n> cells_at_rows(const Mesh& mesh, const std::vector<Name>& cells, const Numbering& numbering, int first_row,
                             std::size_t rows) {
    CellsAtRows<n> at{std::vector<std::size_t>(rows + 1, 0), {}};
    const auto for_each_corner = [&](const auto& visit) {
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const std::array<int, n> row = corner_rows<n>(numbering, mesh, cells[c]);
            for (std::size_t i = 0; i < n; ++i) {
                const auto r = static_cast<std::size_t>(row[i] - first_row);  // huge if before them, or none
                if (r < rows) visit(r, c, i);
            }
        }
    };
    for_each_corner([&](std::size_t r, std::size_t, std::size_t) { ++at.begin[r + 1]; });
    std::partial_sum(at.begin.begin(), at.begin.end(), at.begin.begin());
    at.cells.resize(at.begin.back());
    std::vector<std::size_t> next(at.begin.begin(), at.begin.end() - 1);
    for_each_corner([&](std::size_t r, std::size_t c, std::size_t i) {
        at.cells[next[r]++] = {static_cast<std::uint32_t>(c), static_cast<std::uint32_t>(i), {}};
    });
    return at;
}

/// The columns of some rows, row by row, ascending.
struct Columns {
    std::vector<PetscInt> column;
    std::vector<PetscInt> end;  // of each row, in `column`
};

/// Lists the columns of rows, one after the other, and finds the places of cells' corners in them.
class RowsOfPart {
public:
    RowsOfPart(const Mesh& mesh, Pattern& pattern)
        : mesh_(mesh), pattern_(pattern), found_in_(pattern.numbering.vertex.size(), none), order_(found_in_.size()) {}

    void add(std::size_t row) {
        row_ = row;
        fresh_.clear();
        number_corners(pattern_.cells.tets, pattern_.tets);
        number_corners(pattern_.cells.prisms, pattern_.prisms);
        number_corners(pattern_.upper.tets, pattern_.upper_tets);
        number_corners(pattern_.upper.prisms, pattern_.upper_prisms);
        place_.resize(fresh_.size());
        sorted_ = fresh_;
        std::ranges::sort(sorted_);
        for (std::size_t k = 0; k < sorted_.size(); ++k)
            place_[order_[static_cast<std::size_t>(sorted_[k])]] = static_cast<std::uint16_t>(k);
        place_corners(pattern_.tets);
        place_corners(pattern_.prisms);
        place_corners(pattern_.upper_tets);
        place_corners(pattern_.upper_prisms);
        columns_.column.insert(columns_.column.end(), sorted_.begin(), sorted_.end());
        columns_.end.push_back(static_cast<PetscInt>(columns_.column.size()));
    }
    [[nodiscard]] Columns columns() && { return std::move(columns_); }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);

    /// In the order in which they are met.
    template <std::size_t n, class Name>
    void number_corners(const std::vector<Name>& cells, CellsAtRows<n>& at) {
        for (std::size_t k = at.begin[row_]; k < at.begin[row_ + 1]; ++k) {
            const std::array<int, n> row = corner_rows<n>(pattern_.numbering, mesh_, cells[at.cells[k].cell]);
            for (std::size_t i = 0; i < n; ++i) {
                const int column = row[i];
                if (column < 0) continue;
                const auto c = static_cast<std::size_t>(column);
                if (found_in_[c] != row_) {
                    found_in_[c] = row_;
                    order_[c] = static_cast<std::uint16_t>(fresh_.size());
                    fresh_.push_back(column);
                }
                at.cells[k].place[i] = order_[c];
            }
        }
    }

    template <std::size_t n>
    void place_corners(CellsAtRows<n>& at) const {
        for (std::size_t k = at.begin[row_]; k < at.begin[row_ + 1]; ++k)
            for (std::uint16_t& place : at.cells[k].place) place = place_[place];
    }

    const Mesh& mesh_;
    Pattern& pattern_;
    std::size_t row_ = 0;
    std::vector<std::size_t> found_in_;  // of each column: the row in which it was last met
    std::vector<std::uint16_t> order_;   // of each column: as which of that row
    std::vector<PetscInt> fresh_, sorted_;
    std::vector<std::uint16_t> place_;   // by that order
    Columns columns_;
};

/// Takes the cells at upper sides out of the others.
void part_upper(const Mesh& mesh, Pattern& pattern) {
    const auto is_upper = [&](const auto& cell) {
        return std::ranges::any_of(cell_vertices(mesh, cell), [&](Vertex v) {
            return pattern.numbering.is_upper(v, cell_region(mesh, cell));
        });
    };
    const auto part = [&](auto& cells, auto& upper) {
        std::ranges::copy_if(cells, std::back_inserter(upper), is_upper);
        std::erase_if(cells, is_upper);
    };
    part(pattern.cells.tets, pattern.upper.tets);
    part(pattern.cells.prisms, pattern.upper.prisms);
}

}  // namespace

Pattern make_pattern(const Mesh& mesh, const Cells& cells, const Ranks& ranks, UpperSides upper) {
    Pattern pattern;
    pattern.numbering = number_vertices(mesh, cells, ranks.count, std::move(upper));
    pattern.cells = ranks.count == 1 ? cells : cells_of_rank(mesh, cells, pattern.numbering, ranks.rank);
    if (!pattern.numbering.upper.empty()) part_upper(mesh, pattern);
    const auto rank = static_cast<std::size_t>(ranks.rank);
    const int first = pattern.numbering.first_row[rank];
    const auto rows = static_cast<std::size_t>(pattern.numbering.first_row[rank + 1] - first);
    pattern.tets = cells_at_rows<4>(mesh, pattern.cells.tets, pattern.numbering, first, rows);
    pattern.prisms = cells_at_rows<6>(mesh, pattern.cells.prisms, pattern.numbering, first, rows);
    pattern.upper_tets = cells_at_rows<8>(mesh, pattern.upper.tets, pattern.numbering, first, rows);
    pattern.upper_prisms = cells_at_rows<12>(mesh, pattern.upper.prisms, pattern.numbering, first, rows);

    const std::size_t part_rows = std::max(least_rows, (rows + parts - 1) / parts);
    std::vector<Columns> columns((rows + part_rows - 1) / part_rows);
    for_all(columns.size(), [&](std::size_t part) {
        RowsOfPart of(mesh, pattern);
        for (std::size_t row = part * part_rows; row < std::min(rows, (part + 1) * part_rows); ++row) of.add(row);
        columns[part] = std::move(of).columns();
    }, 1);
    const Pieces pieces = pieces_of(mesh, cells);
    pattern.rows = {first, {0}, {}, {}, pieces.count};
    for (Vertex v : pattern.numbering.vertex) pattern.rows.piece.push_back(pieces.of[v]);
    pattern.rows.begin.reserve(rows + 1);
    for (const Columns& part : columns) {
        const auto before = static_cast<PetscInt>(pattern.rows.column.size());
        for (PetscInt end : part.end) pattern.rows.begin.push_back(before + end);
        pattern.rows.column.insert(pattern.rows.column.end(), part.column.begin(), part.column.end());
    }
    return pattern;
}

}  // namespace kropla
