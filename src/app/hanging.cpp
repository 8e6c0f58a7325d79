// Vertices on facets they do not belong to: each facet asks the vertices of the boundary that are near it.

#include "app/hanging.h"

#include "mesh/box_tree.h"
#include "mesh/triangle.h"

#include <algorithm>
#include <limits>
#include <span>

namespace kropla {
namespace {

Extent extent_of(const Mesh& mesh, std::span<const Vertex> vertices) {
    Extent extent;
    for (const Vertex v : vertices) extent.take_in(mesh.position[v]);
    return extent;
}

std::vector<Vertex> living_vertices(const Mesh& mesh) {
    std::vector<Vertex> vertices;
    for (const Vertex v : mesh.position.indices())
        if (alive(mesh, v)) vertices.push_back(v);
    return vertices;
}

/// The facets without a neighbour, except those in a face of the bounding box: beyond those is nothing to
/// meet.
std::vector<Facet> inner_boundary(const Mesh& mesh) {
    const Extent box = extent_of(mesh, living_vertices(mesh));
    std::vector<Facet> facets;
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4 && alive(mesh, t); ++corner) {
            if (mesh.neighbour[t][static_cast<std::size_t>(corner)].exists()) continue;
            const Extent own = extent_of(mesh, facet_vertices(mesh, {t, corner}));
            bool in_face = false;
            for (int axis = 0; axis < 3; ++axis)
                in_face = in_face || own.max[axis] == box.min[axis] || own.min[axis] == box.max[axis];
            if (!in_face) facets.push_back({t, corner});
        }
    return facets;
}

bool hangs_on(const Mesh& mesh, Vertex v, const std::array<Vertex, 3>& corners, double reach) {
    if (std::ranges::find(corners, v) != corners.end()) return false;
    const Corners places = {mesh.position[corners[0]], mesh.position[corners[1]], mesh.position[corners[2]]};
    const Vec3& x = mesh.position[v];
    return distance(closest_on_triangle(places, x).point, x) <= reach;
}

}  // namespace

std::optional<HangingVertex> hanging_vertex(const Mesh& mesh) {
    const std::vector<Facet> facets = inner_boundary(mesh);
    std::vector<Vertex> vertices;
    for (const Facet facet : facets)
        for (const Vertex v : facet_vertices(mesh, facet)) vertices.push_back(v);
    std::ranges::sort(vertices);
    vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
    std::vector<Extent> points;
    for (const Vertex v : vertices) points.push_back({mesh.position[v], mesh.position[v]});
    const BoxTree tree(std::move(points));

    constexpr double tolerance = 1e-6;  // [-] of the facet's extent: above the rounding of single precision
    std::optional<HangingVertex> found;
    for (const Facet facet : facets) {
        const auto corners = facet_vertices(mesh, facet);
        Extent near = extent_of(mesh, corners);
        const double reach = tolerance * distance(near.min, near.max);
        near.min -= {reach, reach, reach};
        near.max += {reach, reach, reach};
        tree.any(near, [&](std::size_t i) {
            if (!hangs_on(mesh, vertices[i], corners, reach)) return false;
            found = {vertices[i], facet};
            return true;
        });
        if (found) break;
    }
    return found;
}

}  // namespace kropla
