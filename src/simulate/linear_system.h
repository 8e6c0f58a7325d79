#pragma once

#include "simulate/partition.h"
#include "simulate/petsc.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace kropla {

/// The rows of a linear system that one rank owns: matrix in compressed rows, right-hand side, first guess.
/// Columns are global row numbers, ascending in each row, all places allotted beforehand.
struct LinearSystem {
    int first_row = 0;                  // global number of row 0 here
    std::vector<PetscInt> begin;        // owned rows + 1: where each row begins in `column` and `value`
    std::vector<PetscInt> column;
    std::vector<double> value;
    std::vector<double> right, guess;   // per owned row

    [[nodiscard]] int rows() const { return static_cast<int>(right.size()); }
};

/// A system of zeros with a place for every pair of vertices that share one of `cells`, the rank's own.
[[nodiscard]] LinearSystem empty_system(const Mesh& mesh, const Cells& cells, const Numbering& numbering,
                                        int rank);

/// Adds to the place (row, column), both global numbers; rows of other ranks are passed over.
void add_to(LinearSystem& system, int row, int column, double value);
void add_to_right(LinearSystem& system, int row, double value);

/// Adds the matrix of a cell with these vertices.
template <std::size_t n>
void add_to(LinearSystem& system, const Numbering& numbering, const std::array<Vertex, n>& vertices,
            const std::array<std::array<double, n>, n>& matrix) {
    for (std::size_t i = 0; i < n; ++i) {
        const int row = numbering.row[vertices[i]];
        for (std::size_t j = 0; j < n; ++j) add_to(system, row, numbering.row[vertices[j]], matrix[i][j]);
    }
}

/// Makes the row say: unknown = value (if the rank owns it), scaled by its diagonal, which is not zero. The
/// first guess is the value too.
void fix_unknown(LinearSystem& system, int row, double value);

/// How a system is solved unless PETSc's options say otherwise.
struct SolverChoice {
    std::string name;                   // for messages: "heat"
    std::string prefix = "";            // of its PETSc options: "potential_" for -potential_ksp_type
    std::string method;                 // as PETSc names it: "gmres"
    std::string preconditioner;         // "bjacobi"
    double relative_tolerance = 1e-12;  // [-] of the residual, against the right-hand side
    int most_iterations = 2000;
    bool singular = false;              // symmetric, and constants are its null space
};

struct Solution {
    std::vector<double> value;  // per global row, the same on every rank
    int iterations;
    double residual;            // [-] |b - A x| / |b|
};
/// Solves together with all other ranks. Throws SolverError with PETSc's reason, the iterations and the
/// residual if it does not converge, AllInterrupted if the watch of any of them says stop.
[[nodiscard]] Solution solve(const Ranks& ranks, const LinearSystem& system, const SolverChoice& choice);

}  // namespace kropla
