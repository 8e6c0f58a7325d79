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
        for (Vertex v : facet) {
            if (surface.area[v] == 0) surface.vertices.push_back(v);
            surface.area[v] += norm(area_vector(mesh, facet)) / 3;
        }
    }
    std::ranges::sort(surface.vertices);
    return surface;
}

SurfaceFlux surface_flux(const Ranks& ranks, const Mesh& mesh, const Assembled& step, Region body, double dt) {
    BodySurface surface = surface_of(mesh, body);
    Array<Vertex, char> of_body(mesh.position.size(), 0);
    for_each_cell(living_cells(mesh, body), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) of_body[v] = 1;
    });
    std::vector<double> gained(surface.vertices.size(), 0.0);  // around the body, at each vertex [J]
    for (std::size_t k = 0; k < gained.size(); ++k) {
        const int row = step.pattern.numbering.row[surface.vertices[k]] - step.pattern.rows.first_row;
        if (row < 0 || static_cast<std::size_t>(row) >= step.pattern.rows.count()) continue;
        gained[k] = gained_at(step, mesh, static_cast<std::size_t>(row),
                              [&](const auto& cell) { return cell_region(mesh, cell) != body; },
                              [&](Vertex other) { return of_body[other] == 0; });
    }
    MPI_Allreduce(MPI_IN_PLACE, gained.data(), static_cast<int>(gained.size()), MPI_DOUBLE, MPI_SUM, ranks.communicator);
    SurfaceFlux flux{.body = body, .total = 0, .vertices = {}, .density = {}};
    for (std::size_t k = 0; k < gained.size(); ++k) {
        flux.total += gained[k] / dt;
        flux.density.push_back(gained[k] / (dt * surface.area[surface.vertices[k]]));
    }
    flux.vertices = std::move(surface.vertices);
    return flux;
}

}  // namespace

std::vector<SurfaceFlux> surface_fluxes(const Ranks& ranks, const Mesh& mesh, const Assembled& step, double dt) {
    std::vector<SurfaceFlux> fluxes;
    for (std::size_t r = 1; r < count_regions(mesh); ++r)
        fluxes.push_back(surface_flux(ranks, mesh, step, Region(r), dt));
    return fluxes;
}

}  // namespace kropla
