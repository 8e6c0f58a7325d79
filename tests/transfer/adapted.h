#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/mesh/mesh.h>

#include <cstdint>
#include <functional>

namespace kropla {

// Pairs of meshes of one domain, and fields on them, for the tests of transfer.

/// A mesh before and after it was changed at a fixed time.
struct AdaptedMesh {
    Mesh before, after;
    Changes changes;
};

/// A sphere in a box, spoilt, repaired, brought to another size than its own, improved and relaxed, inside
/// the body too: every way in which vertices come, move and go.
[[nodiscard]] AdaptedMesh adapted_mesh(std::uint64_t seed);

/// The mesh with one 2-3 swap inside each region, where one is possible: no vertex changes.
[[nodiscard]] AdaptedMesh swapped_mesh(Mesh mesh);

/// The unit cube, filled by the Delaunay mesh of (n+1)^3 vertices, jittered inside, in its faces and along
/// its edges.
[[nodiscard]] Mesh jittered_cube(int n, std::uint64_t seed);

using NodalValues = Array<Vertex, double>;

[[nodiscard]] NodalValues nodal_values(const Mesh& mesh, const std::function<double(Vertex)>& value);

/// The integral of a field that is linear in every tet, over all tets or those of a region.
[[nodiscard]] double field_integral(const Mesh& mesh, const NodalValues& values, Region only = {});

[[nodiscard]] bool at_region(const Mesh& mesh, Vertex v, Region region);

}  // namespace kropla
