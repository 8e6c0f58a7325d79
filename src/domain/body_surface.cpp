#include "domain/body_surface.h"

#include "base/for_all.h"
#include "domain/body_tree.h"
#include "domain/triangulated_surface.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <limits>
#include <utility>

namespace kropla {
namespace {

/// The triangles that a layer stands on, counter-clockwise seen from outside the body.
std::vector<std::array<Vertex, 3>> wall_triangles(const PrismLayer& layer) {
    std::vector<std::array<Vertex, 3>> triangles;
    for (const auto& [a, b, c] : layer.triangles) {
        triangles.push_back({column_vertex(layer, a, 0), column_vertex(layer, b, 0), column_vertex(layer, c, 0)});
        if (layer.region == layer.body) std::swap(triangles.back()[1], triangles.back()[2]);
    }
    return triangles;
}

}  // namespace

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
    const auto of = [&](Region region) {
        return as_size(region.value) < of_region.size() ? of_region[as_size(region.value)] : none;
    };
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t) || of(mesh.region[t]) == none) continue;
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = mesh.neighbour[t][as_size(corner)]; n.exists() && mesh.region[n] != mesh.region[t])
                surfaces[of(mesh.region[t])].triangles.push_back(facet_vertices(mesh, {t, corner}));
    }
    for (const PrismLayer& layer : mesh.layers)
        if (of(layer.body) != none && surfaces[of(layer.body)].triangles.empty())
            surfaces[of(layer.body)].triangles = wall_triangles(layer);
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

namespace {

/// Sizes rise by no more than `steepest_growth` from point to point.
void grade(const TriangulatedSurface& surface, std::vector<double>& size) {
    for (bool lower = true; lower;) {
        lower = false;
        for (const auto& triangle : surface.triangles())
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t a = as_size(triangle[i]), b = as_size(triangle[(i + 1) % 3]);
                const double rise = steepest_growth * distance(surface.points()[a], surface.points()[b]);
                for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
                    if (!(size[to] > size[from] + rise)) continue;
                    size[to] = size[from] + rise;
                    lower = true;
                }
            }
    }
}

/// Per point of a surface, the least radius by which it bends there [m].
std::vector<double> radii_of(const TriangulatedSurface& surface) {
    std::vector<double> radii(surface.points().size(), std::numeric_limits<double>::infinity());
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
        const double radius = surface.radius_at(t);
        for (int corner : surface.triangles()[t]) radii[as_size(corner)] = std::min(radii[as_size(corner)], radius);
    }
    return radii;
}

/// Sizes on the surface of a body, of at most `most` [m], that fall in its necks and notches down to `least`, less where it is
/// flat, as a film or a plate (ThinPlaces); none where there is none.
LocalSize size_in_necks(const Shape& shape, double least, double most) {
    const TriangulatedSurface& surface = *shape.surface;
    const std::vector<double> radii = radii_of(surface);
    std::vector<double> size(surface.points().size());
    for_all(size.size(), [&](std::size_t i) {
        const Vec3& x = surface.points()[i];
        const double neck = surface.across(x, true, most / neck_share), notch = surface.across(x, false, most / gap_share);
        const double asked = std::min(std::clamp(radii[i], neck_share * neck, gap_share * neck), gap_share * notch);
        size[i] = std::clamp(asked, least, most);
    });
    if (std::ranges::all_of(size, [&](double s) { return s == most; })) return {};
    grade(surface, size);
    return [shape, size = std::move(size)](const Vec3& x) {
        const auto& tree = shape.surface->tree();
        const auto& triangle = tree.triangles()[tree.nearest(rotated_back(shape.orientation, x - shape.centre)).triangle];
        double smallest = size[as_size(triangle[0])];
        for (int corner : triangle) smallest = std::min(smallest, size[as_size(corner)]);
        return smallest;
    };
}

}  // namespace

Snapshot snapshot(const Domain& domain, double t, std::span<const BodySurface> deforming,
                  const Array<Vertex, Vec3>& places, bool uneven) {
    Snapshot at = without_tree(domain, t);
    for (std::size_t body = 0; body < at.shapes.size(); ++body)
        if (!domain.bodies[body].deformation) see_thin_places(at, body);
    for (const BodySurface& surface : deforming) {
        Shape& shape = at.shapes[surface.body];
        shape = shape_of(surface, places, domain.box);
        const double most = surface_size(at, surface.body), least = std::min(least_size(at.size), most);
        if (at.layers[surface.body]) continue;  // its triangles stay
        if (LocalSize in_necks = size_in_necks(shape, least, most)) {
            make_finer(at.local_sizes[surface.body], std::move(in_necks));
            at.local_slope = steepest_growth;
        }
    }
    plant_tree(at);
    at.narrow = uneven || has_narrow_gap(at);
    return at;
}

}  // namespace kropla
