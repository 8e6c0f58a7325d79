#pragma once

#include <kropla/io/file_cells.h>

#include <cstddef>
#include <string>

namespace kropla {

/// The tets of a file as a mesh of their own whose boundary is to stay: all of its facets, those at prisms too, are of the
/// patch `box_faces`. Regions are the file's numbers.
struct FixedMesh {
    Mesh mesh;
    Array<Vertex, Vertex> in_file;  // what its vertices are there
};

/// Throws FileError, naming the cell but not the file, if a facet has more than two cells.
[[nodiscard]] FixedMesh fixed_mesh(const FileCells& cells);

/// Where two cells lie on one side of the facet between them: the first place in words, and how many there are; empty if the
/// mesh has none.
[[nodiscard]] std::string fault_of_sides(const FixedMesh& fixed);

/// Puts the mesh, which may have been changed within its boundary and interfaces, in the place of the file's tets.
/// Vertices that stay keep their numbers but for those that go. Prisms and names stay, fields go, and so do facets
/// that are of no cell any more, as those within a region may be: returns how many.
std::size_t put_back(const FixedMesh& fixed, FileCells& cells);

}  // namespace kropla
