#pragma once

#include <kropla/mesh/mesh.h>

#include <vector>

#include <span>

namespace kropla {

/// The aspect ratio R/r of a tet (3 is perfect, infinite if not positively oriented).
[[nodiscard]] double aspect_ratio(const Mesh& mesh, Tet t);
[[nodiscard]] double volume(const Mesh& mesh, Tet t);  // [m^3]
[[nodiscard]] Vec3 centroid(const Mesh& mesh, Tet t);

/// The largest aspect ratio among the tets; 0 for none.
[[nodiscard]] double worst_aspect_ratio(const Mesh& mesh, std::span<const Tet> tets);

/// What is reported of a mesh as a whole. Dihedral angles in degrees.
struct QualitySummary {
    int tets = 0;
    int vertices = 0;
    double max_aspect_ratio = 0, p999_aspect_ratio = 0, mean_aspect_ratio = 0;
    double min_dihedral = 180, max_dihedral = 0;
    Tet worst;  ///< the tet of the largest aspect ratio
};
/// Over all tets, and the vertices of all cells, or over those of one region.
[[nodiscard]] QualitySummary summarise_quality(const Mesh& mesh, Region only = {});

/// Of the tets and prisms of the region [m^3].
[[nodiscard]] double region_volume(const Mesh& mesh, Region region);
/// The same of the regions 0 ... `regions` - 1, in one go over the mesh.
[[nodiscard]] std::vector<double> region_volumes(const Mesh& mesh, std::size_t regions);

}  // namespace kropla
