#pragma once

#include <kropla/mesh/prisms.h>

#include <array>
#include <cstddef>
#include <vector>

namespace kropla {

/// Cells to be assembled, tets and prisms. What is done with a cell is written once, for both kinds, in terms
/// of its vertices and its region.
struct Cells {
    std::vector<Tet> tets;
    std::vector<Prism> prisms;
};

/// All cells of the mesh that are no free slots, in order; or those of one region.
[[nodiscard]] Cells living_cells(const Mesh& mesh, Region only = {});

/// Calls `visit(cell)` for the tets, then for the prisms.
template <class Visit>
void for_each_cell(const Cells& cells, const Visit& visit) {
    for (Tet t : cells.tets) visit(t);
    for (const Prism& prism : cells.prisms) visit(prism);
}

[[nodiscard]] inline std::array<Vertex, 4> cell_vertices(const Mesh& mesh, Tet t) { return mesh.tets[t]; }
[[nodiscard]] inline std::array<Vertex, 6> cell_vertices(const Mesh& mesh, const Prism& prism) {
    return prism_vertices(mesh, prism);
}
[[nodiscard]] inline Region cell_region(const Mesh& mesh, Tet t) { return mesh.region[t]; }
[[nodiscard]] inline Region cell_region(const Mesh& mesh, const Prism& prism) {
    return layer_of(mesh, prism.layer).region;
}

/// The pieces that cells are in, its connected components: those that share a vertex are of one.
struct Pieces {
    Array<Vertex, int> of;  // that of the vertex, by number; -1: it is of no cell
    int count = 0;
};
[[nodiscard]] Pieces pieces_of(const Mesh& mesh, const Cells& cells);

/// One more than the largest number of a region that has cells; 0 if there are no cells.
[[nodiscard]] std::size_t count_regions(const Mesh& mesh);

/// Values at the vertices of a cell; zeros if there are none.
template <std::size_t n, class T>
[[nodiscard]] std::array<T, n> at_corners(const Array<Vertex, T>& values, const std::array<Vertex, n>& vertices) {
    std::array<T, n> at = {};
    for (std::size_t i = 0; i < n && !values.empty(); ++i) at[i] = values[vertices[i]];
    return at;
}

template <std::size_t n, class Number>
[[nodiscard]] Number mean_of(const std::array<Number, n>& values) {
    Number sum = 0;
    for (const Number& value : values) sum += value;
    return sum / static_cast<double>(n);
}

/// Where a region ends: triangles with their normal (right hand) out of it. Quads of prisms lie between two.
struct RegionSurface {
    std::vector<std::array<Vertex, 3>> interface;  // to cells of another region
    std::vector<std::array<Vertex, 3>> outer;      // of the domain
};
[[nodiscard]] RegionSurface region_surface(const Mesh& mesh, Region region);
/// The same of the regions 0 ... `regions` - 1, in one go over the mesh.
[[nodiscard]] std::vector<RegionSurface> region_surfaces(const Mesh& mesh, std::size_t regions);

/// The facets of cells on each face of the box, with their normal (right hand) out of it.
using FaceFacets = std::array<std::vector<std::array<Vertex, 3>>, 6>;
[[nodiscard]] FaceFacets facets_of_faces(const Mesh& mesh, const Cells& cells);
/// The vertices of cells, ascending.
[[nodiscard]] std::vector<Vertex> vertices_of(const Mesh& mesh, const Cells& cells);

/// Those of the boundary that are on no face of the box: fixed walls.
[[nodiscard]] std::vector<std::array<Vertex, 3>> facets_of_fixed_walls(const Mesh& mesh, const Cells& cells);

/// The integral of the normal over a facet [m^2].
[[nodiscard]] inline Vec3 area_vector(const Mesh& mesh, const std::array<Vertex, 3>& facet) {
    const Vec3& x = mesh.position[facet[0]];
    return 0.5 * cross(mesh.position[facet[1]] - x, mesh.position[facet[2]] - x);
}

}  // namespace kropla
