#pragma once

#include <kropla/mesh/mesh.h>

#include <span>

namespace kropla {

/// A prism as a file has it: by itself.
struct LoosePrism {
    int cell = 0;                    // its number in the file
    std::array<Vertex, 6> vertices;  // in the order of mesh/cells.h
    Region region;
    int layer = 0;  // 1, 2, ... counted from the wall

    bool operator==(const LoosePrism&) const = default;
};

/// Gives a mesh that was made of the tets alone the layers that these prisms are: columns from wall to shell,
/// one layer per connected wall and side of it, in the order of their first prisms. The tets' facets on walls
/// and shells get their patches; a layer in the surroundings belongs to the body beyond its wall.
/// Throws FileError, naming the cell where it is one, if the prisms are no stacks: one without another below, two on one
/// place, columns that part or differ in length, a wall that is not a body's; or if there are more than 13 layers.
void attach_layers(Mesh& mesh, std::span<const LoosePrism> prisms);

}  // namespace kropla
