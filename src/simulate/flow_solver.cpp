// GMRES on the unknowns of a flow, vertex by vertex in blocks, each scaled by the diagonal of its own:
// velocities by that of momentum, pressures by that of PSPG, rows likewise, so that neither units nor
// contrasts matter. Where momentum is mostly held by mass, incomplete factors of the blocks precondition it.
// Where viscosity passes it on far, it is block triangular: a cycle of multigrid per direction of the
// velocity, and for the pressure
//     S^-1 = mu M^-1 + (rho/dt) K^-1,
// M lumped and K the Laplacian, which multigrid inverts.
//   [Cahouet, Chabard 1988] Some fast 3D finite element solvers for the generalized Stokes problem. Int. J.
//     Numer. Methods Fluids 8.
//   [Elman, Silvester, Wathen 2014] Finite elements and fast iterative solvers: the triangular form.
#include "simulate/flow_solver.h"

#include <kropla/base/error.h>
#include "simulate/petsc_objects.h"
#include "simulate/stop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <sstream>

namespace kropla {
namespace {

constexpr int most_iterations = 1000;
constexpr int restart = 100;
constexpr double no_tolerance = 1e-5;   // [-] PETSc's own: another one is the user's
constexpr double regular_shift = 1e-8;  // [-] of the Laplacian's diagonal: multigrid wants a regular matrix

double total(const Ranks& ranks, double mine) {
    double all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, ranks.communicator);
    return all;
}

/// `per_row` numbers of each owned row, of all ranks on every rank.
std::vector<double> gather_rows(const Ranks& ranks, const Numbering& numbering, std::size_t per_row,
                                const std::vector<double>& mine) {
    if (ranks.count == 1) return mine;
    const auto width = static_cast<int>(per_row);
    std::vector<int> count, begin;
    for (std::size_t r = 0; r + 1 < numbering.first_row.size(); ++r) {
        begin.push_back(width * numbering.first_row[r]);
        count.push_back(width * (numbering.first_row[r + 1] - numbering.first_row[r]));
    }
    std::vector<double> all(per_row * static_cast<std::size_t>(numbering.rows()));
    MPI_Allgatherv(mine.data(), static_cast<int>(mine.size()), MPI_DOUBLE, all.data(), count.data(),
                   begin.data(), MPI_DOUBLE, ranks.communicator);
    return all;
}

/// Reads or writes the entries of a vector that this rank owns.
template <class Deed>
void with_entries(Vec vector, const Deed& deed) {
    double* entries = nullptr;
    check(VecGetArray(vector, &entries));
    deed(entries);
    check(VecRestoreArray(vector, &entries));
}
template <class Deed>
void with_entries_of(Vec vector, const Deed& deed) {
    const double* entries = nullptr;
    check(VecGetArrayRead(vector, &entries));
    deed(entries);
    check(VecRestoreArrayRead(vector, &entries));
}

/// One number of each coupling as a matrix of its own.
OwnedMat scalar_matrix(const Ranks& ranks, const SparseRows& rows, const std::vector<double>& values) {
    Mat matrix = nullptr;
    const auto count = static_cast<PetscInt>(rows.count());
    check(MatCreate(ranks.communicator, &matrix));
    OwnedMat owned(matrix);
    check(MatSetSizes(matrix, count, count, PETSC_DETERMINE, PETSC_DETERMINE));
    check(MatSetType(matrix, MATAIJ));
    check(MatSeqAIJSetPreallocationCSR(matrix, rows.begin.data(), rows.column.data(), values.data()));
    check(MatMPIAIJSetPreallocationCSR(matrix, rows.begin.data(), rows.column.data(), values.data()));
    return owned;
}

/// A cycle of multigrid for one matrix.
class Cycle {
public:
    Cycle(const Ranks& ranks, OwnedMat matrix, const std::string& prefix)
        : matrix_(std::move(matrix)) {
        KSP solver = nullptr;
        check(KSPCreate(ranks.communicator, &solver));
        solver_.reset(solver);
        check(KSPSetOptionsPrefix(solver, prefix.c_str()));
        check(KSPSetType(solver, KSPPREONLY));
        check(KSPSetOperators(solver, matrix_.get(), matrix_.get()));
        PC multigrid = nullptr;
        check(KSPGetPC(solver, &multigrid));
        check(PCSetType(multigrid, PCHYPRE));
        set_defaults(prefix);
        check(PCHYPRESetType(multigrid, "boomeramg"));
        check(KSPSetFromOptions(solver));
        check(KSPSetUp(solver));
    }
    void operator()(Vec right, Vec unknown) const { check(KSPSolve(solver_.get(), right, unknown)); }

private:
    /// As in solver.cpp: for three dimensions; those that the user gave stand.
    static void set_defaults(const std::string& prefix) {
        constexpr std::array<std::array<const char*, 2>, 6> defaults = {
            {{"coarsen_type", "HMIS"},
             {"interp_type", "ext+i"},
             {"P_max", "4"},
             {"strong_threshold", "0.5"},
             {"relax_type_down", "SOR/Jacobi"},
             {"relax_type_up", "backward-SOR/Jacobi"}}};
        for (const auto& [name, value] : defaults) {
            const std::string option = "-" + prefix + "pc_hypre_boomeramg_" + name;
            PetscBool given = PETSC_FALSE;
            check(PetscOptionsHasName(nullptr, nullptr, option.c_str(), &given));
            if (!given) check(PetscOptionsSetValue(nullptr, option.c_str(), value));
        }
    }

    OwnedMat matrix_;
    OwnedKsp solver_;
};

/// The block triangular preconditioner.
class Triangular {
public:
    Triangular(const Ranks& ranks, const BlockPattern& blocks, std::span<const double> value,
               const PressureScales& scales, const std::vector<double>& scale,
               const std::vector<double>& own_scale)
        : ranks_(ranks), rows_(blocks.pattern.rows), value_(value) {
        std::vector<double> values(rows_.column.size());
        for (std::size_t m = 0; m < 3; ++m) {
            for (std::size_t k = 0; k < values.size(); ++k) values[k] = value[block_entries * k + 5 * m];
            velocity_[m].emplace(ranks, scalar_matrix(ranks, rows_, values), "flow_velocity_");
        }
        for (std::size_t r = 0; r < rows_.count(); ++r)
            for (auto k = static_cast<std::size_t>(rows_.begin[r]);
                 k < static_cast<std::size_t>(rows_.begin[r + 1]); ++k) {
                const auto column = static_cast<std::size_t>(rows_.column[k]);
                const bool own = rows_.column[k] == rows_.first_row + static_cast<PetscInt>(r);
                values[k] = own_scale[block_size * r + 3] * scales.value[k] * scale[block_size * column + 3] *
                            (own ? 1 + regular_shift : 1);
            }
        if (std::any_of(scales.value.begin(), scales.value.end(), [](double v) { return v != 0; }))
            laplacian_.emplace(ranks, scalar_matrix(ranks, rows_, values), "flow_pressure_");
        for (std::size_t r = 0; r < rows_.count(); ++r) {
            const double s = own_scale[block_size * r + 3];
            lumped_.push_back(scales.viscous[r] > 0 ? 1 / (s * s * scales.viscous[r]) : 0);
        }
        right_ = make_vector(ranks, rows_.count());
        solution_ = make_vector(ranks, rows_.count());
    }

    void operator()(Vec residual, Vec correction) {
        const std::size_t count = rows_.count();
        std::vector<double> rest(block_size * count), found(block_size * count, 0.0);
        with_entries_of(residual, [&](const double* r) { std::copy(r, r + rest.size(), rest.begin()); });
        if (laplacian_) apply(*laplacian_, rest, found, 3);
        for (std::size_t r = 0; r < count; ++r)
            found[block_size * r + 3] += lumped_[r] * rest[block_size * r + 3];
        subtract_gradient(found, rest);
        for (std::size_t m = 0; m < 3; ++m) apply(*velocity_[m], rest, found, m);
        with_entries(correction, [&](double* x) { std::copy(found.begin(), found.end(), x); });
    }

private:
    void apply(const Cycle& cycle, const std::vector<double>& rest, std::vector<double>& found,
               std::size_t m) {
        with_entries(right_.get(), [&](double* r) {
            for (std::size_t i = 0; i < rows_.count(); ++i) r[i] = rest[block_size * i + m];
        });
        cycle(right_.get(), solution_.get());
        with_entries_of(solution_.get(), [&](const double* x) {
            for (std::size_t i = 0; i < rows_.count(); ++i) found[block_size * i + m] = x[i];
        });
    }

    /// The pressure's part of momentum; between ranks it is left out.
    void subtract_gradient(const std::vector<double>& found, std::vector<double>& rest) const {
        for_all(rows_.count(), [&](std::size_t r) {
            for (auto k = static_cast<std::size_t>(rows_.begin[r]);
                 k < static_cast<std::size_t>(rows_.begin[r + 1]); ++k) {
                const auto column = static_cast<std::size_t>(rows_.column[k] - rows_.first_row);
                if (column >= rows_.count()) continue;
                for (std::size_t m = 0; m < 3; ++m)
                    rest[block_size * r + m] -=
                        value_[block_entries * k + 12 + m] * found[block_size * column + 3];
            }
        });
    }

    const Ranks& ranks_;
    const SparseRows& rows_;
    std::span<const double> value_;
    std::array<std::optional<Cycle>, 3> velocity_;
    std::optional<Cycle> laplacian_;
    std::vector<double> lumped_;
    OwnedVec right_, solution_;
};

PetscErrorCode apply_triangular(PC preconditioner, Vec residual, Vec correction) {
    void* context = nullptr;
    const PetscErrorCode code = PCShellGetContext(preconditioner, &context);
    if (code != 0) return code;
    try {
        (*static_cast<Triangular*>(context))(residual, correction);
    } catch (const std::exception&) {
        return PETSC_ERR_LIB;
    }
    return 0;
}

}  // namespace

struct FlowSolver::Parts {
    const Ranks& ranks;
    const BlockPattern& blocks;
    std::vector<char> given;               // block_size per global row
    std::vector<double> own_value;         // of the matrix, if PETSc has a copy
    std::span<double> value;
    std::vector<double> scale, own_scale;  // block_size per global and per owned row
    int iterations = 0;
    bool users_tolerance = false;
    OwnedVec right, unknown;
    std::unique_ptr<Triangular> triangular;  // used by the solver until it is destroyed
    OwnedMat matrix;
    OwnedKsp solver;

    [[nodiscard]] const SparseRows& rows() const { return blocks.pattern.rows; }
    [[nodiscard]] bool fixed(std::size_t global_row, std::size_t k) const {
        return given[block_size * global_row + k] != 0;
    }

    void find_scales() {
        own_scale.assign(block_size * rows().count(), 1.0);
        for_all(rows().count(), [&](std::size_t r) {
            const PetscInt own = rows().first_row + static_cast<PetscInt>(r);
            const auto begin = rows().column.begin() + rows().begin[r],
                       end = rows().column.begin() + rows().begin[r + 1];
            const double* const block =
                value.data() + block_entries * static_cast<std::size_t>(std::lower_bound(begin, end, own) -
                                                                        rows().column.begin());
            const double momentum = (std::abs(block[0]) + std::abs(block[5]) + std::abs(block[10])) / 3;
            for (std::size_t k = 0; k < 3; ++k)
                own_scale[block_size * r + k] = momentum > 0 ? 1 / std::sqrt(momentum) : 1;
            own_scale[block_size * r + 3] = block[15] > 0 ? 1 / std::sqrt(block[15]) : 1;
        });
        scale = gather_rows(ranks, blocks.pattern.numbering, block_size, own_scale);
    }

    /// Calls `visit(row, k, global row of the column, c, entry)` for all entries of an owned row.
    template <class Visit>
    void for_each_entry(std::size_t row, const Visit& visit) const {
        for (auto p = static_cast<std::size_t>(rows().begin[row]);
             p < static_cast<std::size_t>(rows().begin[row + 1]); ++p) {
            double* const block = value.data() + block_entries * p;
            for (std::size_t c = 0; c < block_size; ++c)
                for (std::size_t k = 0; k < block_size; ++k)
                    visit(k, static_cast<std::size_t>(rows().column[p]), c, block[block_size * c + k]);
        }
    }

    /// Scales rows and columns; rows and columns of what is given become those of the unit matrix.
    void scale_and_fix() {
        for_all(rows().count(), [&](std::size_t r) {
            const std::size_t own = static_cast<std::size_t>(rows().first_row) + r;
            for_each_entry(r, [&](std::size_t k, std::size_t column, std::size_t c, double& entry) {
                if (fixed(own, k) || fixed(column, c)) entry = own == column && k == c ? 1 : 0;
                else entry *= own_scale[block_size * r + k] * scale[block_size * column + c];
            });
        });
    }

    /// On one rank the matrix is where it is assembled; between several PETSc has a copy in its own form.
    void make_matrix() {
        const auto count = static_cast<PetscInt>(rows().count()), width = static_cast<PetscInt>(block_size);
        Mat made = nullptr;
        check(MatCreate(ranks.communicator, &made));
        matrix.reset(made);
        check(MatSetSizes(made, width * count, width * count, PETSC_DETERMINE, PETSC_DETERMINE));
        check(MatSetType(made, MATBAIJ));
        check(MatSetBlockSize(made, width));
        check(MatSeqBAIJSetPreallocationCSR(made, width, rows().begin.data(), rows().column.data(), nullptr));
        if (ranks.count == 1) return;
        std::vector<double> by_rows(own_value.size());  // of each block, which is what this way in takes
        for (std::size_t at = 0; at < by_rows.size(); at += block_entries)
            for (std::size_t k = 0; k < block_size; ++k)
                for (std::size_t c = 0; c < block_size; ++c)
                    by_rows[at + block_size * k + c] = own_value[at + block_size * c + k];
        check(MatMPIBAIJSetPreallocationCSR(made, width, rows().begin.data(), rows().column.data(),
                                            by_rows.data()));
    }

    [[nodiscard]] std::span<double> make_values() {
        const std::size_t size = block_entries * rows().column.size();
        if (ranks.count > 1) {
            own_value.resize(size);
            return own_value;
        }
        make_matrix();
        double* place = nullptr;
        check(MatSeqBAIJGetArray(matrix.get(), &place));
        return {place, size};
    }

    void tell_of_new_values() {
        if (ranks.count > 1) return make_matrix();
        double* place = value.data();
        check(MatSeqBAIJRestoreArray(matrix.get(), &place));
        check(MatAssemblyBegin(matrix.get(), MAT_FINAL_ASSEMBLY));
        check(MatAssemblyEnd(matrix.get(), MAT_FINAL_ASSEMBLY));
    }

    void make_solver() {
        KSP made = nullptr;
        check(KSPCreate(ranks.communicator, &made));
        solver.reset(made);
        check(KSPSetOptionsPrefix(made, "flow_"));
        check(KSPSetOperators(made, matrix.get(), matrix.get()));
        check(KSPSetType(made, triangular ? KSPFGMRES : KSPGMRES));
        check(KSPGMRESSetRestart(made, restart));
        check(KSPSetPCSide(made, PC_RIGHT));
        PC preconditioner = nullptr;
        check(KSPGetPC(made, &preconditioner));
        if (triangular) {
            check(PCSetType(preconditioner, PCSHELL));
            check(PCShellSetContext(preconditioner, triangular.get()));
            check(PCShellSetApply(preconditioner, apply_triangular));
        } else {
            check(PCSetType(preconditioner, ranks.count == 1 ? PCILU : PCBJACOBI));
        }
        check(KSPSetTolerances(made, no_tolerance, 0.0, PETSC_DEFAULT, most_iterations));
        check(KSPSetFromOptions(made));
        double rtol = 0, atol = 0;
        check(KSPGetTolerances(made, &rtol, &atol, nullptr, nullptr));
        users_tolerance = rtol != no_tolerance || atol != 0;
        listen_on_the_way(made, ranks);
    }
};

FlowSolver::FlowSolver(const Ranks& ranks, const BlockPattern& blocks, std::vector<char> fixed)
    : parts_(new Parts{ranks, blocks, std::move(fixed), {}, {}, {}, {}, 0, false, {}, {}, {}, {}, {}}) {
    const std::size_t size = block_size * blocks.pattern.rows.count();
    parts_->right = make_vector(ranks, size);
    parts_->unknown = make_vector(ranks, size);
    parts_->value = parts_->make_values();
}

FlowSolver::~FlowSolver() = default;

bool FlowSolver::has_matrix() const { return parts_->solver != nullptr; }
std::span<double> FlowSolver::values() { return parts_->value; }
int FlowSolver::iterations() const { return parts_->iterations; }

void FlowSolver::take(const PressureScales* scales) {
    Parts& p = *parts_;
    p.solver.reset();
    p.triangular.reset();
    p.find_scales();
    p.scale_and_fix();
    p.tell_of_new_values();
    if (scales != nullptr)
        p.triangular = std::make_unique<Triangular>(p.ranks, p.blocks, p.value, *scales, p.scale, p.own_scale);
    p.make_solver();
}

double FlowSolver::size(const std::vector<double>& residual) const {
    const Parts& p = *parts_;
    double sum = 0;
    for (std::size_t r = 0; r < p.rows().count(); ++r) {
        const std::size_t own = static_cast<std::size_t>(p.rows().first_row) + r;
        for (std::size_t k = 0; k < block_size; ++k)
            if (!p.fixed(own, k)) {
                const double scaled = residual[block_size * r + k] * p.own_scale[block_size * r + k];
                sum += scaled * scaled;
            }
    }
    return std::sqrt(total(p.ranks, sum));
}

double FlowSolver::size_of_terms(const std::vector<double>& unknown) const {
    const Parts& p = *parts_;
    double sum = 0;
    for (std::size_t r = 0; r < p.rows().count(); ++r) {
        std::array<double, block_size> terms = {};
        p.for_each_entry(r, [&](std::size_t k, std::size_t column, std::size_t c, double entry) {
            const std::size_t at = block_size * column + c;
            terms[k] += std::abs(entry * unknown[at] / p.scale[at]);
        });
        for (double term : terms) sum += term * term;
    }
    return std::sqrt(total(p.ranks, sum));
}

std::vector<double> FlowSolver::solve(const std::vector<double>& residual, double tolerance) {
    Parts& p = *parts_;
    with_entries(p.right.get(), [&](double* entry) {
        for (std::size_t r = 0; r < p.rows().count(); ++r)
            for (std::size_t k = 0; k < block_size; ++k) {
                const std::size_t at = block_size * r + k;
                entry[at] = p.fixed(static_cast<std::size_t>(p.rows().first_row) + r, k)
                                ? 0
                                : -residual[at] * p.own_scale[at];
            }
    });
    KSP solver = p.solver.get();
    if (!p.users_tolerance) check(KSPSetTolerances(solver, tolerance, 0.0, PETSC_DEFAULT, PETSC_DEFAULT));
    check(KSPSolve(solver, p.right.get(), p.unknown.get()));
    heed(p.ranks);
    PetscInt taken = 0;
    KSPConvergedReason reason{};
    check(KSPGetIterationNumber(solver, &taken));
    check(KSPGetConvergedReason(solver, &reason));
    p.iterations += static_cast<int>(taken);
    if (reason <= 0) {
        std::ostringstream message;
        message << "the flow solver did not converge: " << KSPConvergedReasons[reason] << " after " << taken
                << " iterations";
        throw SolverError(message.str());
    }
    std::vector<double> found(p.own_scale.size());
    with_entries_of(p.unknown.get(), [&](const double* entry) {
        for (std::size_t at = 0; at < found.size(); ++at) found[at] = entry[at] * p.own_scale[at];
    });
    return gather_rows(p.ranks, p.blocks.pattern.numbering, block_size, found);
}

void rehearse_flow(const Ranks& ranks) {
    BlockPattern blocks;
    blocks.pattern.rows = chain();
    const SparseRows& rows = blocks.pattern.rows;
    const PressureScales scales{std::vector<double>(rows.column.size(), 1.0), std::vector<double>(rows.count(), 1.0)};
    for (const PressureScales* chosen : {static_cast<const PressureScales*>(nullptr), &scales}) {
        FlowSolver solver(ranks, blocks, std::vector<char>(block_size * rows.count(), 0));
        const std::span<double> values = solver.values();
        for (std::size_t r = 0; r < rows.count(); ++r)
            for (auto k = static_cast<std::size_t>(rows.begin[r]); k < static_cast<std::size_t>(rows.begin[r + 1]); ++k)
                for (std::size_t i = 0; i < block_size; ++i)
                    values[block_entries * k + (block_size + 1) * i] =
                        rows.column[k] == static_cast<PetscInt>(r) ? 2.1 : -1.0;
        solver.take(chosen);
        (void)solver.solve(std::vector<double>(block_size * rows.count(), 1.0), 0.5);
    }
}

}  // namespace kropla
