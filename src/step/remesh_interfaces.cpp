// Interfaces have no target size of their own here: edges are to be as long as those around them.

#include <kropla/step/remesh_interfaces.h>

#include "adapt/adapt_surface.h"
#include "adapt/constants.h"
#include "adapt/surface_star.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/step/improve_mesh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace kropla {
namespace {

constexpr int evenings = 3;  // of the sizes, each over the vertices beside: by three edges

std::vector<Vertex> vertices_of(const Interface& interface) {
    std::vector<Vertex> vertices;
    for (const auto& triangle : interface.triangles) vertices.insert(vertices.end(), triangle.begin(), triangle.end());
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// Are the triangles around the vertex one fan that closes?
bool is_fan(const SurfaceStar& star) {
    if (star.sides.empty()) return false;
    std::size_t seen = 0;
    Vertex at = star.sides.front()[0];
    do {
        const auto next = std::ranges::find(star.sides, at, [](const auto& side) { return side[0]; });
        if (next == star.sides.end()) return false;
        at = (*next)[1];
    } while (++seen < star.sides.size() && at != star.sides.front()[0]);
    return seen == star.sides.size() && at == star.sides.front()[0];
}

bool is_apart(const Mesh& mesh, const Interface& interface) {
    return std::ranges::all_of(vertices_of(interface), [&](Vertex v) {
        const std::vector<Tet> cells = ball(mesh, v);
        const auto is_of_two = [&](Tet t) { return mesh.region[t] == interface.inner || mesh.region[t] == interface.outer; };
        return std::ranges::all_of(cells, is_of_two) && constraint(mesh, v, cells).patches == 0 &&
               is_fan(surface_star(mesh, v, interface.inner));
    });
}

/// The mean length of the edges at each vertex, evened.
Array<Vertex, double> sizes_of(const Mesh& mesh, const Interface& interface) {
    Array<Vertex, double> size(mesh.position.size(), 1);
    const std::vector<Vertex> vertices = vertices_of(interface);
    std::vector<std::vector<Vertex>> rings;
    for (const Vertex v : vertices) {
        const auto& around = rings.emplace_back(ring(surface_star(mesh, v, interface.inner)));
        double sum = 0;
        for (const Vertex w : around) sum += distance(mesh.position[v], mesh.position[w]);
        size[v] = sum / static_cast<double>(around.size());
    }
    for (int i = 0; i < evenings; ++i) {
        const Array<Vertex, double> before = size;
        for (std::size_t k = 0; k < vertices.size(); ++k) {
            double sum = before[vertices[k]];
            for (const Vertex w : rings[k]) sum += before[w];
            size[vertices[k]] = sum / static_cast<double>(rings[k].size() + 1);
        }
    }
    return size;
}

std::vector<Tet> bad_cells(const Mesh& mesh, double good_enough) {
    std::vector<Tet> bad;
    for (const Tet t : all_tets(mesh))
        if (!(aspect_ratio(mesh, t) <= good_enough)) bad.push_back(t);
    return bad;
}

}  // namespace

std::vector<Interface> interfaces(const Mesh& mesh) {
    std::map<std::pair<Region, Region>, Interface> found;
    for (const Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (!n.exists() || !(mesh.region[n] < mesh.region[t])) continue;
            Interface& interface = found[{mesh.region[t], mesh.region[n]}];
            interface.inner = mesh.region[t];
            interface.outer = mesh.region[n];
            interface.triangles.push_back(facet_vertices(mesh, {t, corner}));
        }
    std::vector<Interface> all;
    for (auto& [regions, interface] : found) {
        interface.is_apart = is_apart(mesh, interface);
        all.push_back(std::move(interface));
    }
    return all;
}

Changes remesh_interfaces(Mesh& mesh, std::span<const Interface> interfaces, const AdaptOptions& options) {
    Changes changes;
    for (const Interface& interface : interfaces) {
        auto size = sizes_of(mesh, interface);
        changes += adapt_surface(mesh, {interface.inner}, interface.triangles, size, true, options);
    }
    changes += improve_mesh(mesh, options);
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<Tet> bad = bad_cells(mesh, options.good_enough);
        Changes more;
        for (const Interface& interface : interfaces) more += improve_surface(mesh, {interface.inner}, bad, options);
        if (more.vertices.empty()) break;
        changes += more;
        changes += improve_mesh(mesh, options);
    }
    return changes;
}

TriangleSummary summarise_triangles(const Mesh& mesh, std::span<const Interface> interfaces) {
    TriangleSummary summary;
    for (const Interface& interface : interfaces)
        for (const auto& triangle : interface.triangles)
            for (std::size_t i = 0; i < 3; ++i) {
                const auto corner = [&](std::size_t k) { return mesh.position[triangle[k % 3]]; };
                const Vec3 u = corner(i + 1) - corner(i), v = corner(i + 2) - corner(i);
                const double angle = std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
                summary.least_angle = summary.triangles + i == 0 ? angle : std::min(summary.least_angle, angle);
                summary.greatest_angle = std::max(summary.greatest_angle, angle);
                if (i == 2) ++summary.triangles;
            }
    return summary;
}

}  // namespace kropla
