#pragma once

#include <filesystem>

namespace kropla {

/// Writes DIR/sweep.html, the runs of a sweep compared, from DIR/sweep.csv and the steps.csv of each: a table, and for
/// each column that differs between runs a chart of its last value over the first key that has several values, of
/// complete runs, and one of it over time. The page needs nothing but itself, and leads to the runs' own. Throws
/// FileError, naming the file, if one is missing or broken, or the page cannot be written.
void write_sweep_report(const std::filesystem::path& dir);

}  // namespace kropla
