#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/file_cells.h>

#include <filesystem>

namespace kropla {

// Gmsh's `.msh` files. Regions are the physical groups of volumes, patches those of surfaces; where a file has no groups
// of that dimension, entity tags stand for them. A group of several is the first of them. Gmsh has no group 0: what is
// written is region 0 under the next free number, by the name "surroundings" if it has none; a region of that name is
// read as region 0.

/// Versions 2.2 and 4.1, text or binary. Cells come in the order of their tags.
/// Throws FileError, with file and line or byte, if the file is not of this kind, is cut off, has cells of volume that
/// are neither linear tets nor prisms, nodes that do not exist or twice, or coordinates that are not finite; or has no
/// tets.
[[nodiscard]] FileCells read_msh(const std::filesystem::path& path, const Watch* watch = nullptr);

/// Version 4.1, text. Coordinates come back bit for bit. Fields and layers of prisms are not written. The file gets its
/// name when it is complete. Throws FileError with the path and the system's reason.
void write_msh(const std::filesystem::path& path, const FileCells& cells, const Watch* watch = nullptr);

}  // namespace kropla
