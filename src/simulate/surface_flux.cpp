// The heat that passes the surfaces of bodies, as the equations themselves have it: of a vertex on a surface
// the row of the system is the sum of what cells within the body and cells around it add; neither part is
// zero by itself, and what the outer one lacks is what came through the surface. It converges twice as fast
// as gradients of the temperature beside the surface do, and no heat is lost between the two sides.
//   [Gresho, Lee, Sani, Leone, Stein 1987] The consistent Galerkin FEM for computing derived boundary
//     quantities in thermal and/or fluids problems. Int. J. Numer. Methods Fluids 7.
//   [Carey, Chow, Seager 1985] Approximate boundary-flux calculations. CMAME 50.
#include "simulate/surface_flux.h"

#include <algorithm>

namespace kropla {
namespace {

/// The surface of a body: its vertices in order, and the integral over it of each one's shape function.
struct BodySurface {
    std::vector<Vertex> vertices;
    Array<Vertex, double> area;  // [m^2] zero off the surface
};

BodySurface surface_of(const Mesh& mesh, Region body) {
    BodySurface surface{{}, Array<Vertex, double>(mesh.position.size(), 0.0)};
    for (const auto& facet : region_surface(mesh, body).interface) {
        const Vec3 a = mesh.position[facet[1]] - mesh.position[facet[0]],
                   b = mesh.position[facet[2]] - mesh.position[facet[0]];
        for (Vertex v : facet) {
            if (surface.area[v] == 0) surface.vertices.push_back(v);
            surface.area[v] += norm(cross(a, b)) / 6;
        }
    }
    std::ranges::sort(surface.vertices);
    return surface;
}

/// What the cells around a body gain at each vertex of its surface and did not get from other vertices [J].
Array<Vertex, double> gained_around(const HeatStep& step, const Cells& cells, Region body,
                                    const BodySurface& surface, const Array<Vertex, double>& after) {
    Array<Vertex, double> sum(after.size(), 0.0);
    const auto at_surface = [&](Vertex v) { return surface.area[v] > 0; };
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(step.current, cell);
        if (cell_region(step.current, cell) == body || std::ranges::none_of(vertices, at_surface)) return;
        const auto by_cell = gained(cell_system(step, cell), at_corners(after, vertices));
        for (std::size_t i = 0; i < vertices.size(); ++i) sum[vertices[i]] += by_cell[i];
    });
    return sum;
}

SurfaceFlux surface_flux(const HeatStep& step, const Cells& cells, Region body,
                         const Array<Vertex, double>& after) {
    BodySurface surface = surface_of(step.current, body);
    const auto around = gained_around(step, cells, body, surface, after);
    SurfaceFlux flux{.body = body, .total = 0, .vertices = {}, .density = {}};
    for (Vertex v : surface.vertices) {
        flux.total += around[v] / step.dt;
        flux.density.push_back(around[v] / (step.dt * surface.area[v]));
    }
    flux.vertices = std::move(surface.vertices);
    return flux;
}

}  // namespace

std::vector<SurfaceFlux> surface_fluxes(const HeatStep& step, const Cells& cells,
                                        const Array<Vertex, double>& after) {
    std::vector<SurfaceFlux> fluxes;
    for (std::size_t r = 1; r < count_regions(step.current); ++r)
        fluxes.push_back(surface_flux(step, cells, Region(r), after));
    return fluxes;
}

}  // namespace kropla
