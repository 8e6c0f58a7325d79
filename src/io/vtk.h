#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/stacks.h>
#include <kropla/simulate/fields.h>

#include <filesystem>
#include <span>

namespace kropla {

/// Writes a frame as a VTU file: the mesh without its free slots, tets before prisms, and the fields as point
/// arrays, vectors as those of three components. Cell arrays:
///
///     region        0 = surroundings, 1... = bodies in order
///     layer         0 for tets, 1... for prisms, counted from the wall
///     aspect_ratio  of a tet R/r; of a prism 3 / its least scaled corner Jacobian (mesh/prisms.h). 3 is perfect
///                   for both, infinity is turned over, and 10 is R/r = 10 or a scaled corner Jacobian of 0.3
///     min_dihedral  [deg] between facets; of a prism measured at its corners, as its quads may be bent
///
/// The file gets its name when it is complete. Throws FileError with the path and the system's reason; Interrupted if
/// the watch says so, and what was there before stays.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh, std::span<const NodalField> fields = {},
               const Watch* watch = nullptr, std::span<const NodalVectorField> vectors = {});

/// What a VTU file says, before neighbours are known: cells as they stand, right or wrong.
struct FileCells {
    Array<Vertex, Vec3> position;            // [m]
    Array<Tet, std::array<Vertex, 4>> tets;  // vertices exist; orientation and conformity are not looked at
    Array<Tet, Region> region;               // 0 where the file has no cell array "region"
    std::vector<LoosePrism> prisms;          // vertices exist
    std::vector<NodalField> fields;          // point arrays of one component
    std::vector<NodalVectorField> vectors = {};  // of three
    std::size_t passed_over = 0;             // cells of surfaces, lines and points, as mesh generators add them
};

/// Throws FileError, in one line, if the file is missing, unreadable, not VTU, truncated or damaged, or has
/// no tets, cells of volume that are neither linear tets nor prisms, prisms without a cell array "layer", cells of vertices
/// that do not exist, or coordinates that are not finite. Tets are numbered in the order of the file, by themselves.
[[nodiscard]] FileCells read_vtu_cells(const std::filesystem::path& path);

struct Frame {
    Mesh mesh;
    std::vector<NodalField> fields;
    std::vector<NodalVectorField> vectors = {};
};

/// The mesh of these cells. A VTU file does not know patches: boundary facets get that of the face of the
/// bounding box in which they lie, exactly by coordinates, or of the layer whose wall or shell they are, else
/// patch 0. The cells are not checked: see `verify`. Throws std::invalid_argument as make_mesh, FileError
/// as attach_layers, naming the cell but not the file.
[[nodiscard]] Frame make_frame(FileCells cells);

/// Both in one; all errors name the file. Throws Interrupted if the watch says so.
[[nodiscard]] Frame read_vtu(const std::filesystem::path& path, const Watch* watch = nullptr);

}  // namespace kropla
