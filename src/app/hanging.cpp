// Vertices on facets they do not belong to: each facet asks the vertices of the boundary that are near it.

#include "app/hanging.h"

#include "mesh/box_tree.h"

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

double distance_to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
    const Vec3 along = b - a;
    const double s = std::clamp(dot(x - a, along) / squared_norm(along), 0.0, 1.0);
    return distance(x, a + s * along);
}

double distance_to_triangle(const Vec3& x, const std::array<Vec3, 3>& p) {
    const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
    bool above = true;  // the foot of the perpendicular is inside
    double to_edges = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3& a = p[i];
        const Vec3& b = p[(i + 1) % 3];
        above = above && determinant(normal, b - a, x - a) >= 0;
        to_edges = std::min(to_edges, distance_to_segment(x, a, b));
    }
    return above ? std::min(to_edges, std::abs(dot(normalised(normal), x - p[0]))) : to_edges;
}

bool hangs_on(const Mesh& mesh, Vertex v, const std::array<Vertex, 3>& corners, double reach) {
    if (std::ranges::find(corners, v) != corners.end()) return false;
    const std::array<Vec3, 3> places = {mesh.position[corners[0]], mesh.position[corners[1]],
                                        mesh.position[corners[2]]};
    return distance_to_triangle(mesh.position[v], places) <= reach;
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
