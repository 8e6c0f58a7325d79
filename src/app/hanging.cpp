// Vertices on facets they do not belong to, by a sweep along x: vertices of the boundary sorted by x, each
// facet asks those in its range.

#include "app/hanging.h"

#include "domain/shape.h"

#include <algorithm>
#include <limits>

namespace kropla {
namespace {

template <class Vertices>
Bounds bounds_of(const Mesh& mesh, const Vertices& vertices) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Bounds bounds = {{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Vertex v : vertices)
        for (int axis = 0; axis < 3; ++axis) {
            bounds.min[axis] = std::min(bounds.min[axis], mesh.position[v][axis]);
            bounds.max[axis] = std::max(bounds.max[axis], mesh.position[v][axis]);
        }
    return bounds;
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
    const Bounds box = bounds_of(mesh, living_vertices(mesh));
    std::vector<Facet> facets;
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4 && alive(mesh, t); ++corner) {
            if (mesh.neighbour[t][static_cast<std::size_t>(corner)].exists()) continue;
            const Bounds own = bounds_of(mesh, facet_vertices(mesh, {t, corner}));
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
    std::vector<Vertex> by_x;
    for (const Facet facet : facets)
        for (const Vertex v : facet_vertices(mesh, facet)) by_x.push_back(v);
    const auto x_of = [&](Vertex v) { return mesh.position[v].x; };
    std::ranges::sort(by_x,
                      [&](Vertex a, Vertex b) { return std::pair(x_of(a), a) < std::pair(x_of(b), b); });
    by_x.erase(std::ranges::unique(by_x).begin(), by_x.end());

    constexpr double tolerance = 1e-6;  // [-] of the facet's extent: above the rounding of single precision
    for (const Facet facet : facets) {
        const auto corners = facet_vertices(mesh, facet);
        const Bounds own = bounds_of(mesh, corners);
        const double reach = tolerance * distance(own.min, own.max);
        for (auto v = std::ranges::lower_bound(by_x, own.min.x - reach, {}, x_of);
             v != by_x.end() && x_of(*v) <= own.max.x + reach; ++v)
            if (hangs_on(mesh, *v, corners, reach)) return HangingVertex{*v, facet};
    }
    return {};
}

}  // namespace kropla
