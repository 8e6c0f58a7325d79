#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

struct SweepOptions {
    std::filesystem::path case_file;
    std::filesystem::path out;                // the folder of the sweep; each run has its own in it
    std::vector<std::string> settings;        // "key=value" and "key=value,value,..." (sweep_plan.h)
    int threads = 0;                          // as in RunOptions
    std::vector<std::string> solver_options;  // as in RunOptions
};

/// Runs a case once for each combination of values, one after another, each in a process of its own; what a run says
/// goes to run.log in its folder. After each, DIR/sweep.csv and DIR/sweep.html have it. Runs that are complete are not
/// run again, one that was interrupted goes on. Returns the largest exit code of its runs, or 130 if it was
/// interrupted. Throws CaseError, before anything is run, if a run's case is wrong; FileError.
[[nodiscard]] int sweep(const SweepOptions& options);

}  // namespace kropla
