// Do surfaces cross? Triangles that share vertices are to have nothing else in common.

#include "mesh/crossing.h"

#include <kropla/base/predicates.h>
#include "mesh/box_tree.h"
#include "mesh/triangle.h"
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <numeric>

namespace kropla {
namespace {

/// A facet by its corners' places, and that of its cell's vertex opposite.
struct Triangle {
    std::array<Vertex, 3> vertices;
    Corners place;
    Vec3 apex;
};

Triangle triangle_of(const Mesh& mesh, Facet f) {
    Triangle t{facet_vertices(mesh, f), {}, mesh.position[mesh.tets[f.tet][as_size(f.corner)]]};
    for (std::size_t i = 0; i < 3; ++i) t.place[i] = mesh.position[t.vertices[i]];
    return t;
}

bool has(const Triangle& t, Vertex v) { return std::ranges::find(t.vertices, v) != t.vertices.end(); }

bool in_one_plane(const Triangle& s, const Triangle& t) {
    return std::ranges::all_of(
        t.place, [&](const Vec3& x) { return side(s.place[0], s.place[1], s.place[2], x) == 0; });
}

/// Whether an edge of `s` meets `t`; of its edges at a vertex that both have, only the one opposite is asked.
bool edge_meets(const Triangle& s, const Triangle& t, bool share_one) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t a = (i + 1) % 3, b = (i + 2) % 3;
        if (share_one && !has(t, s.vertices[i])) continue;
        if (meets(s.place[a], s.place[b], t.place, t.apex)) return true;
    }
    return false;
}

/// Of two that share an edge: whether they are folded onto each other.
bool is_folded(const Triangle& s, const Triangle& t) {
    const auto not_in = [](const Triangle& one, const Triangle& other) {
        for (std::size_t i = 0; i < 3; ++i)
            if (!has(other, one.vertices[i])) return i;
        return std::size_t{0};
    };
    const std::size_t i = not_in(s, t), j = not_in(t, s);
    const Vec3 &u = s.place[(i + 1) % 3], &v = s.place[(i + 2) % 3];
    return side(u, v, s.place[i], t.place[j]) == 0 &&
           side(u, v, s.place[i], s.apex) == side(u, v, t.place[j], s.apex);
}

bool cross(const Triangle& s, const Triangle& t) {
    const auto shared = std::ranges::count_if(s.vertices, [&](Vertex v) { return has(t, v); });
    if (shared == 3) return true;
    if (shared == 2) return is_folded(s, t);
    return edge_meets(s, t, shared == 1) || edge_meets(t, s, shared == 1);
}

std::vector<Facet> boundary_facets(const Mesh& mesh) {
    std::vector<Facet> facets;
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4 && alive(mesh, t); ++corner)
            if (!mesh.neighbour[t][as_size(corner)].exists()) facets.push_back({t, corner});
    return facets;
}

Extent extent_of(const Mesh& mesh, std::span<const Vertex> vertices) {
    Extent extent;
    for (const Vertex v : vertices) extent.take_in(mesh.position[v]);
    return extent;
}

/// One facet of each connected part of the boundary.
std::vector<Facet> one_of_each_surface(const Mesh& mesh, std::span<const Facet> facets) {
    Array<Vertex, Vertex> of(mesh.position.size());  // the way to the vertex that stands for its surface
    for (const Vertex v : of.indices()) of[v] = v;
    const auto root = [&](Vertex v) {
        while (of[v] != v) v = of[v] = of[of[v]];
        return v;
    };
    for (const Facet f : facets) {
        const auto v = facet_vertices(mesh, f);
        for (std::size_t i = 1; i < 3; ++i) of[root(v[i])] = root(v[0]);
    }
    std::vector<Facet> firsts;
    Array<Vertex, char> seen(mesh.position.size(), 0);
    for (const Facet f : facets) {
        const Vertex v = root(facet_vertices(mesh, f)[0]);
        if (!seen[v]) firsts.push_back(f);
        seen[v] = 1;
    }
    return firsts;
}

using TetCorners = std::array<Vertex, 4>;

/// Or on a facet: with any corner at `x` the tet is flat, or oriented as it is.
bool is_within(const Mesh& mesh, const Vec3& x, const TetCorners& tet) {
    std::array<Vec3, 4> place;
    for (std::size_t i = 0; i < 4; ++i) place[i] = mesh.position[tet[i]];
    const auto orientation = [](const std::array<Vec3, 4>& p) { return orient3d(p[0], p[1], p[2], p[3]); };
    const int own = orientation(place);
    for (std::size_t i = 0; i < 4 && own != 0; ++i) {
        auto moved = place;
        moved[i] = x;
        if (orientation(moved) * own < 0) return false;
    }
    return own != 0;
}

/// The prism as three tets. Their diagonals rise towards the column of the higher number, so that those of neighbours meet.
std::array<TetCorners, 3> parts_of(const Mesh& mesh, const Prism& prism) {
    const PrismLayer& layer = layer_of(mesh, prism.layer);
    auto columns = layer.triangles[as_size(prism.triangle)];
    std::ranges::sort(columns);
    std::array<Vertex, 3> low, high;
    for (std::size_t i = 0; i < 3; ++i) {
        low[i] = column_vertex(layer, columns[i], prism.k);
        high[i] = column_vertex(layer, columns[i], prism.k + 1);
    }
    return {TetCorners{low[0], low[1], low[2], high[2]}, {low[0], low[1], high[1], high[2]}, {low[0], high[0], high[1], high[2]}};
}

/// A cell at each surface, to be asked for by the place of its middle.
class CellsAtSurfaces {
public:
    explicit CellsAtSurfaces(const Mesh& mesh)
        : mesh_(mesh), facets_(one_of_each_surface(mesh, boundary_facets(mesh))), tree_(middles(mesh, facets_)) {}

    /// One other than `self` whose middle is in the tet; none if there is none.
    [[nodiscard]] Tet any_in(const TetCorners& tet, Tet self) const {
        Tet found;
        tree_.any(extent_of(mesh_, tet), [&](std::size_t i) {
            const Tet cell = facets_[i].tet;
            if (cell == self || !is_within(mesh_, centroid(mesh_, cell), tet)) return false;
            found = cell;
            return true;
        });
        return found;
    }

private:
    static std::vector<Extent> middles(const Mesh& mesh, std::span<const Facet> facets) {
        std::vector<Extent> points(facets.size());
        for (std::size_t i = 0; i < facets.size(); ++i) points[i].take_in(centroid(mesh, facets[i].tet));
        return points;
    }

    const Mesh& mesh_;
    std::vector<Facet> facets_;
    BoxTree tree_;
};

}  // namespace

std::optional<Crossing> find_crossing(const Mesh& mesh) {
    const std::vector<Facet> facets = boundary_facets(mesh);
    std::vector<Extent> extents;
    for (const Facet f : facets) extents.push_back(extent_of(mesh, facet_vertices(mesh, f)));
    const BoxTree tree(extents);
    std::optional<Crossing> found;
    for (std::size_t i = 0; i < facets.size() && !found; ++i) {
        const Triangle s = triangle_of(mesh, facets[i]);
        tree.any(extents[i], [&](std::size_t j) {
            if (j <= i) return false;
            const Triangle t = triangle_of(mesh, facets[j]);
            if (!cross(s, t)) return false;
            found = {facets[i], facets[j], in_one_plane(s, t)};
            return found->covers;  // which tells more: it is looked for among all that cross the facet
        });
    }
    return found;
}

std::optional<Buried> find_buried(const Mesh& mesh) {
    const CellsAtSurfaces at_surfaces(mesh);
    for (const Tet t : mesh.tets.indices())
        if (alive(mesh, t))
            if (const Tet cell = at_surfaces.any_in(mesh.tets[t], t); cell.exists()) return Buried{cell, t};
    for (const Prism& prism : all_prisms(mesh))
        for (const TetCorners& part : parts_of(mesh, prism))
            if (const Tet cell = at_surfaces.any_in(part, Tet{}); cell.exists()) return Buried{cell, prism};
    return std::nullopt;
}

}  // namespace kropla
