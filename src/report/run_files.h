#pragma once

#include "io/pvd.h"
#include "report/table.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// What a run has left in its folder, without the frames themselves.
struct RunFiles {
    std::filesystem::path dir;
    std::string name;  // of the folder
    std::string case_text;
    Table steps;
    std::optional<Table> bodies;      // their sizes; runs of older versions have none
    std::vector<SeriesEntry> frames;  // by time
};

/// Reads DIR/case.toml, steps.csv, bodies.csv where it is there, and frames.pvd. Throws FileError, naming the
/// file, if another is missing or one is broken.
[[nodiscard]] RunFiles read_run_files(const std::filesystem::path& dir);

/// The number that stands as `key` in the table `[section]` of a case as run; nothing if there is none. It
/// knows the plain form in which a run writes its case, not all of TOML.
[[nodiscard]] std::optional<double> number_of_case(std::string_view case_text, std::string_view section,
                                                   std::string_view key);

}  // namespace kropla
