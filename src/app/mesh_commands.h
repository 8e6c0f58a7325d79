#pragma once

#include <filesystem>

namespace kropla {

/// From one mesh file to another, their formats by their extensions.
struct MeshFiles {
    std::filesystem::path in, out;
    int threads = 0;  // of improve: as in RunOptions
    bool remesh_surface = false;  // of improve: triangles at which two regions meet may change
};

/// `kropla convert`: the same mesh in another format, tidied (io/file_cells.h); prints what it holds and what was done.
/// Throws CaseError if a name has no known extension, FileError if a file cannot be read or written, Interrupted.
int convert_mesh(const MeshFiles& files);

/// `kropla improve`: the mesh with better tets, its boundary and prisms as they are, and its interfaces, unless these are to be
/// adapted too (`loose_interfaces`, those that can be); prints how good it was and is. Throws as above, and FileError if it overlaps itself.
int improve_mesh_file(const MeshFiles& files);

}  // namespace kropla
