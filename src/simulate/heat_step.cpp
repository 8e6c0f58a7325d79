// One step of the heat equation: assembly and solution of the system derived in heat.h, from what the cells
// add to it (heat_cell.h), the fluxes and the values at the boundary.

#include "base/error.h"
#include "mesh/cells.h"
#include "simulate/carried.h"
#include "simulate/flow_potential.h"
#include "simulate/heat_cell.h"
#include "simulate/linear_system.h"
#include "simulate/surface_flux.h"

#include <cmath>
#include <sstream>
#include <string>
#include <utility>

namespace kropla {
namespace {

double evaluate(const Quantity& quantity, const Vec3& x, double t, const char* what) {
    const double value = quantity(x, t);
    if (std::isfinite(value)) return value;
    std::ostringstream message;
    message << "heat." << what << " is " << value << " at (" << x.x << ", " << x.y << ", " << x.z
            << "), t = " << t;
    throw CaseError(message.str());
}

const Quantity& source_of(const HeatOptions& options, Region region) {
    return options.regions[static_cast<std::size_t>(region.value)].source;
}

/// The sources of each region at the vertices of `cells`.
Array<Region, Array<Vertex, double>> evaluate_sources(const Mesh& mesh, const Cells& cells,
                                                      const HeatOptions& options, double t) {
    const double unknown = std::nan("");
    Array<Region, Array<Vertex, double>> source(options.regions.size());
    for (Region r : source.indices()) {
        if (source_of(options, r)) source[r] = Array<Vertex, double>(mesh.position.size(), unknown);
    }
    for_each_cell(cells, [&](const auto& cell) {
        const Region r = cell_region(mesh, cell);
        if (source[r].empty()) return;
        for (Vertex v : cell_vertices(mesh, cell)) {
            if (!std::isnan(source[r][v])) continue;
            source[r][v] = evaluate(source_of(options, r), mesh.position[v], t, "source");
        }
    });
    return source;
}

void add_flux(const Mesh& mesh, Tet t, std::size_t corner, const Quantity& flux, double time, double dt,
              const Numbering& numbering, LinearSystem& system) {
    const double area = 3 * norm(linear_tet(corners(mesh, t)).volume_gradient[corner]);
    for (int k : tet_facets[corner]) {
        const Vertex v = mesh.tets[t][static_cast<std::size_t>(k)];
        const double share = dt * area / 3 * evaluate(flux, mesh.position[v], time, "flux");
        add_to_right(system, numbering.row[v], share);
    }
}

/// Calls `visit(tet, corner, face)` for the facets on faces of the given kind.
template <class Visit>
void for_each_facet(const Mesh& mesh, const std::vector<Tet>& cells, const HeatOptions& options,
                    HeatFace::Kind kind, const Visit& visit) {
    for (Tet t : cells) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Patch patch = mesh.patch[t][corner];
            if (!patch.exists() || mesh.neighbour[t][corner].exists()) continue;
            const auto face = static_cast<std::size_t>(patch.value);
            if (face < options.faces.size() && options.faces[face].kind == kind) visit(t, corner, face);
        }
    }
}

/// The face whose value holds at each vertex: the first if there are several, -1 if there is none.
Array<Vertex, int> faces_with_values(const Mesh& mesh, const HeatOptions& options) {
    Array<Vertex, int> face_at(mesh.position.size(), -1);
    const auto note = [&](Tet t, std::size_t corner, std::size_t face) {
        for (int k : tet_facets[corner]) {
            int& at = face_at[mesh.tets[t][static_cast<std::size_t>(k)]];
            if (at < 0 || static_cast<int>(face) < at) at = static_cast<int>(face);
        }
    };
    for_each_facet(mesh, living_cells(mesh).tets, options, HeatFace::Kind::value, note);
    return face_at;
}

void fix_values(const Mesh& mesh, const HeatOptions& options, double time, const Numbering& numbering,
                LinearSystem& system) {
    const Array<Vertex, int> face_at = faces_with_values(mesh, options);
    for (std::size_t r = 0; r < numbering.vertex.size(); ++r) {
        const Vertex v = numbering.vertex[r];
        if (face_at[v] < 0) continue;
        const Quantity& quantity = options.faces[static_cast<std::size_t>(face_at[v])].quantity;
        fix_unknown(system, static_cast<int>(r), evaluate(quantity, mesh.position[v], time, "value"));
    }
}

/// Quantities are evaluated everywhere, not on the rank's cells alone: if one is not finite, all ranks throw.
LinearSystem heat_system(const HeatStep& step, const Cells& cells, const Numbering& numbering, int rank,
                         double end) {
    const Cells mine = cells_of_rank(step.current, cells, numbering, rank);
    LinearSystem system = empty_system(step.current, mine, numbering, rank);
    for_each_cell(mine, [&](const auto& cell) {
        const auto part = cell_system(step, cell);
        const auto vertices = cell_vertices(step.current, cell);
        add_to(system, numbering, vertices, part.matrix);
        for (std::size_t i = 0; i < vertices.size(); ++i)
            add_to_right(system, numbering.row[vertices[i]], part.right[i]);
    });
    const auto flux = [&](Tet t, std::size_t corner, std::size_t face) {
        add_flux(step.current, t, corner, step.options.faces[face].quantity, end, step.dt, numbering, system);
    };
    for_each_facet(step.current, cells.tets, step.options, HeatFace::Kind::flux, flux);
    for (std::size_t r = 0; r < system.guess.size(); ++r) {
        const auto row = static_cast<std::size_t>(system.first_row) + r;
        system.guess[r] = step.old_temperature[numbering.vertex[row]];
    }
    fix_values(step.current, step.options, end, numbering, system);
    return system;
}

std::vector<Region> regions_that(Carried move, const HeatOptions& options) {
    std::vector<Region> regions;
    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        if (options.regions[r].carried == move) regions.push_back(Region(r));
    }
    return regions;
}

Array<Region, Array<Vertex, Vec3>> carry_bodies(const Mesh& before, const Mesh& current,
                                                const HeatOptions& options) {
    Array<Region, Array<Vertex, Vec3>> carried(options.regions.size());
    for (Region body : regions_that(Carried::with_mesh, options)) {
        carried[body] = carried_along(before, current, body);
    }
    return carried;
}

}  // namespace

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt) {
    check_heat(options, current);
    if (!(dt > 0)) throw CaseError("heat: the step must be positive, got " + std::to_string(dt) + " s");
    const DisplacedFlow flow =
        solve_displaced_flow(ranks, before, current, regions_that(Carried::at_rest, options), dt);
    const Cells cells = living_cells(current);
    const Numbering numbering = number_vertices(current, cells, ranks.count);
    const HeatStep step{.before = before,
                        .current = current,
                        .options = options,
                        .old_temperature = temperature.values,
                        .potential = flow.potential,
                        .carried = carry_bodies(before, current, options),
                        .source = evaluate_sources(current, cells, options, t + dt),
                        .dt = dt};
    const LinearSystem system = heat_system(step, cells, numbering, ranks.rank, t + dt);
    const SolverChoice choice{.name = "heat", .method = "gmres", .preconditioner = "bjacobi"};
    const Solution solution = solve(ranks, system, choice);
    Array<Vertex, double> after = temperature.values;
    for (std::size_t r = 0; r < numbering.vertex.size(); ++r) {
        after[numbering.vertex[r]] = solution.value[r];
    }
    HeatReport report{solution.iterations, solution.residual, flow.iterations,
                      surface_fluxes(step, cells, after)};
    temperature.values = std::move(after);
    return report;
}

}  // namespace kropla
