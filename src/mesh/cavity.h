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

/// What the cells of a proposal call the k-th vertex that it inserts. No vertex of a mesh has such a name, so that a
/// proposal stays as it is whatever else is carried out before it.
[[nodiscard]] constexpr Vertex inserted_vertex(std::size_t k) { return Vertex(-2 - static_cast<std::int32_t>(k)); }

/// A proposed change of connectivity: cells to be replaced, cells to take their place, and what it would do
/// to the worst aspect ratio R/r among them. `inserted` are the places of new vertices, called
/// inserted_vertex(0), inserted_vertex(1), ...; vertices left without a cell are removed.
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

/// What a proposal has become, in its order.
struct Replacement {
    std::vector<Tet> cells;        // those added
    std::vector<Vertex> vertices;  // those inserted
};
/// Carries out a legal proposal: the only function that changes the connectivity of a mesh. Work is proportional to the
/// cavity. New cells take the slots of those removed, then free ones, then new ones; new vertices free ones, then new ones.
/// Throws std::logic_error, the mesh untouched, if the facets of the cavity would not close, or if it names
/// cells or vertices that do not exist: a mistake of the operator.
Replacement replace_cells(Mesh& mesh, const Cavity& cavity);

}  // namespace kropla
