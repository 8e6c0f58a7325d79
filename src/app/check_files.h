#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kropla {

/// The VTU files meant by paths: those of a run's folder (or of any folder with VTU files), in the order of their
/// names, those that a PVD file lists, or the file itself. Throws FileError if a folder or list has none, or a list
/// cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> files_to_check(std::span<const std::filesystem::path> paths);

/// What `kropla check` says of one of many files: one line with its end.
struct CheckLine {
    bool valid = false;
    std::string text;
};
/// Valid, with its counts and worst cell; or why it is not, or cannot be read.
[[nodiscard]] CheckLine check_line(const std::filesystem::path& path);

}  // namespace kropla
