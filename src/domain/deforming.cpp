#include "domain/deforming.h"

#include "domain/triangulated_surface.h"
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <utility>

namespace kropla {

std::vector<DeformingSurface> deforming_surfaces(const Domain& domain, const Mesh& mesh) {
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<DeformingSurface> surfaces;
    std::vector<std::size_t> of_region(domain.bodies.size() + 1, none);
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        if (!domain.bodies[body].deformation) continue;
        of_region[body + 1] = surfaces.size();
        surfaces.push_back({body, {}, {}});
    }
    if (surfaces.empty()) return surfaces;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        const std::size_t which = of_region[as_size(mesh.region[t].value)];
        if (which == none) continue;
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = mesh.neighbour[t][as_size(corner)]; n.exists() && mesh.region[n] != mesh.region[t])
                surfaces[which].triangles.push_back(facet_vertices(mesh, {t, corner}));
    }
    for (DeformingSurface& surface : surfaces) {
        for (const auto& triangle : surface.triangles)
            surface.vertices.insert(surface.vertices.end(), triangle.begin(), triangle.end());
        std::ranges::sort(surface.vertices);
        surface.vertices.erase(std::unique(surface.vertices.begin(), surface.vertices.end()), surface.vertices.end());
    }
    return surfaces;
}

Shape shape_of(const DeformingSurface& surface, const Array<Vertex, Vec3>& places) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (Vertex v : surface.vertices) points.push_back(places[v]);
    const auto number = [&](Vertex v) {
        return static_cast<int>(std::ranges::lower_bound(surface.vertices, v) - surface.vertices.begin());
    };
    for (const auto& [a, b, c] : surface.triangles) triangles.push_back({number(a), number(b), number(c)});
    return shape_of_facets(std::move(points), std::move(triangles));
}

Snapshot snapshot(const Domain& domain, double t, std::span<const DeformingSurface> deforming,
                  const Array<Vertex, Vec3>& places) {
    Snapshot at = snapshot(domain, t);
    for (const DeformingSurface& surface : deforming) at.shapes[surface.body] = shape_of(surface, places);
    return at;
}

}  // namespace kropla
