#pragma once

#include <filesystem>
#include <string>

namespace kropla {

/// What `kropla check` says of a file.
struct CheckReport {
    bool valid = false;
    std::string text;  // at most 80 columns but for the file's name, ends with a newline
};

/// Reads a VTU file and tells whether it holds a valid mesh, or the first fault with its cell and place;
/// counts, volumes, the layers of prisms (least scaled corner Jacobian; the ranges of their first height, growth and
/// thickness), and the distribution of aspect ratio and dihedral angles of the tets per region; the worst tet.
/// Throws FileError if there is no mesh to be had from the file at all.
[[nodiscard]] CheckReport check_file(const std::filesystem::path& path);

}  // namespace kropla
