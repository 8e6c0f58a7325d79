#pragma once

#include <kropla/mesh/mesh.h>

#include <span>
#include <vector>

namespace kropla {

/// What differs between two meshes in the same slot numbering: the cells of the old one that are gone, those
/// of the new one that came; in ascending order, each once. In each region they fill the same volume.
struct ChangedCells {
    std::vector<Tet> gone, come;
};

/// Whether the slot is the same tet in both meshes: the same vertices in the same places, of the same region.
[[nodiscard]] bool same_tet(const Mesh& before, const Mesh& after, Tet t);
/// Whether the slot is the same vertex in both meshes, in the same place.
[[nodiscard]] bool same_vertex(const Mesh& before, const Mesh& after, Vertex v);

/// Looks at `cells` and at the balls of `vertices` (slots of either mesh; repeats and what is gone again do
/// no harm), and from each cell that differs at those next to it in both meshes. So what is not named is
/// found if it touches something that is.
[[nodiscard]] ChangedCells changed_cells(const Mesh& before, const Mesh& after, std::span<const Tet> cells,
                                         std::span<const Vertex> vertices);

}  // namespace kropla
