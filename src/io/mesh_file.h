#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/file_cells.h>

#include <filesystem>
#include <string_view>

namespace kropla {

/// What the name of a mesh file may end in, as words.
inline constexpr std::string_view mesh_extensions = ".vtu (VTK), .msh (Gmsh) or .mesh (Medit)";
[[nodiscard]] bool is_mesh_file(const std::filesystem::path& path);

/// Reads a mesh by the file's extension, as read_vtu_cells (io/vtk.h), read_msh (io/msh.h) or read_medit (io/medit.h), whose
/// errors it has. Throws FileError for any other extension.
[[nodiscard]] FileCells read_mesh_file(const std::filesystem::path& path, const Watch* watch = nullptr);

/// Writes one likewise; as a whole or not at all.
void write_mesh_file(const std::filesystem::path& path, const FileCells& cells, const Watch* watch = nullptr);

}  // namespace kropla
