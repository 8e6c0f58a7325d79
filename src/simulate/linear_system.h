#pragma once

#include <kropla/simulate/petsc.h>

#include <cstddef>
#include <vector>

namespace kropla {

/// Which unknowns are coupled, for the rows that one rank owns: of row r those in column[begin[r]] ... up to
/// column[begin[r + 1]], global numbers, ascending, the row's own among them.
struct SparseRows {
    int first_row = 0;  // global number of row 0 here
    std::vector<PetscInt> begin = {0};
    std::vector<PetscInt> column = {};
    // Unknowns that are not even coupled by way of others are of different pieces; numbered, for the rows of all ranks.
    std::vector<int> piece = {};  // empty: all are of one
    int pieces = 1;

    [[nodiscard]] std::size_t count() const { return begin.size() - 1; }
    [[nodiscard]] std::size_t piece_of(std::size_t global_row) const {
        return piece.empty() ? 0 : static_cast<std::size_t>(piece[global_row]);
    }
    [[nodiscard]] std::size_t piece_of_owned(std::size_t row) const {
        return piece_of(static_cast<std::size_t>(first_row) + row);
    }
};

/// The sums over the rows of each piece, of all ranks, of `value(owned row)`.
template <class Value>
[[nodiscard]] std::vector<double> sums_of_pieces(const Ranks& ranks, const SparseRows& rows, const Value& value) {
    std::vector<double> sums(static_cast<std::size_t>(rows.pieces), 0.0);
    for (std::size_t r = 0; r < rows.count(); ++r) sums[rows.piece_of_owned(r)] += value(r);
    MPI_Allreduce(MPI_IN_PLACE, sums.data(), rows.pieces, MPI_DOUBLE, MPI_SUM, ranks.communicator);
    return sums;
}

/// A chain of unknowns, each bound to the one before and the one after: enough for two levels of any multigrid.
[[nodiscard]] SparseRows chain();

/// The rows of a linear system A x = b that one rank owns. Of the matrix there are its sums by row and its
/// entries off the diagonal, and what it does to x is meant as
///     (A x)_i = row_sum_i x_i + sum over j of a_ij (x_j - x_i),
/// in which a constant takes part by the row's sum alone. So a vertex may be bound to its neighbours 10^16 times
/// as tightly as to its own heat, and the heat is not lost in rounding: an M-matrix given like this determines
/// its inverse to rounding, entry by entry.
///   [Alfa, Xue, Ye 2002] Accurate computation of the smallest eigenvalue of a diagonally dominant M-matrix.
///     Math. Comp. 71; also on entrywise perturbation of the inverse.
struct LinearSystem {
    const SparseRows& rows;            // outlive this
    std::vector<double> value;         // a_ij, a place for each of `rows.column`; in the row's own nothing of meaning
    std::vector<double> row_sum;       // per owned row
    std::vector<double> right, guess;  // per owned row
    std::vector<double> negligible;    // per owned row: a residual of no weight, in units of `right`
    std::vector<double> held;          // per owned row, of its sum: what it has by itself, whatever is exchanged
    std::vector<char> closed;          // per piece: no unknown of it is fixed, of any rank

    explicit LinearSystem(const SparseRows& sparse_rows);  // of zeros
    void clear();                                          // of zeros again

    [[nodiscard]] int count() const { return static_cast<int>(right.size()); }
    [[nodiscard]] bool owns(int row) const { return row >= rows.first_row && row < rows.first_row + count(); }
    /// Of a row that is owned, by its global number.
    [[nodiscard]] std::size_t local(int row) const { return static_cast<std::size_t>(row - rows.first_row); }
};

/// The sum of the sizes of a row's entries: what everything in it is measured against. Positive for a row that
/// has anything in it.
[[nodiscard]] double row_size(const LinearSystem& system, std::size_t owned_row);

/// Makes the row, a global number, say: unknown = value (if the rank owns it), times the row's size. The first guess is
/// the value too. Every rank is to fix every unknown that is fixed.
void fix_unknown(LinearSystem& system, int row, double value);

}  // namespace kropla
