#include "domain/body_surface.h"

#include "domain/body_tree.h"
#include "domain/triangulated_surface.h"
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <utility>

namespace kropla {

std::vector<BodySurface> body_surfaces(const Mesh& mesh, std::span<const std::size_t> bodies) {
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    std::vector<BodySurface> surfaces;
    std::vector<std::size_t> of_region;
    for (std::size_t body : bodies) {
        if (of_region.size() < body + 2) of_region.resize(body + 2, none);
        of_region[body + 1] = surfaces.size();
        surfaces.push_back({body, {}, {}});
    }
    if (surfaces.empty()) return surfaces;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        const std::size_t region = as_size(mesh.region[t].value);
        const std::size_t which = region < of_region.size() ? of_region[region] : none;
        if (which == none) continue;
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = mesh.neighbour[t][as_size(corner)]; n.exists() && mesh.region[n] != mesh.region[t])
                surfaces[which].triangles.push_back(facet_vertices(mesh, {t, corner}));
    }
    for (BodySurface& surface : surfaces) {
        for (const auto& triangle : surface.triangles)
            surface.vertices.insert(surface.vertices.end(), triangle.begin(), triangle.end());
        std::ranges::sort(surface.vertices);
        surface.vertices.erase(std::unique(surface.vertices.begin(), surface.vertices.end()), surface.vertices.end());
    }
    return surfaces;
}

std::vector<BodySurface> deforming_surfaces(const Domain& domain, const Mesh& mesh) {
    std::vector<std::size_t> bodies;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body)
        if (domain.bodies[body].deformation) bodies.push_back(body);
    return body_surfaces(mesh, bodies);
}

Shape shape_of(const BodySurface& surface, const Array<Vertex, Vec3>& places, const Box& box) {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    for (Vertex v : surface.vertices) points.push_back(places[v]);
    const auto number = [&](Vertex v) {
        return static_cast<int>(std::ranges::lower_bound(surface.vertices, v) - surface.vertices.begin());
    };
    for (const auto& [a, b, c] : surface.triangles) triangles.push_back({number(a), number(b), number(c)});
    const Bounds within{box.min, box.max};
    return shape_of_facets(std::move(points), std::move(triangles), &within);
}

Snapshot snapshot(const Domain& domain, double t, std::span<const BodySurface> deforming,
                  const Array<Vertex, Vec3>& places, bool uneven) {
    Snapshot at = snapshot(domain, t);
    for (const BodySurface& surface : deforming) at.shapes[surface.body] = shape_of(surface, places, domain.box);
    if (!deforming.empty()) plant_tree(at);
    at.narrow = uneven || has_narrow_gap(at);
    return at;
}

}  // namespace kropla
