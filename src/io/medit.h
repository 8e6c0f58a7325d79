#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/file_cells.h>

#include <filesystem>

namespace kropla {

// Medit's `.mesh` files, as text: what MMG, tetgen, Gmsh and FreeFEM read and write. References of cells are regions, those
// of triangles and quads patches. The format has no names; ours stand in lines of comment, which readers pass over:
//
//     # region 1 rotor
//     # patch 2 inlet

/// Throws FileError, with file and line, if the file is not of this kind, is cut off, has cells of volume that are
/// neither linear tets nor prisms, vertices that do not exist, or coordinates that are not finite; or has no tets.
[[nodiscard]] FileCells read_medit(const std::filesystem::path& path, const Watch* watch = nullptr);

/// Coordinates come back bit for bit. Fields and layers of prisms are not written. The file gets its name when it is
/// complete. Throws FileError with the path and the system's reason.
void write_medit(const std::filesystem::path& path, const FileCells& cells, const Watch* watch = nullptr);

}  // namespace kropla
