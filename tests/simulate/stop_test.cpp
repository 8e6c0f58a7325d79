// Solutions that are ended from outside.
#include "meshes.h"
#include "session.h"
#include "simulate/stop.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

HeatOptions warm_block() {
    return {.regions = {HeatRegion{.material = {.conductivity = 2, .density = 3, .specific_heat = 5},
                                   .initial = 10}}};
}

TEST(Stop, BeforeTheStepLeavesTheTemperature) {
    Watch watch;
    watch.stop = true;
    Ranks ranks = petsc().all_ranks();
    ranks.watch = &watch;
    const Mesh mesh = unit_cube(2);
    NodalField field = initial_temperature(mesh, warm_block());
    const auto untouched = field.values;
    EXPECT_THROW(step_heat(ranks, mesh, mesh, warm_block(), field, 0, 1), Interrupted);
    EXPECT_EQ(field.values, untouched);
}

TEST(Stop, WhileTheSystemIsAssembledLeavesTheTemperature) {
    Watch watch;
    Ranks ranks = petsc().all_ranks();
    ranks.watch = &watch;
    HeatOptions options = warm_block();
    options.regions[0].source = [&](const Vec3&, double) {
        watch.stop = true;
        return 1.0;
    };
    const Mesh mesh = unit_cube(2);
    NodalField field = initial_temperature(mesh, options);
    const auto untouched = field.values;
    EXPECT_THROW(step_heat(ranks, mesh, mesh, options, field, 0, 1), Interrupted);
    EXPECT_EQ(field.values, untouched);
}

/// The one-dimensional Laplacian, which takes as many iterations as it has rows.
OwnedMat chain(PetscInt rows) {
    Mat matrix = nullptr;
    check(MatCreateSeqAIJ(PETSC_COMM_SELF, rows, rows, 3, nullptr, &matrix));
    OwnedMat owned(matrix);
    for (PetscInt i = 0; i < rows; ++i)
        for (PetscInt j = std::max<PetscInt>(0, i - 1); j <= std::min(rows - 1, i + 1); ++j)
            check(MatSetValue(matrix, i, j, i == j ? 2 : -1, INSERT_VALUES));
    check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
    check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
    return owned;
}

PetscErrorCode stop_at_ten(KSP, PetscInt iteration, PetscReal, void* watch) {
    if (iteration == 10) static_cast<Watch*>(watch)->stop = true;
    return {};
}

/// How many iterations the solver takes for the chain, and why it ended.
std::pair<PetscInt, KSPConvergedReason> solve_chain(Watch& watch, bool stopping) {
    constexpr PetscInt rows = 200;
    Ranks ranks = petsc().this_rank();
    ranks.watch = &watch;
    const OwnedMat matrix = chain(rows);
    Vec right = nullptr, unknown = nullptr;
    check(MatCreateVecs(matrix.get(), &unknown, &right));
    const OwnedVec owned_right(right), owned_unknown(unknown);
    check(VecSet(right, 1));
    KSP solver = nullptr;
    check(KSPCreate(PETSC_COMM_SELF, &solver));
    const OwnedKsp owned(solver);
    check(KSPSetOperators(solver, matrix.get(), matrix.get()));
    check(KSPSetType(solver, KSPCG));
    PC none = nullptr;
    check(KSPGetPC(solver, &none));
    check(PCSetType(none, PCNONE));
    if (stopping) check(KSPMonitorSet(solver, stop_at_ten, &watch, nullptr));
    listen_on_the_way(solver, ranks);
    check(KSPSolve(solver, right, unknown));
    PetscInt iterations = 0;
    KSPConvergedReason reason{};
    check(KSPGetIterationNumber(solver, &iterations));
    check(KSPGetConvergedReason(solver, &reason));
    return {iterations, reason};
}

TEST(Stop, EndsASolverOnItsWayAndNoOther) {
    Watch watch;
    const auto [whole, converged] = solve_chain(watch, false);
    EXPECT_EQ(whole, 100);  // half the rows: the right-hand side is symmetric
    EXPECT_GT(converged, 0);
    const auto [some, ended] = solve_chain(watch, true);
    EXPECT_LE(some, 18);
    EXPECT_LT(ended, 0);
}

}  // namespace
}  // namespace kropla
