#pragma once

#include <kropla/io/fixed_mesh.h>
#include <kropla/step/remesh_interfaces.h>

#include <optional>
#include <vector>

namespace kropla {

/// An interface whose triangles may change: those of the file's facets that lie in it are none, or all of one patch.
struct LooseInterface {
    Interface interface;
    std::optional<int> patch;
};
/// Of the mesh's interfaces those that are apart and of no more than one patch of the file, whole. The others are to stay.
[[nodiscard]] std::vector<LooseInterface> loose_interfaces(const FixedMesh& fixed, const FileCells& cells);

/// Takes the facets of these interfaces from the file, before they change; and gives it those that they have now, when the mesh
/// has been put back.
void take_facets(const FixedMesh& fixed, std::span<const LooseInterface> loose, FileCells& cells);
void give_facets(std::span<const LooseInterface> loose, FileCells& cells);

}  // namespace kropla
