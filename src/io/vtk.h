#pragma once

#include <kropla/base/watch.h>
#include <kropla/io/file_cells.h>
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
/// and those given. The file gets its name when it is complete. Throws FileError with the path and the system's reason; Interrupted if
/// the watch says so, and what was there before stays.
void write_vtu(const std::filesystem::path& path, const Mesh& mesh, std::span<const NodalField> fields = {},
               const Watch* watch = nullptr, std::span<const NodalVectorField> vectors = {},
               std::span<const CellField> of_cells = {});

/// Writes cells, facets of patches as cells of their own, and names, as VTU. Cell arrays: `region` and `layer` as above, and
/// `patch` of facets; where a cell has none, -1. Names are arrays of texts of the whole file, "3 rotor": `region_names`
/// and `patch_names`.
void write_vtu(const std::filesystem::path& path, const FileCells& cells, const Watch* watch = nullptr);

/// Throws FileError, in one line, if the file is missing, unreadable, not VTU, truncated or damaged, or has
/// no tets, cells of volume that are neither linear tets nor prisms, cells of vertices that do not exist, or coordinates
/// that are not finite. Tets are numbered in the order of the file, by themselves. Triangles and quads are facets if
/// there is a cell array "patch", else they are passed over.
[[nodiscard]] FileCells read_vtu_cells(const std::filesystem::path& path, const Watch* watch = nullptr);

struct Frame {
    Mesh mesh;
    std::vector<NodalField> fields;
    std::vector<NodalVectorField> vectors = {};
};

/// The mesh of these cells. Boundary facets get the patch of the face of the bounding box in which they lie, exactly by
/// coordinates, or of the layer whose wall or shell they are, else patch 0. Prisms of no layer get one (number_layers). The cells are not checked: see `verify`. Throws FileError as
/// make_mesh, number_layers and attach_layers, naming the cell but not the file.
[[nodiscard]] Frame make_frame(FileCells cells);

/// Both in one; all errors name the file. Throws Interrupted if the watch says so.
[[nodiscard]] Frame read_vtu(const std::filesystem::path& path, const Watch* watch = nullptr);

}  // namespace kropla
