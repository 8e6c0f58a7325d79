#pragma once

#include "simulate/linear_system.h"

#include <memory>
#include <string>
#include <vector>

namespace kropla {

enum class Preconditioner {
    factors,    ///< incomplete, by rank: for unknowns that are bound to a few others at most, or few unknowns
    multigrid,  ///< algebraic: as many iterations whatever the number of unknowns
};

/// How a system is solved unless PETSc's options say otherwise.
struct SolverChoice {
    std::string name;         // for messages: "heat"
    std::string prefix = "";  // of its PETSc options: "potential_" for -potential_ksp_type
    Preconditioner preconditioner = Preconditioner::factors;
    double tolerance = 1e-13;  // [-] of the backward error; rounding has the last word
    bool potential = false;    // symmetric, its row sums are zero: constants are of no matter
};

struct Solution {
    std::vector<double> value;  // per global row, the same on every rank
    int iterations;
    double error;  // [-] the backward error, or the last correction if that is smaller; see solve
};

/// An unknown as a sum of two numbers: differences of neighbours are finer than the unknown's own rounding.
struct DoubledUnknown {
    std::vector<double> high, low;  // per global row

    void add(std::size_t r, double value) {
        const double sum = high[r] + value, part = sum - high[r];
        low[r] += (high[r] - (sum - part)) + (value - part);  // what rounding took [Knuth, TAOCP 2, 4.2.2]
        high[r] = sum;
    }
    [[nodiscard]] double value(std::size_t r) const { return high[r] + low[r]; }
    [[nodiscard]] double difference(std::size_t j, std::size_t i) const {
        return (high[j] - high[i]) + (low[j] - low[i]);
    }
};

class Krylov;  // PETSc's solver

/// Solves systems of one pattern, one after the other, together with all other ranks: conjugate gradients for a
/// potential, else GMRES. Neither units nor contrasts matter: rows are scaled by their size, and the solver is asked for
/// corrections, whose right-hand sides are residuals computed in the form of LinearSystem, until the backward error
///     max over i of |b - A x|_i / (|row_sum_i| max|x| + |b_i| + sum over j of |a_ij (x_j - x_i)| + negligible_i)
/// is within the tolerance, or what rounding leaves of a row's sum if that is more: x then solves a system whose
/// sums, right-hand side and couplings differ by that share. For an M-matrix so small a change makes x differ
/// by about as small a share of its largest entry. It is done, too, when a correction is lost in the rounding of
/// that entry: rows that hold next to nothing may then still differ, which no unknown can show.
///
/// A tolerance in PETSc's options (-ksp_rtol, -ksp_atol, of the residual of the first guess) holds instead.
class Solver {
public:
    Solver(const Ranks& ranks, const SparseRows& rows);  // both outlive it
    ~Solver();
    Solver(const Solver&) = delete;
    Solver& operator=(const Solver&) = delete;

    /// Takes the values of a system of the rows, and its guess. The system stays as it is while it is solved.
    void take(const LinearSystem& system, const SolverChoice& choice);
    /// Of the system that was taken; asked again with a smaller tolerance, it goes on. Throws SolverError with PETSc's
    /// reason, the iterations and the backward error if it does not converge, AllInterrupted if the watch of any rank
    /// says stop.
    [[nodiscard]] Solution solve(double tolerance);
    /// Makes all that is made before the first iteration.
    void set_up();

private:
    const Ranks& ranks_;
    const SparseRows& rows_;
    SolverChoice choice_;
    const LinearSystem* system_ = nullptr;
    DoubledUnknown x_;
    std::unique_ptr<Krylov> krylov_;
};

/// One system alone, to the choice's tolerance.
[[nodiscard]] Solution solve(const Ranks& ranks, const LinearSystem& system, const SolverChoice& choice);

/// Sets up every solver that a step may choose, for a small system, so that each option of PETSc's that means
/// anything has been asked for. Throws SolverError if PETSc refuses one.
void rehearse(const Ranks& this_rank);

/// The preconditioner for a step of diffusion: multigrid once what a vertex exchanges with its neighbours during
/// the step is so many times what it holds, anywhere, that heat passes several cells.
[[nodiscard]] Preconditioner preconditioner_for(const Ranks& ranks, const LinearSystem& system);

}  // namespace kropla
