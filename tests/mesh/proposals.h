#pragma once

#include <kropla/mesh/cavity.h>
#include <kropla/mesh/topology.h>

namespace kropla {

// The elementary operations as proposals, by hand, to test replace_cells with. They do not ask whether they
// are legal: see all_positive. Regions are those of the first tet replaced, unless each tet keeps its own.

/// 1-4: a new vertex at `place` inside the tet.
[[nodiscard]] Cavity insertion(const Mesh& mesh, Tet t, const Vec3& place);

/// 2-3: the facet, which has two tets, gives way to the edge between their apexes.
[[nodiscard]] Cavity facet_removal(const Mesh& mesh, Facet f);

/// 3-2: the edge, around which are three tets, gives way to the facet between them.
[[nodiscard]] Cavity edge_removal(const Mesh& mesh, Edge e);

/// 2-2: the edge of a plane boundary face, at which are two tets, gives way to the other diagonal of the
/// face.
[[nodiscard]] Cavity wall_swap(const Mesh& mesh, Edge e);

/// A new vertex at the middle of the edge; each tet of its shell becomes two of the same region and patches.
[[nodiscard]] Cavity edge_split(const Mesh& mesh, Edge e);

/// The vertex `e.a` is drawn along the edge to `e.b`; its other tets keep their region and patches.
[[nodiscard]] Cavity edge_collapse(const Mesh& mesh, Edge e);

/// Where a vertex of the proposal is, be it one of the mesh or one that is inserted.
[[nodiscard]] inline Vec3 place_in(const Mesh& mesh, const Cavity& cavity, Vertex v) {
    for (std::size_t k = 0; k < cavity.inserted.size(); ++k)
        if (v == inserted_vertex(k)) return cavity.inserted[k];
    return mesh.position[v];
}

/// Whether each added tet is positively oriented (exact predicate).
[[nodiscard]] bool all_positive(const Mesh& mesh, const Cavity& cavity);

}  // namespace kropla
