#pragma once

#include <filesystem>

namespace kropla {

/// From one mesh file to another, their formats by their extensions.
struct MeshFiles {
    std::filesystem::path in, out;
    int threads = 0;  // of improve: as in RunOptions
};

/// `kropla convert`: the same mesh in another format, tidied (io/file_cells.h); prints what it holds and what was done.
/// Throws CaseError if a name has no known extension, FileError if a file cannot be read or written, Interrupted.
int convert_mesh(const MeshFiles& files);

/// `kropla improve`: the mesh with better tets, its boundary, interfaces and prisms as they are; prints how good it was
/// and is. Throws as above, and FileError if it overlaps itself.
int improve_mesh_file(const MeshFiles& files);

}  // namespace kropla
