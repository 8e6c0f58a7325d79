#pragma once

#include <kropla/mesh/cells.h>
#include <kropla/mesh/mesh.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace kropla {

struct Edge {
    Vertex a, b;
    bool operator==(const Edge&) const = default;
};

/// A facet, seen from one of its cells: the one opposite `corner` of `tet`.
struct Facet {
    Tet tet;
    int corner;
};

/// The corner of `t` at which `v` stands; 0 ... 3, or -1 if it is not a vertex of the tet.
[[nodiscard]] int corner_of(const Mesh& mesh, Tet t, Vertex v);

/// The three vertices of the facet, their normal (right hand) pointing out of its tet.
[[nodiscard]] std::array<Vertex, 3> facet_vertices(const Mesh& mesh, Facet f);
/// The same of a tet by its vertices, opposite `corner`.
[[nodiscard]] inline std::array<Vertex, 3> facet_vertices(const std::array<Vertex, 4>& tet, int corner) {
    const auto [i, j, k] = tet_facets[as_size(corner)];
    return {tet[as_size(i)], tet[as_size(j)], tet[as_size(k)]};
}

/// Their numbers ascending: what both cells at a facet call it.
[[nodiscard]] inline std::array<Vertex, 3> sorted(std::array<Vertex, 3> facet) {
    std::ranges::sort(facet);
    return facet;
}

/// Edge k of the tet, numbered as in cells.h.
[[nodiscard]] inline Edge tet_edge(const Mesh& mesh, Tet t, std::size_t k) {
    const auto [i, j] = tet_edges[k];
    return {mesh.tets[t][as_size(i)], mesh.tets[t][as_size(j)]};
}

/// The corner of `neighbour` that faces the facet `f`, across which it lies.
[[nodiscard]] int mirror_corner(const Mesh& mesh, Facet f);

/// All tets of the mesh, without free slots, in order; or those of one region.
[[nodiscard]] std::vector<Tet> all_tets(const Mesh& mesh, Region only = {});

/// The tets at `v`, each once.
[[nodiscard]] std::vector<Tet> ball(const Mesh& mesh, Vertex v);
/// As above, into `tets`, which is emptied first: for loops that ask often.
void ball(const Mesh& mesh, Vertex v, std::vector<Tet>& tets);

/// The facets opposite `v` of the tets of its ball.
[[nodiscard]] std::vector<Facet> link(const Mesh& mesh, Vertex v);

/// The other ends of the edges at `v`, in ascending order.
[[nodiscard]] std::vector<Vertex> adjacent_vertices(const Mesh& mesh, Vertex v);

/// The tets around an edge, in order, and the vertices around it. tets[i] has the edge, ring[i], ring[i+1];
/// det(b-a, ring[i]-a, ring[i+1]-a) > 0. Closed: the ring ends where it begins and that vertex stands once,
/// so that there are as many tets as ring vertices. Open (an edge on the boundary): one ring vertex more than
/// tets.
struct Shell {
    std::vector<Tet> tets;
    std::vector<Vertex> ring;
    bool closed;
};
/// `t` has the vertices of `e`.
[[nodiscard]] Shell shell(const Mesh& mesh, Edge e, Tet t);
/// As above, into `s`: for loops that ask often.
void shell(const Mesh& mesh, Edge e, Tet t, Shell& s);
/// Nothing if `e` is not an edge of the mesh.
[[nodiscard]] std::optional<Shell> shell(const Mesh& mesh, Edge e);

/// What holds a vertex, an edge or a facet in its place: the boundary patches it lies on, as bits 1 << patch,
/// and whether it lies on an interface between regions.
struct Constraint {
    unsigned patches = 0;
    bool on_interface = false;
    [[nodiscard]] bool free() const { return patches == 0 && !on_interface; }
    /// Held to a surface that is no face of the box: its facets are to stay as they are.
    [[nodiscard]] bool rigid() const { return on_interface || (patches >> box_faces) != 0; }
    bool operator==(const Constraint&) const = default;
};
[[nodiscard]] Constraint constraint(const Mesh& mesh, Vertex v, std::span<const Tet> ball);
[[nodiscard]] Constraint constraint(const Mesh& mesh, const Shell& shell);

}  // namespace kropla
