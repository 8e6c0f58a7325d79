#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

struct RunOptions {
    std::filesystem::path case_file;
    std::vector<std::string> settings;        // "key=value", put into the case (case/setting.h)
    std::filesystem::path out;                // the folder that the run fills
    bool resume = false;                      // go on from the folder's checkpoint
    bool force = false;                       // overwrite the run that the folder holds
    bool test_rollback = false;               // refuse every step once and redo it
    std::filesystem::path debug_mesh;         // where faulty triangles of a body's surface are written; empty: nowhere
    int threads = 0;                          // 0: as many as there are processors
    std::vector<std::string> solver_options;  // PETSc's, as given: "-ksp_type", "cg"
};

/// Runs a case from start, or from its checkpoint, to end. Returns the exit code: 0, or 130 if it was
/// interrupted and left a checkpoint. Throws Interrupted if that was before there was a first one; CaseError,
/// DomainError, FloorError, SolverError or FileError.
[[nodiscard]] int run(const RunOptions& options);

}  // namespace kropla
