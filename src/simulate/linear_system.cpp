#include "simulate/linear_system.h"

#include "base/error.h"
#include "simulate/stop.h"

#include <algorithm>
#include <sstream>

namespace kropla {
namespace {

std::size_t local(const LinearSystem& system, int row) {
    return static_cast<std::size_t>(row - system.first_row);
}

bool owns(const LinearSystem& system, int row) {
    return row >= system.first_row && row < system.first_row + system.rows();
}

/// Per owned row the rows it is coupled to, itself first, in no order, with repetitions.
std::vector<std::vector<PetscInt>> coupled_rows(const Mesh& mesh, const Cells& cells,
                                                const Numbering& numbering, int first, int rows) {
    std::vector<std::vector<PetscInt>> coupled(static_cast<std::size_t>(rows));
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        for (Vertex a : vertices) {
            const int r = numbering.row[a] - first;
            if (r < 0 || r >= rows) continue;
            for (Vertex b : vertices) coupled[static_cast<std::size_t>(r)].push_back(numbering.row[b]);
        }
    });
    return coupled;
}

OwnedMat make_matrix(const Ranks& ranks, const LinearSystem& system, int all_rows) {
    Mat matrix = nullptr;
    check(MatCreate(ranks.communicator, &matrix));
    OwnedMat owned(matrix);
    check(MatSetSizes(matrix, system.rows(), system.rows(), all_rows, all_rows));
    check(MatSetType(matrix, MATAIJ));
    const PetscInt *begin = system.begin.data(), *column = system.column.data();
    check(MatSeqAIJSetPreallocationCSR(matrix, begin, column, system.value.data()));
    check(MatMPIAIJSetPreallocationCSR(matrix, begin, column, system.value.data()));
    return owned;
}

OwnedVec make_vector(const Ranks& ranks, const std::vector<double>& values) {
    Vec vector = nullptr;
    check(VecCreateMPI(ranks.communicator, static_cast<PetscInt>(values.size()), PETSC_DETERMINE, &vector));
    OwnedVec owned(vector);
    double* place = nullptr;
    check(VecGetArrayWrite(vector, &place));
    std::copy(values.begin(), values.end(), place);
    check(VecRestoreArrayWrite(vector, &place));
    return owned;
}

OwnedKsp make_solver(const Ranks& ranks, Mat matrix, const SolverChoice& choice) {
    KSP solver = nullptr;
    check(KSPCreate(ranks.communicator, &solver));
    OwnedKsp owned(solver);
    check(KSPSetOptionsPrefix(solver, choice.prefix.c_str()));
    check(KSPSetOperators(solver, matrix, matrix));
    check(KSPSetType(solver, choice.method.c_str()));
    PC preconditioner = nullptr;
    check(KSPGetPC(solver, &preconditioner));
    check(PCSetType(preconditioner, choice.preconditioner.c_str()));
    check(KSPSetTolerances(solver, choice.relative_tolerance, PETSC_DEFAULT, PETSC_DEFAULT,
                           choice.most_iterations));
    check(KSPSetInitialGuessNonzero(solver, PETSC_TRUE));
    if (choice.singular) check(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED));
    check(KSPSetFromOptions(solver));
    listen_on_the_way(solver, ranks);
    return owned;
}

std::vector<double> gather(Vec vector) {
    VecScatter scatter = nullptr;
    Vec everywhere = nullptr;
    check(VecScatterCreateToAll(vector, &scatter, &everywhere));
    const OwnedScatter owned_scatter(scatter);
    const OwnedVec owned(everywhere);
    check(VecScatterBegin(scatter, vector, everywhere, INSERT_VALUES, SCATTER_FORWARD));
    check(VecScatterEnd(scatter, vector, everywhere, INSERT_VALUES, SCATTER_FORWARD));
    PetscInt size = 0;
    check(VecGetSize(everywhere, &size));
    const double* values = nullptr;
    check(VecGetArrayRead(everywhere, &values));
    std::vector<double> copy(values, values + size);
    check(VecRestoreArrayRead(everywhere, &values));
    return copy;
}

void throw_unless_converged(KSP solver, const SolverChoice& choice) {
    KSPConvergedReason reason{};
    check(KSPGetConvergedReason(solver, &reason));
    if (reason > 0) return;
    PetscInt iterations = 0;
    double residual = 0;
    check(KSPGetIterationNumber(solver, &iterations));
    check(KSPGetResidualNorm(solver, &residual));
    std::ostringstream message;
    message << "the " << choice.name << " solver did not converge: " << KSPConvergedReasons[reason]
            << " after " << iterations << " iterations, residual " << residual;
    throw SolverError(message.str());
}

/// |b - A x| / |b|, or |A x| if b is zero.
double relative_residual(Mat matrix, Vec right, Vec unknown) {
    Vec rest = nullptr;
    check(VecDuplicate(right, &rest));
    const OwnedVec owned(rest);
    check(MatMult(matrix, unknown, rest));
    check(VecAYPX(rest, -1.0, right));
    double error = 0, size = 0;
    check(VecNorm(rest, NORM_2, &error));
    check(VecNorm(right, NORM_2, &size));
    return size > 0 ? error / size : error;
}

}  // namespace

LinearSystem empty_system(const Mesh& mesh, const Cells& cells, const Numbering& numbering, int rank) {
    const auto k = static_cast<std::size_t>(rank);
    LinearSystem system;
    system.first_row = numbering.first_row[k];
    const int rows = numbering.first_row[k + 1] - system.first_row;
    system.begin.push_back(0);
    for (auto& row : coupled_rows(mesh, cells, numbering, system.first_row, rows)) {
        std::ranges::sort(row);
        const auto repeated = std::ranges::unique(row);
        system.column.insert(system.column.end(), row.begin(), repeated.begin());
        system.begin.push_back(static_cast<PetscInt>(system.column.size()));
    }
    system.value.assign(system.column.size(), 0.0);
    system.right.assign(static_cast<std::size_t>(rows), 0.0);
    system.guess.assign(static_cast<std::size_t>(rows), 0.0);
    return system;
}

void add_to(LinearSystem& system, int row, int column, double value) {
    if (!owns(system, row)) return;
    const std::size_t r = local(system, row);
    const auto first = system.column.begin() + system.begin[r];
    const auto place = std::lower_bound(first, system.column.begin() + system.begin[r + 1], column);
    system.value[static_cast<std::size_t>(place - system.column.begin())] += value;
}

void add_to_right(LinearSystem& system, int row, double value) {
    if (owns(system, row)) system.right[local(system, row)] += value;
}

void fix_unknown(LinearSystem& system, int row, double value) {
    if (!owns(system, row)) return;
    const std::size_t r = local(system, row);
    for (PetscInt k = system.begin[r]; k < system.begin[r + 1]; ++k) {
        const auto place = static_cast<std::size_t>(k);
        if (system.column[place] == row) system.right[r] = system.value[place] * value;
        else system.value[place] = 0.0;
    }
    system.guess[r] = value;
}

Solution solve(const Ranks& ranks, const LinearSystem& system, const SolverChoice& choice) {
    heed(ranks);
    const OwnedVec right = make_vector(ranks, system.right);
    const OwnedVec unknown = make_vector(ranks, system.guess);
    PetscInt all_rows = 0;
    check(VecGetSize(right.get(), &all_rows));
    const OwnedMat matrix = make_matrix(ranks, system, all_rows);
    OwnedNullSpace constants;
    if (choice.singular) {
        MatNullSpace space = nullptr;
        check(MatNullSpaceCreate(ranks.communicator, PETSC_TRUE, 0, nullptr, &space));
        constants.reset(space);
        check(MatSetNullSpace(matrix.get(), space));
    }
    const OwnedKsp solver = make_solver(ranks, matrix.get(), choice);
    check(KSPSolve(solver.get(), right.get(), unknown.get()));
    heed(ranks);
    throw_unless_converged(solver.get(), choice);
    PetscInt iterations = 0;
    check(KSPGetIterationNumber(solver.get(), &iterations));
    return {gather(unknown.get()), static_cast<int>(iterations),
            relative_residual(matrix.get(), right.get(), unknown.get())};
}

}  // namespace kropla
