#pragma once

#include "simulate/linear_system.h"

#include <cstddef>
#include <span>
#include <vector>

namespace kropla {

/// A cycle of multigrid by smoothed aggregation: what corrects a residual, symmetric and positive, to precondition
/// conjugate gradients. For a symmetric matrix whose rows sum to zero or more, on one rank; constants may be its kernel.
/// It is worked out in one order, by one thread: the same bits always.
class Aggregation {
public:
    /// `value` has a place for each of `rows.column`, the diagonal too. Throws SolverError if a diagonal is not positive.
    Aggregation(const SparseRows& rows, std::span<const double> value);

    /// One entry a row; the residual and the correction are apart from each other.
    void correct(std::span<const double> residual, std::span<double> correction);

    /// Of how many levels the cycle is, and how many entries all their matrices have by those of the finest.
    [[nodiscard]] std::size_t levels() const { return levels_.size(); }
    [[nodiscard]] double complexity() const;

    /// Rows with, one after the other, entries left of the diagonal, and entries right of it.
    struct Matrix {
        std::vector<PetscInt> begin = {0}, right = {};  // of each row: where it begins, and where its second part does
        std::vector<PetscInt> column = {};
        std::vector<double> value = {};
        std::vector<double> diagonal = {};

        [[nodiscard]] std::size_t count() const { return diagonal.size(); }
    };
    /// What a level hands to the coarser one: rows of the finer, columns of the coarser.
    struct Interpolation {
        std::vector<PetscInt> begin = {0};
        std::vector<PetscInt> column = {};
        std::vector<double> value = {};
    };

private:
    struct Level {
        Matrix matrix;
        std::vector<double> inverse;       // of the diagonal
        Interpolation from_coarser;        // none on the coarsest
        std::vector<double> rest, found;  // of the coarser levels: what is asked, and the answer
    };

    void factor_coarsest();
    void solve_coarsest(std::span<const double> rest, std::span<double> found) const;
    void cycle(std::size_t at, std::span<const double> rest, std::span<double> found);

    std::vector<Level> levels_;
    std::vector<double> factor_;  // L of the coarsest matrix, row by row; a row without a pivot is left out of it
};

}  // namespace kropla
