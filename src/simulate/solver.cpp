// Iterative refinement: a Krylov method finds corrections to what is left of the residual.
//   [Skeel 1980] Iterative refinement implies numerical stability for Gaussian elimination. Math. Comp. 35:
//     the row-wise backward error; here residuals are not in a higher precision but in the difference form.
//   [Oettli, Prager 1964] Compatibility of approximate solution of linear equations with given error bounds.
//     Numer. Math. 6: that error is the smallest relative change of the data that makes x exact.
#include "simulate/solver.h"

#include <kropla/base/error.h>
#include "simulate/petsc_objects.h"
#include "simulate/stop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <sstream>

namespace kropla {
namespace {

constexpr double rounding = std::numeric_limits<double>::epsilon() / 2;
constexpr int most_iterations = 2000;      // of all passes: far more than any system needs
constexpr int restart = 60;                // of GMRES: as many iterations as a solve may take
constexpr double pass_margin = 0.1;        // [-] what a pass aims at, in tolerances
constexpr double deepest_pass = 1e-13;     // [-] of the residual, beyond what a Krylov method sees is its own rounding
constexpr double stagnation = 0.5;         // [-] of the error and of the residual: what leaves more got nowhere
constexpr double regular_shift = 1e-12;    // [-] of the diagonal, to precondition: far above rounding, below all that
                                           //   contrasts of 1e8 make small, but for constants
constexpr double hardly_held = 1e-9;       // [-] of what is exchanged: constants are nearly lost in rounding
constexpr double several_cells = 10;       // [-] exchanged to held, beyond which multigrid is cheaper

double largest(const Ranks& ranks, double mine) {
    double all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, ranks.communicator);
    return all;
}

/// By what each row is divided: its size; or the largest of all, where columns count too: a symmetric matrix stays
/// so, and multigrid needs columns of conduction that sum to zero, as its restriction adds up rows.
std::vector<double> row_scales(const Ranks& ranks, const LinearSystem& system, bool alike) {
    std::vector<double> scale(system.right.size());
    for (std::size_t r = 0; r < scale.size(); ++r) scale[r] = row_size(system, r);
    double most = 0;
    for (double s : scale) most = std::max(most, s);
    most = largest(ranks, most);
    for (double& s : scale)
        if (alike || !(s > 0)) s = most > 0 ? most : 1;
    return scale;
}

double largest_size(const std::vector<double>& values) {
    double most = 0;
    for (double value : values) most = std::max(most, std::abs(value));
    return most;
}

struct Residual {
    std::vector<double> rest;    // b - A x per owned row
    std::vector<double> size;    // what it is measured against, but for the row's sum
    double largest = 0;          // of the sizes of `rest`, over all ranks
    double backward_error = 0;   // [-] over all ranks
};

/// Measures what is left.
void measure(const Ranks& ranks, const LinearSystem& system, const DoubledUnknown& x, Residual& left) {
    const double most = largest_size(x.high);
    double error = 0, most_left = 0;
    for (std::size_t r = 0; r < left.rest.size(); ++r) {
        const double rest = std::abs(left.rest[r]), size = left.size[r] + std::abs(system.row_sum[r]) * most;
        most_left = std::max(most_left, rest);
        if (rest != 0) error = std::max(error, std::isfinite(rest) ? rest / size : INFINITY);
    }
    left.largest = largest(ranks, most_left);
    left.backward_error = largest(ranks, error);
}

Residual residual(const Ranks& ranks, const LinearSystem& system, const DoubledUnknown& x) {
    Residual left{std::vector<double>(system.right.size()), std::vector<double>(system.right.size())};
    for (std::size_t r = 0; r < left.rest.size(); ++r) {
        const std::size_t own = static_cast<std::size_t>(system.rows.first_row) + r;
        double sum = system.right[r] - system.row_sum[r] * x.high[own] - system.row_sum[r] * x.low[own];
        double size = std::abs(system.right[r]) + system.negligible[r];
        for (PetscInt k = system.rows.begin[r]; k < system.rows.begin[r + 1]; ++k) {
            const auto place = static_cast<std::size_t>(k);
            const double exchanged =
                system.value[place] * x.difference(static_cast<std::size_t>(system.rows.column[place]), own);
            sum -= exchanged;
            size += std::abs(exchanged);
        }
        left.rest[r] = sum;
        left.size[r] = size;
    }
    measure(ranks, system, x, left);
    return left;
}

/// A pass got nowhere.
bool stuck(const Residual& before, const Residual& after) {
    return !(after.backward_error < stagnation * before.backward_error) &&
           !(after.largest < stagnation * before.largest);
}

/// What a row's sum is known to, at best.
double reachable(const Ranks& ranks, const LinearSystem& system) {
    PetscInt longest = 0;
    for (std::size_t r = 0; r + 1 < system.rows.begin.size(); ++r)
        longest = std::max(longest, system.rows.begin[r + 1] - system.rows.begin[r]);
    return rounding * (largest(ranks, static_cast<double>(longest)) + 2);
}

/// In which pieces nothing is fixed, and so much exchanged that the matrix hardly knows what is held: balance() finds
/// constants.
std::vector<char> lost_constants(const Ranks& ranks, const LinearSystem& system) {
    const auto held = sums_of_pieces(ranks, system.rows, [&](std::size_t r) { return system.row_sum[r]; });
    const auto size = sums_of_pieces(ranks, system.rows, [&](std::size_t r) { return row_size(system, r); });
    std::vector<char> lost = system.closed;
    for (std::size_t p = 0; p < lost.size(); ++p)
        if (!(held[p] < hardly_held * size[p])) lost[p] = 0;
    return lost;
}

/// How rows are scaled and constants are treated: what is fixed when a solver is made.
struct Treatment {
    Preconditioner preconditioner;
    bool alike;             // rows are divided by the same
    std::vector<char> without_constants;  // per piece
    bool operator==(const Treatment&) const = default;
};

Treatment treatment(const Ranks& ranks, const LinearSystem& system, const SolverChoice& choice) {
    return {choice.preconditioner, choice.potential || choice.preconditioner == Preconditioner::multigrid,
            choice.potential ? system.closed : lost_constants(ranks, system)};
}

}  // namespace

/// PETSc's solver for systems of one pattern, and whether its tolerance is the user's.
class Krylov {
public:
    Krylov(const Ranks& ranks, const SparseRows& rows, const Treatment& treatment, const SolverChoice& choice)
        : treatment_(treatment),
          rows_(rows),
          right_(make_vector(ranks, rows.count())),
          unknown_(make_vector(ranks, rows.count())),
          gathering_(ranks, unknown_.get()),
          matrix_(ranks, rows, all_rows()) {
        KSP solver = nullptr;
        check(KSPCreate(ranks.communicator, &solver));
        solver_.reset(solver);
        check(KSPSetOptionsPrefix(solver, choice.prefix.c_str()));
        if (choice.potential) check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
        set_defaults(choice);
        check(KSPSetOperators(solver, matrix_.get(), matrix_.get()));
        check(KSPSetFromOptions(solver));
        listen_on_the_way(solver, ranks);
        double rtol = 0, atol = 0;
        check(KSPGetTolerances(solver, &rtol, &atol, nullptr, &most_));
        users_tolerance_ = rtol != deepest_pass || atol != 0;
    }

    [[nodiscard]] bool treats(const Treatment& treatment) const { return treatment == treatment_; }

    /// Takes the values of a system of the pattern.
    void take(const Ranks& ranks, const LinearSystem& system) {
        scale_ = row_scales(ranks, system, treatment_.alike);
        matrix_.take(system, scale_);
        if (std::ranges::count(treatment_.without_constants, 1) > 0) leave_constants_out(ranks);
        iterations_ = 0;
        iterations_left_ = most_;
    }

    [[nodiscard]] bool users_tolerance() const { return users_tolerance_; }
    [[nodiscard]] int iterations() const { return iterations_; }

    /// The correction for this residual, per global row.
    std::vector<double> correct(const std::vector<double>& rest, double rtol) {
        std::vector<double> scaled(rest.size());
        for (std::size_t r = 0; r < rest.size(); ++r) scaled[r] = rest[r] / scale_[r];
        put(scaled, right_.get());
        if (!users_tolerance_)
            check(KSPSetTolerances(solver_.get(), rtol, 0.0, PETSC_DEFAULT, iterations_left_));
        check(KSPSolve(solver_.get(), right_.get(), unknown_.get()));
        PetscInt taken = 0;
        check(KSPGetIterationNumber(solver_.get(), &taken));
        iterations_ += static_cast<int>(taken);
        iterations_left_ = std::max<PetscInt>(iterations_left_ - taken, 0);
        return gathering_(unknown_.get());
    }

    /// Makes all that is made before the first iteration.
    void set_up() {
        check(KSPSetUp(solver_.get()));
        check(KSPSetUpOnBlocks(solver_.get()));
    }

    [[nodiscard]] KSPConvergedReason reason() const {
        KSPConvergedReason reason{};
        check(KSPGetConvergedReason(solver_.get(), &reason));
        return reason;
    }
    [[nodiscard]] bool out_of_iterations() const { return iterations_left_ == 0; }

private:
    [[nodiscard]] PetscInt all_rows() const {
        PetscInt size = 0;
        check(VecGetSize(right_.get(), &size));
        return size;
    }

    /// Constants are taken out of every residual; the preconditioner is that of a matrix that is not singular.
    void leave_constants_out(const Ranks& ranks) {
        constants_ = std::make_unique<Constants>(ranks, rows_, treatment_.without_constants);
        check(MatSetNullSpace(matrix_.get(), constants_->get()));
        Mat shifted = nullptr;
        check(MatDuplicate(matrix_.get(), MAT_COPY_VALUES, &shifted));
        regular_.reset(shifted);
        const OwnedVec diagonal = make_vector(ranks, scale_.size());
        check(MatGetDiagonal(shifted, diagonal.get()));
        check(VecScale(diagonal.get(), 1 + regular_shift));
        check(MatDiagonalSet(shifted, diagonal.get(), INSERT_VALUES));
        check(KSPSetOperators(solver_.get(), matrix_.get(), shifted));
    }

    void set_defaults(const SolverChoice& choice) {
        KSP solver = solver_.get();
        check(KSPSetType(solver, choice.potential ? KSPCG : KSPGMRES));
        if (!choice.potential) check(KSPGMRESSetRestart(solver, restart));
        PC preconditioner = nullptr;
        check(KSPGetPC(solver, &preconditioner));
        if (choice.preconditioner == Preconditioner::multigrid) {
            set_multigrid(choice);
            check(PCSetType(preconditioner, PCHYPRE));
            check(PCHYPRESetType(preconditioner, "boomeramg"));
        } else {
            check(PCSetType(preconditioner, PCBJACOBI));
        }
        check(KSPSetTolerances(solver, deepest_pass, 0.0, PETSC_DEFAULT, most_iterations));
        check(KSPSetInitialGuessNonzero(solver, PETSC_FALSE));
    }

    /// BoomerAMG has no other way in than options; those that the user gave stand.
    static void set_multigrid(const SolverChoice& choice) {
        const char* fast = choice.potential ? "1" : "0";  // levels of fast coarsening: cheaper, but worse for contrasts
        const std::array<std::array<const char*, 2>, 7> defaults = {
            {{"coarsen_type", "HMIS"},
             {"interp_type", "ext+i"},
             {"P_max", "4"},
             {"strong_threshold", "0.7"},
             {"agg_nl", fast},
             {"relax_type_down", "SOR/Jacobi"},  // one sweep each way, symmetric together
             {"relax_type_up", "backward-SOR/Jacobi"}}};
        for (const auto& [name, value] : defaults)
            set_unless_given(choice, std::string("pc_hypre_boomeramg_") + name, value);
    }

    /// Did the user give options that begin like this? They speak of what then is to be used.
    static bool is_given_any(const std::string& begin) {
        char* all = nullptr;
        check(PetscOptionsGetAll(nullptr, &all));
        const bool given = (" " + std::string(all)).find(" " + begin) != std::string::npos;
        check(PetscFree(all));
        return given;
    }

    static void set_unless_given(const SolverChoice& choice, const std::string& name, const char* value) {
        const std::string option = "-" + choice.prefix + name;
        PetscBool given = PETSC_FALSE;
        check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &given));
        if (!given) check(PetscOptionsSetValue(nullptr, option.c_str(), value));
    }

    Treatment treatment_;
    const SparseRows& rows_;
    std::vector<double> scale_;
    OwnedVec right_, unknown_;
    Gathering gathering_;
    Matrix matrix_;
    OwnedMat regular_;
    std::unique_ptr<Constants> constants_;  // referred to by the matrix
    OwnedKsp solver_;
    PetscInt most_ = most_iterations, iterations_left_ = most_iterations;
    int iterations_ = 0;
    bool users_tolerance_ = false;
};

namespace {

[[noreturn]] void give_up(const SolverChoice& choice, const Krylov& krylov, double backward_error) {
    std::ostringstream message;
    message << "the " << choice.name << " solver did not converge: " << KSPConvergedReasons[krylov.reason()]
            << " after " << krylov.iterations() << " iterations, backward error " << backward_error;
    throw SolverError(message.str());
}

/// In pieces of which no unknown is fixed, the sum of all equations says what constant is missing in x.
void balance(const Ranks& ranks, const LinearSystem& system, DoubledUnknown& x, Residual& left) {
    const SparseRows& rows = system.rows;
    const auto held = sums_of_pieces(ranks, rows, [&](std::size_t r) { return system.row_sum[r]; });
    std::vector<double> missing = sums_of_pieces(ranks, rows, [&](std::size_t r) { return left.rest[r]; });
    for (std::size_t p = 0; p < missing.size(); ++p) {
        missing[p] /= held[p];
        if (system.closed[p] == 0 || !(held[p] > 0) || !std::isfinite(missing[p])) missing[p] = 0;
    }
    for (std::size_t r = 0; r < x.high.size(); ++r) x.add(r, missing[rows.piece_of(r)]);
    for (std::size_t r = 0; r < left.rest.size(); ++r)  // no difference changed
        left.rest[r] -= system.row_sum[r] * missing[rows.piece_of_owned(r)];
    measure(ranks, system, x, left);
}

std::vector<double> everywhere(const Ranks& ranks, const std::vector<double>& mine) {
    if (ranks.count == 1) return mine;
    const OwnedVec vector = make_vector(ranks, mine.size());
    put(mine, vector.get());
    return Gathering(ranks, vector.get())(vector.get());
}

}  // namespace

Solver::Solver(const Ranks& ranks, const SparseRows& rows) : ranks_(ranks), rows_(rows) {}
Solver::~Solver() = default;

void Solver::take(const LinearSystem& system, const SolverChoice& choice) {
    heed(ranks_);
    system_ = &system;
    choice_ = choice;
    x_ = {everywhere(ranks_, system.guess), {}};
    x_.low.assign(x_.high.size(), 0.0);
    const Treatment needed = treatment(ranks_, system, choice);
    if (!krylov_ || !krylov_->treats(needed)) krylov_ = std::make_unique<Krylov>(ranks_, rows_, needed, choice);
    krylov_->take(ranks_, system);
}

Solution Solver::solve(double tolerance) {
    const double wanted = std::max(tolerance, reachable(ranks_, *system_));
    Residual left = residual(ranks_, *system_, x_);
    if (!choice_.potential) balance(ranks_, *system_, x_, left);
    double corrected = INFINITY;     // [-] of the largest entry, by the last pass
    bool as_deep_as_can_be = false;  // a pass got nowhere: the norm that it aims at does not see what is left
    while (left.backward_error > wanted) {
        const Residual before = left;
        const double aim = as_deep_as_can_be ? deepest_pass
                                             : std::clamp(pass_margin * wanted / before.backward_error, deepest_pass,
                                                          pass_margin);
        const std::vector<double> correction = krylov_->correct(before.rest, aim);
        heed(ranks_);
        for (std::size_t r = 0; r < correction.size(); ++r) x_.add(r, correction[r]);
        left = residual(ranks_, *system_, x_);
        if (krylov_->users_tolerance()) {
            if (krylov_->reason() <= 0) give_up(choice_, *krylov_, left.backward_error);
            break;
        }
        if (!choice_.potential) {
            balance(ranks_, *system_, x_, left);
            corrected = largest_size(correction) / largest_size(x_.high);
            if (corrected < rounding) break;
        }
        if (left.backward_error <= wanted || !(stuck(before, left) || krylov_->out_of_iterations())) continue;
        if (as_deep_as_can_be || krylov_->out_of_iterations()) give_up(choice_, *krylov_, left.backward_error);
        as_deep_as_can_be = true;
    }
    std::vector<double> value(x_.high.size());
    for (std::size_t r = 0; r < value.size(); ++r) value[r] = x_.value(r);
    return {std::move(value), krylov_->iterations(), std::min(left.backward_error, corrected)};
}

void Solver::set_up() {
    krylov_->set_up();
}

Solution solve(const Ranks& ranks, const LinearSystem& system, const SolverChoice& choice) {
    Solver solver(ranks, system.rows);
    solver.take(system, choice);
    return solver.solve(choice.tolerance);
}

void rehearse(const Ranks& ranks) {
    const SparseRows rows = chain();
    LinearSystem system(rows);
    std::ranges::fill(system.value, -1.0);
    std::ranges::fill(system.row_sum, 0.1);
    const auto try_out = [&](const SolverChoice& choice) {
        Solver solver(ranks, rows);
        solver.take(system, choice);
        solver.set_up();
    };
    for (Preconditioner preconditioner : {Preconditioner::factors, Preconditioner::multigrid})
        try_out({.name = "", .preconditioner = preconditioner});
    try_out({.name = "", .prefix = "potential_", .preconditioner = Preconditioner::multigrid, .potential = true});
}

Preconditioner preconditioner_for(const Ranks& ranks, const LinearSystem& system) {
    double most = 0;
    for (std::size_t r = 0; r < system.right.size(); ++r)
        most = std::max(most, row_size(system, r) / system.held[r]);
    return largest(ranks, most) > several_cells ? Preconditioner::multigrid : Preconditioner::factors;
}

}  // namespace kropla
