#pragma once

#include <kropla/base/watch.h>

#include <petscksp.h>

#include <filesystem>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace kropla {

/// Throws SolverError with PETSc's own words if `code` is not success, std::bad_alloc if there
/// was no memory. Every call of PETSc goes through here.
void check(PetscErrorCode code);

/// Processes that solve together, and which of them this one is.
struct Ranks {
    MPI_Comm communicator;
    int rank;
    int count;
    Watch* watch = nullptr;  // of this process, heeded by all together (stop.h)
};

/// PETSc and MPI from construction to destruction: one per process, and all that uses PETSc ends before it.
/// Without mpirun it is one rank alone. PETSc's signal handlers stay off, its errors come as SolverError.
class PetscSession {
public:
    /// `options` are PETSc's, as on a command line: {"-ksp_type", "bcgs", "-ksp_rtol", "1e-10"}.
    explicit PetscSession(std::vector<std::string> options = {});
    ~PetscSession();
    PetscSession(const PetscSession&) = delete;
    PetscSession& operator=(const PetscSession&) = delete;

    /// All processes that mpirun started.
    [[nodiscard]] Ranks all_ranks() const;
    /// This process by itself.
    [[nodiscard]] Ranks this_rank() const { return {PETSC_COMM_SELF, 0, 1}; }

private:
    std::vector<std::string> words_;  // PETSc keeps pointers into the command line
    std::vector<char*> arguments_;
    std::filesystem::path folder_;  // of a process that is alone, for MPI; as long as this
};

struct PetscDestroy {
    void operator()(Vec v) const { VecDestroy(&v); }
    void operator()(Mat m) const { MatDestroy(&m); }
    void operator()(KSP k) const { KSPDestroy(&k); }
    void operator()(VecScatter s) const { VecScatterDestroy(&s); }
    void operator()(MatNullSpace n) const { MatNullSpaceDestroy(&n); }
};
using OwnedVec = std::unique_ptr<std::remove_pointer_t<Vec>, PetscDestroy>;
using OwnedMat = std::unique_ptr<std::remove_pointer_t<Mat>, PetscDestroy>;
using OwnedKsp = std::unique_ptr<std::remove_pointer_t<KSP>, PetscDestroy>;
using OwnedScatter = std::unique_ptr<std::remove_pointer_t<VecScatter>, PetscDestroy>;
using OwnedNullSpace = std::unique_ptr<std::remove_pointer_t<MatNullSpace>, PetscDestroy>;

}  // namespace kropla
