#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

#include <cstdint>

namespace kropla {

// Small cases of bodies in a box, for the tests of adaptation and of transfer.

/// A box of 3 x 3 x 4 with a sphere of radius 0.6 at the origin, coarse: 500 ... 1000 tets.
[[nodiscard]] Domain sphere_in_box();

/// The mesh of the domain at t = 0, improved and repaired.
[[nodiscard]] Mesh improved_mesh(const Domain& domain, std::uint64_t seed);

/// The octahedron of ball_of_vertex with its corners drawn in or out to 0.3 ... 3 and moved aside, vertex 0
/// anywhere near its middle; valid.
[[nodiscard]] Mesh random_ball(std::uint64_t seed);

/// Drags `count` vertices of the region, chosen at random among those that are free, almost onto a facet of
/// their link, so that cells there become flat: R/r far above 10. The mesh stays valid. Returns the vertices.
std::vector<Vertex> spoil(Mesh& mesh, Region region, int count, std::uint64_t seed);

/// Makes all facets of the patch `from` facets of the patch `to`.
void rename_patch(Mesh& mesh, Patch from, Patch to);

/// A patch whose facets are to stay as they are: not a face of the box.
inline constexpr Patch rigid_patch{box_faces};

/// The largest aspect ratio of the mesh.
[[nodiscard]] double worst_of(const Mesh& mesh);

/// Its vertices, without free slots.
[[nodiscard]] std::vector<Vertex> all_vertices(const Mesh& mesh);

/// Whether `v` stands on an interface.
[[nodiscard]] bool on_interface(const Mesh& mesh, Vertex v);

}  // namespace kropla
