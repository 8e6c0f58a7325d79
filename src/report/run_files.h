#pragma once

#include <kropla/base/vec3.h>
#include <kropla/io/pvd.h>
#include "report/table.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// In a run's folder, if the run ended early: why, and the mesh as it was last.
inline constexpr const char *ending_name = "ended.toml", *ending_mesh_name = "ended.vtu";

/// Why a run ended early.
struct Ending {
    std::string why;            // a sentence
    std::optional<Vec3> place;  // [m] where
};

/// What a run has left in its folder, without the frames themselves.
struct RunFiles {
    std::filesystem::path dir;
    std::string name;  // of the folder
    std::string case_text;
    Table steps;
    std::optional<Table> bodies;      // their sizes; runs of older versions have none
    std::vector<SeriesEntry> frames;  // by time
    std::optional<Ending> ending = {};
};

/// What a folder is called, however the path to it is written.
[[nodiscard]] std::string folder_name(const std::filesystem::path& dir);

/// Reads DIR/case.toml, steps.csv and frames.pvd, and bodies.csv and ended.toml where they are there. Throws FileError,
/// naming the file, if another is missing or one is broken. Of a run that ended before its first step there may be ended.toml alone.
[[nodiscard]] RunFiles read_run_files(const std::filesystem::path& dir);

/// The number that stands as `key` in the table `[section]` of a case as run; nothing if there is none. It
/// knows the plain form in which a run writes its case, with the values of expressions behind them, not all of TOML.
[[nodiscard]] std::optional<double> number_of_case(std::string_view case_text, std::string_view section,
                                                   std::string_view key);
/// The same of three numbers, `[0, 0, -9.81]`.
[[nodiscard]] std::optional<Vec3> vector_of_case(std::string_view case_text, std::string_view section,
                                                 std::string_view key);

}  // namespace kropla
