#pragma once

#include <kropla/mesh/mesh.h>

#include <array>
#include <vector>

namespace kropla {

/// A cell that a proposal adds. Facets that lie on the boundary where no facet of the boundary was before (a
/// swap or a split on a face of the box) name their patch; all others find their neighbour or patch by
/// themselves.
struct NewTet {
    std::array<Vertex, 4> vertices;
    Region region;
    std::array<Patch, 4> patch = {};
};

/// A proposed change of connectivity: cells to be replaced, cells to take their place, and what it would do
/// to the worst aspect ratio R/r among them. `inserted` are the places of new vertices, which will be named
/// next_vertex(mesh, 0), next_vertex(mesh, 1), ...; vertices left without a cell are removed.
///
/// It is legal if every added tet is positively oriented (exact predicate), the facets around the cavity
/// stay, and no constrained vertex, edge or facet is lost.
struct Cavity {
    std::vector<Tet> removed;
    std::vector<NewTet> added;
    std::vector<Vec3> inserted;
    double worst_before = 0;
    double worst_after = 0;
};

/// The name that the k-th next inserted vertex will get.
[[nodiscard]] Vertex next_vertex(const Mesh& mesh, std::size_t k = 0);

/// Carries out a legal proposal: the only function that changes the connectivity of a mesh. Returns the added
/// tets, in the order of the proposal. Work is proportional to the cavity.
/// Throws std::logic_error, the mesh untouched, if the facets of the cavity would not close, or if it names
/// cells or vertices that do not exist: a mistake of the operator.
std::vector<Tet> replace_cells(Mesh& mesh, const Cavity& cavity);

}  // namespace kropla
