#pragma once

#include <kropla/domain/domain.h>

namespace kropla {

// For meshes from elsewhere (Gmsh, TetGen, another code): built by make_mesh, improved as any other, moved by
// MovingMesh. Bodies are regions 1, 2, ... whose surfaces lie in the mesh; facets of the patches 0 ... 5 lie in planes across x
// (0, 1), y (2, 3) and z (4, 5), in which vertices slide; facets of higher patches stay as they are.

/// The domain of such a mesh, without bodies: the box that just holds it, and as its fixed walls the facets of all
/// patches from 6 on but those of prism layers. Throws DomainError, naming vertex and place, if a facet of the patches
/// 0 ... 5 is not in the face of that box, exactly.
[[nodiscard]] Domain domain_of(const Mesh& mesh, const SizeField& size);

/// What the region's cells fill, prisms of layers inside of it too, where they are now: a shape whose surface are the
/// facets between these and other cells, its centre its centroid. It is the shape of a body that the motion has not
/// displaced yet. Throws DomainError if the mesh has no such region, if this reaches the boundary of the mesh, or as
/// `make_surface`: if it touches itself in a point or an edge.
[[nodiscard]] Shape shape_of_region(const Mesh& mesh, Region region);

}  // namespace kropla
