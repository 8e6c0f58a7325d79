#pragma once

#include <kropla/base/index.h>
#include <kropla/base/vec3.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

using Vertex = Index<struct VertexTag>;
using Tet = Index<struct TetTag>;
using Region = Index<struct RegionTag>;  ///< a part of the volume: 0 the surroundings, 1, 2, ... the bodies
using Patch = Index<struct PatchTag>;    ///< a part of the boundary: 0 ... 5 the faces of the box; up to 31
using Layer = Index<struct LayerTag>;    ///< a prism layer: its place in Mesh::layers

/// Patches below this are plane, x min, x max, y min, ... z max: facets on them may be exchanged for others
/// in the same plane. Facets of all other patches are to stay as they are.
inline constexpr int box_faces = 6;
inline constexpr Region surroundings{0};

/// Prisms in stacks on one side of a body's surface: a triangulated wall and, for each of its vertices, a
/// column of `count` + 1 vertices from the wall to the shell. Prism (triangle, k) is implied: cells.h draws
/// it. The tets see a layer as two patches of their boundary, its wall and its shell (prisms.h).
struct PrismLayer {
    Region region;  // of the prisms: the surroundings, or the body for a layer inside it
    Region body;    // on whose surface it stands
    int count = 0;  // prisms per column
    std::vector<std::array<int, 3>> triangles;  // columns; counter-clockwise seen from the shell
    std::vector<Vertex> columns;                // count + 1 per column, the wall's vertex first

    bool operator==(const PrismLayer&) const = default;
};

/// A mesh of tetrahedra and of layers of prisms, as a value: copy it to keep it. Its invariant is `verify`;
/// `replace_cells` is the only function that changes its connectivity. Interfaces are where regions differ;
/// nothing else records them.
///
/// Removed cells and vertices leave free slots, which later ones take, so that nothing else is renumbered:
/// pass over them with `alive`.
struct Mesh {
    Array<Vertex, Vec3> position;              // [m]
    Array<Vertex, Tet> tet_at;                 // one tet of its ball, where a query starts, if it has one
    Array<Vertex, Layer> layer_at;  // the layer (the first, if two) that has it in a column, if one has
    Array<Tet, std::array<Vertex, 4>> tets;    // det(v1-v0, v2-v0, v3-v0) > 0; a free slot has no vertices
    Array<Tet, std::array<Tet, 4>> neighbour;  // across the facet opposite corner i, or none
    Array<Tet, std::array<Patch, 4>> patch;    // boundary patch of that facet, where there is no neighbour
    Array<Tet, Region> region;
    std::vector<Tet> free_tets;
    std::vector<Vertex> free_vertices;         // slots of neither a tet nor a layer
    std::vector<PrismLayer> layers;

    bool operator==(const Mesh&) const = default;
};

[[nodiscard]] inline bool alive(const Mesh& mesh, Tet t) { return mesh.tets[t][0].exists(); }
[[nodiscard]] inline bool alive(const Mesh& mesh, Vertex v) {
    return mesh.tet_at[v].exists() || mesh.layer_at[v].exists();
}

[[nodiscard]] inline int count_tets(const Mesh& mesh) {
    return static_cast<int>(mesh.tets.size() - mesh.free_tets.size());
}
[[nodiscard]] inline int count_vertices(const Mesh& mesh) {
    return static_cast<int>(mesh.position.size() - mesh.free_vertices.size());
}

/// A facet of the boundary, by its vertices in any order, and the patch it belongs to.
struct BoundaryFacet {
    std::array<Vertex, 3> vertices;
    Patch patch;
};

/// Builds a mesh from cells by their vertices; neighbours are found by sorting facets. Boundary facets that
/// are not in `boundary` get patch 0. Vertices of no tet become free slots. The tets are not checked: see
/// `verify`.
/// Throws std::invalid_argument, naming the cell or boundary facet, if a facet has more than two cells or a vertex does
/// not exist.
[[nodiscard]] Mesh make_mesh(Array<Vertex, Vec3> position, Array<Tet, std::array<Vertex, 4>> tets,
                             Array<Tet, Region> region, std::span<const BoundaryFacet> boundary = {});

/// The mesh without free slots, and where each of its vertices and cells was before.
struct Compacted {
    Mesh mesh;
    Array<Vertex, Vertex> old_vertex;
    Array<Tet, Tet> old_tet;
};
[[nodiscard]] Compacted compact(const Mesh& mesh);
/// The same with vertices and tets in the order given, which holds each that is alive once.
[[nodiscard]] Compacted reorder(const Mesh& mesh, Array<Vertex, Vertex> vertices, Array<Tet, Tet> tets);

/// Makes `to` equal to `from` where they may differ: in the slots of `tets`, in the places of `vertices`, and in the
/// layers, whose vertices are to be named if they have moved, but not if the layers themselves are others.
/// Work is proportional to those, to the free slots and to the layers' vertices.
void copy_changed(Mesh& to, const Mesh& from, std::span<const Tet> tets, std::span<const Vertex> vertices);

}  // namespace kropla
