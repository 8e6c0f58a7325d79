#pragma once

#include "app/sweep_plan.h"

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

/// What became of a run of a sweep.
struct SweepRow {
    SweepRun run;
    int code = 0;        // the exit code; 128 and the signal's number if a signal ended it
    double seconds = 0;  // [s] of wall time, all that were spent on it
};

/// The rows of DIR/sweep.csv; none if there is no such file. Throws CaseError if it is of a sweep over other keys,
/// FileError if it cannot be read.
[[nodiscard]] std::vector<SweepRow> read_sweep_table(const std::filesystem::path& dir,
                                                     const std::vector<std::string>& keys);

/// Writes DIR/sweep.csv: per run its folder, the values that were set, exit code, seconds, and the last row of the
/// steps.csv in its folder; empty where it has none. Throws FileError.
void write_sweep_table(const std::filesystem::path& dir, const std::vector<std::string>& keys,
                       const std::vector<SweepRow>& rows);

}  // namespace kropla
