#pragma once

#include <kropla/mesh/mesh.h>

#include <string>

namespace kropla {

/// Checks every rule a mesh lives by, and names the first that is broken, with the cell's number and place;
/// empty if all hold. Rules: indices exist; tets positively oriented (exact predicate); facets of no more
/// than two cells; neighbours mutual and sharing their facet; a patch on each boundary facet and on no other;
/// `tet_at` right; free slots listed; the cells at each vertex in one piece; the boundary and each region's
/// surface closed and nowhere touching themselves along an edge; of prism layers: columns of vertices that
/// exist, each once; `layer_at` right; walls closed, two layers of a body on one; the corner Jacobians of all
/// prisms positive; the tets' facets of a layer's patches just the triangles of its wall (none, if a layer is
/// on both its sides) and of its shell, by tets of the other region and of the layer's. Sees the whole mesh:
/// for tests, `check` and debug runs.
[[nodiscard]] std::string verify(const Mesh& mesh);

}  // namespace kropla
