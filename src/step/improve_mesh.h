#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/mesh/mesh.h>

namespace kropla {

/// Improves a mesh from elsewhere, of which no domain is known: its tets are swapped, its vertices moved, collapsed and
/// inserted, and what that does not help is re-triangulated with the cells around it, at their own size, until no R/r is
/// above `options.good_enough` or nothing helps. Vertices on interfaces and on patches from 6 on stay, with all facets there;
/// those on the patches 0 ... 5 slide in their planes. Ends for every mesh, as `improve` does. Returns what was done.
Changes improve_mesh(Mesh& mesh, const AdaptOptions& options = {});

}  // namespace kropla
