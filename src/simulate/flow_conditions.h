#pragma once

#include "simulate/cells.h"
#include "simulate/flow_cell.h"
#include "simulate/pattern.h"
#include "simulate/tension.h"
#include <kropla/simulate/flow.h>

#include <array>
#include <vector>

namespace kropla {

/// A solid body's surface, normals into the body.
struct SolidSurface {
    Region body;
    Vec3 centre;  // at the step's end [m]
    std::vector<std::array<Vertex, 3>> facets;
    std::vector<Vertex> vertices;  // ascending
};

/// Where the flow ends.
struct FlowBoundary {
    std::array<std::vector<std::array<Vertex, 3>>, 6> faces;  // normals out of the box
    std::vector<SolidSurface> solids;
    std::vector<LiquidSurface> liquids;       // of regions 1, 2, ... that flow, where they meet another that does
    std::vector<std::array<Vertex, 3>> fixed_walls;  // that are no faces of the box: no slip
};

/// What is given in a step. The same on all ranks.
struct FlowConditions {
    Array<Vertex, std::array<bool, 3>> fixed;  // which directions of the velocity
    Array<Vertex, Vec3> end, rate;             // [m/s] of them at the step's end, [m/s^2] there
    std::array<bool, 6> open = {};
    std::vector<char> closed;                  // per piece of the pattern: nowhere open, the pressure's mean is of no matter
};

/// Cells of liquids and gases.
[[nodiscard]] Cells flow_cells(const Mesh& mesh, const FlowOptions& options);

/// `t` is the time of the step's end. Throws CaseError if a tension needs a temperature, or is not positive.
[[nodiscard]] FlowBoundary flow_boundary(const Mesh& mesh, const FlowOptions& options, double t,
                                         const Array<Vertex, double>& temperature);

/// Of the step from t to t + dt that starts from `velocity`. Throws CaseError if a quantity is not finite or
/// what flows into a piece of the pattern has no way out of it.
[[nodiscard]] FlowConditions flow_conditions(const Mesh& before, const Mesh& current, const FlowOptions& options,
                                             const Pattern& pattern, const FlowBoundary& boundary,
                                             const Array<Vertex, Vec3>& velocity, double t, double dt);

/// The pressure given at open faces, at vertices that stand there at time t; where it is zero everywhere, maybe nothing.
/// Throws CaseError if it is not finite.
[[nodiscard]] std::array<Array<Vertex, double>, 6> open_pressures(const Array<Vertex, Vec3>& position,
                                                                  const FlowOptions& options,
                                                                  const FlowBoundary& boundary, double t);

/// Calls `visit(vertex, flux)` for the corners of facets, with the integral of phi_i u.n [m^3/s].
template <class Visit>
void for_each_flux(const std::vector<std::array<Vertex, 3>>& facets, const Array<Vertex, Vec3>& position,
                   const Array<Vertex, Vec3>& velocity, const Visit& visit) {
    for (const auto& facet : facets) {
        const auto& [a, b, c] = facet;
        const Vec3 area = 0.5 * cross(position[b] - position[a], position[c] - position[a]);
        const Vec3 sum = velocity[a] + velocity[b] + velocity[c];
        for (Vertex v : facet) visit(v, dot(area, velocity[v] + sum) / 12);
    }
}

/// [m^3/s] through facets, along their normals.
[[nodiscard]] double flux_through(const std::vector<std::array<Vertex, 3>>& facets,
                                  const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& velocity);

/// What the cells are filled with. Throws CaseError if a force is not finite, or a property needs a
/// temperature.
[[nodiscard]] Array<Region, FlowMaterial> flow_materials(const Mesh& mesh, const FlowOptions& options,
                                                         const Array<Vertex, double>& temperature);
/// Sets the forces of time t, at vertices that stand there.
void set_forces(const Mesh& mesh, const Array<Vertex, Vec3>& position, const FlowOptions& options, double t,
                Array<Region, FlowMaterial>& material);

}  // namespace kropla
