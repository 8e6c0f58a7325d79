#pragma once

#include "simulate/partition.h"
#include <kropla/simulate/petsc.h>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace kropla {

/// The rows of a linear system A x = b that one rank owns. Of the matrix there are its sums by row and its
/// entries off the diagonal, and what it does to x is meant as
///     (A x)_i = row_sum_i x_i + sum over j of a_ij (x_j - x_i),
/// in which a constant takes part by the row's sum alone. So a vertex may be bound to its neighbours 10^16 times
/// as tightly as to its own heat, and the heat is not lost in rounding: an M-matrix given like this determines
/// its inverse to rounding, entry by entry.
///   [Alfa, Xue, Ye 2002] Accurate computation of the smallest eigenvalue of a diagonally dominant M-matrix.
///     Math. Comp. 71; also on entrywise perturbation of the inverse.
/// Columns are global row numbers, ascending in each row, the row's own among them, all places allotted
/// beforehand.
struct LinearSystem {
    int first_row = 0;                 // global number of row 0 here
    std::vector<PetscInt> begin;       // owned rows + 1: where each row begins in `column` and `value`
    std::vector<PetscInt> column;
    std::vector<double> value;         // a_ij; in the row's own place nothing of meaning
    std::vector<double> row_sum;       // per owned row
    std::vector<double> right, guess;  // per owned row
    std::vector<double> negligible;    // per owned row: a residual of no weight, in units of `right`
    std::vector<double> held;          // per owned row, of its sum: what it has by itself, whatever is exchanged
    bool closed = true;                // no unknown is fixed, of any rank

    [[nodiscard]] int rows() const { return static_cast<int>(right.size()); }
};

/// A system of zeros with a place for every pair of vertices that share one of `cells`, the rank's own.
[[nodiscard]] LinearSystem empty_system(const Mesh& mesh, const Cells& cells, const Numbering& numbering,
                                        int rank);

/// Adds to what the row has, a global number; rows of other ranks are passed over.
void add_to_right(LinearSystem& system, int row, double value);
void add_to_row_sum(LinearSystem& system, int row, double value);
void add_to_negligible(LinearSystem& system, int row, double value);
void add_to_held(LinearSystem& system, int row, double value);

/// Adds the matrix of a cell with these vertices, off its diagonal.
void add_to(LinearSystem& system, const Numbering& numbering, std::span<const Vertex> vertices,
            const double* matrix);
template <std::size_t n>
void add_to(LinearSystem& system, const Numbering& numbering, const std::array<Vertex, n>& vertices,
            const std::array<std::array<double, n>, n>& matrix) {
    add_to(system, numbering, vertices, matrix.front().data());
}

/// The sum of the sizes of a row's entries: what everything in it is measured against. Positive for a row that
/// has anything in it.
[[nodiscard]] double row_size(const LinearSystem& system, std::size_t owned_row);

/// Makes the row say: unknown = value (if the rank owns it), times the row's size. The first guess is the value
/// too. Every rank is to fix every unknown that is fixed.
void fix_unknown(LinearSystem& system, int row, double value);

}  // namespace kropla
