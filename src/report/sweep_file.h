#pragma once

#include "report/table.h"

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

/// In the folder of a sweep: its table and its page.
inline constexpr const char *sweep_table_name = "sweep.csv", *sweep_page_name = "sweep.html";

/// A run of a sweep, as the table has it.
struct SweptRun {
    std::string name;                 // of its folder
    std::vector<std::string> values;  // per key
    int code = 0;                     // the exit code
    double seconds = 0;               // [s] of wall time
};

struct SweepFile {
    std::vector<std::string> keys;  // of the values that were set
    std::vector<SweptRun> runs;
    std::vector<Column> last;  // of the last steps, a cell per run; empty where a run has none
};

/// Reads DIR/sweep.csv. Throws FileError if it is missing or broken.
[[nodiscard]] SweepFile read_sweep_file(const std::filesystem::path& dir);

}  // namespace kropla
