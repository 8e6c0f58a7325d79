// One step of the heat equation: assembly and solution of the system derived in heat.h, from what the cells
// add to it (heat_cell.h), the fluxes and the values at the boundary.

#include <kropla/base/error.h>
#include <kropla/mesh/cells.h>
#include "simulate/carried.h"
#include "simulate/flow_potential.h"
#include "simulate/heat_cell.h"
#include "simulate/solver.h"
#include "simulate/step_mean.h"
#include "simulate/stop.h"
#include "simulate/surface_flux.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace kropla {
namespace {

/// What sources and fluxes act over.
struct StepInTime {
    const Mesh& before;
    const Mesh& current;
    double begin, dt;  // [s]
    const Watch* watch;
};

const Quantity& source_of(const HeatOptions& options, Region region) {
    return options.regions[static_cast<std::size_t>(region.value)].source;
}

/// Each vertex of the cells once, in order.
std::vector<Vertex> vertices_of(const Mesh& mesh, const Cells& cells) {
    std::vector<Vertex> vertices;
    Array<Vertex, char> seen(mesh.position.size(), 0);
    for_each_cell(cells, [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell))
            if (!std::exchange(seen[v], 1)) vertices.push_back(v);
    });
    return vertices;
}

/// The means over the step of a quantity at these vertices; elsewhere zero.
Array<Vertex, double> means_at(const StepInTime& step, const Quantity& quantity,
                               const std::vector<Vertex>& vertices, const std::string& key) {
    std::vector<Way> ways;
    for (Vertex v : vertices) ways.push_back({step.before.position[v], step.current.position[v]});
    const std::vector<double> means = step_means(quantity, ways, step.begin, step.dt, key, step.watch);
    Array<Vertex, double> at(step.current.position.size(), 0.0);
    for (std::size_t k = 0; k < vertices.size(); ++k) at[vertices[k]] = means[k];
    return at;
}

/// The sources of each region, at its vertices.
Array<Region, Array<Vertex, double>> mean_sources(const StepInTime& step, const HeatOptions& options) {
    Array<Region, Array<Vertex, double>> source(options.regions.size());
    for (Region r : source.indices()) {
        if (!source_of(options, r)) continue;
        source[r] = means_at(step, source_of(options, r),
                             vertices_of(step.current, living_cells(step.current, r)),
                             region_key(options, static_cast<std::size_t>(r.value)) + ".source");
    }
    return source;
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

/// The fluxes through faces, at their vertices.
std::array<Array<Vertex, double>, 6> mean_fluxes(const StepInTime& step, const std::vector<Tet>& cells,
                                                 const HeatOptions& options) {
    std::array<std::vector<Vertex>, 6> vertices;
    for_each_facet(step.current, cells, options, HeatFace::Kind::flux,
                   [&](Tet t, std::size_t corner, std::size_t face) {
                       for (int k : tet_facets[corner])
                           vertices[face].push_back(step.current.tets[t][static_cast<std::size_t>(k)]);
                   });
    std::array<Array<Vertex, double>, 6> flux;
    for (std::size_t face = 0; face < flux.size(); ++face) {
        if (vertices[face].empty()) continue;
        std::ranges::sort(vertices[face]);
        const auto repeated = std::ranges::unique(vertices[face]);
        vertices[face].erase(repeated.begin(), repeated.end());
        flux[face] = means_at(step, options.faces[face].quantity, vertices[face], face_key(face) + ".flux");
    }
    return flux;
}

void add_fluxes(const Mesh& mesh, const std::vector<Tet>& cells, const HeatOptions& options, double dt,
                const std::array<Array<Vertex, double>, 6>& flux, const Numbering& numbering,
                LinearSystem& system) {
    const auto add = [&](Tet t, std::size_t corner, std::size_t face) {
        const double area = 3 * norm(linear_tet(corners(mesh, t)).volume_gradient[corner]);
        for (int k : tet_facets[corner]) {
            const Vertex v = mesh.tets[t][static_cast<std::size_t>(k)];
            add_to_right(system, numbering.row[v], dt * area / 3 * flux[face][v]);
        }
    };
    for_each_facet(mesh, cells, options, HeatFace::Kind::flux, add);
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

struct FixedValue {
    Vertex vertex;
    double value;  // [K]
};

std::vector<FixedValue> fixed_values(const Mesh& mesh, const HeatOptions& options, double time) {
    const Array<Vertex, int> face_at = faces_with_values(mesh, options);
    std::vector<FixedValue> fixed;
    for (Vertex v : face_at.indices()) {
        if (face_at[v] < 0) continue;
        const auto face = static_cast<std::size_t>(face_at[v]);
        fixed.push_back(
            {v, value_at(options.faces[face].quantity, mesh.position[v], time, face_key(face) + ".value")});
    }
    return fixed;
}

/// What acts on a step from outside. Evaluated everywhere, not on the rank's cells alone: if a quantity is not
/// finite, all ranks throw.
struct Boundary {
    std::array<Array<Vertex, double>, 6> flux;  // of each face, its mean over the step [W/m^2], or empty
    std::vector<FixedValue> fixed;              // at the step's end
};

LinearSystem heat_system(const HeatStep& step, const Cells& cells, const Numbering& numbering, const Ranks& ranks,
                         const Boundary& boundary) {
    const Cells mine = cells_of_rank(step.current, cells, numbering, ranks.rank);
    LinearSystem system = empty_system(step.current, mine, numbering, ranks.rank);
    for_each_cell(mine, [&](const auto& cell) {
        heed(ranks.watch);
        const auto part = cell_system(step, cell);
        const auto vertices = cell_vertices(step.current, cell);
        add_to(system, numbering, vertices, part.matrix);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            add_to_right(system, numbering.row[vertices[i]], part.right[i]);
            add_to_row_sum(system, numbering.row[vertices[i]], part.row_sum[i]);
            add_to_held(system, numbering.row[vertices[i]], part.held[i]);
        }
    });
    add_fluxes(step.current, cells.tets, step.options, step.dt, boundary.flux, numbering, system);
    for (std::size_t r = 0; r < system.guess.size(); ++r) {
        const auto row = static_cast<std::size_t>(system.first_row) + r;
        system.guess[r] = step.old_temperature[numbering.vertex[row]];
    }
    for (const FixedValue& fixed : boundary.fixed)
        fix_unknown(system, numbering.row[fixed.vertex], fixed.value);
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

/// The signs with which heat comes from outside.
struct Signs {
    bool cools = false, heats = false;

    void note(const Array<Vertex, double>& values) {
        for (double value : values) {
            cools = cools || value < 0;
            heats = heats || value > 0;
        }
    }
};

HeatExtremes extremes(const HeatStep& step, const std::vector<Vertex>& vertices, const Boundary& boundary,
                      const Array<Vertex, double>& after) {
    const Vertex first = vertices.front();
    const double start = step.old_temperature[first];
    HeatExtremes found{{after[first], step.current.position[first]}, {after[first], step.current.position[first]},
                       start, start};
    const auto widen = [&](double value) {
        found.lower = std::min(found.lower, value);
        found.upper = std::max(found.upper, value);
    };
    for (Vertex v : vertices) {
        widen(step.old_temperature[v]);
        if (after[v] < found.least.value) found.least = {after[v], step.current.position[v]};
        if (after[v] > found.most.value) found.most = {after[v], step.current.position[v]};
    }
    for (const FixedValue& fixed : boundary.fixed) widen(fixed.value);
    Signs signs;
    for (const auto& source : step.source) signs.note(source);
    for (const auto& flux : boundary.flux) signs.note(flux);
    if (signs.cools) found.lower = -INFINITY;
    if (signs.heats) found.upper = INFINITY;
    return found;
}

}  // namespace

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt) {
    check_heat(options, current);
    if (!(dt > 0)) throw CaseError("heat: the step must be positive, got " + std::to_string(dt) + " s");
    const DisplacedFlow flow =
        solve_displaced_flow(ranks, before, current, regions_that(Carried::at_rest, options), dt);
    const Cells cells = living_cells(current);
    const StepInTime in_time{before, current, t, dt, ranks.watch};
    const Boundary boundary{mean_fluxes(in_time, cells.tets, options), fixed_values(current, options, t + dt)};
    const Numbering numbering = number_vertices(current, cells, ranks.count);
    const HeatStep step{.before = before,
                        .current = current,
                        .options = options,
                        .old_temperature = temperature.values,
                        .potential = flow.potential,
                        .carried = carry_bodies(before, current, options),
                        .source = mean_sources(in_time, options),
                        .dt = dt};
    const LinearSystem system = heat_system(step, cells, numbering, ranks, boundary);
    heed(ranks);  // a rank that was stopped in there is met before anything is done together
    const SolverChoice choice{.name = "heat", .preconditioner = preconditioner_for(ranks, system)};
    const Solution solution = solve(ranks, system, choice);
    Array<Vertex, double> after = temperature.values;
    for (std::size_t r = 0; r < numbering.vertex.size(); ++r) {
        after[numbering.vertex[r]] = solution.value[r];
    }
    HeatReport report{solution.iterations, solution.error, flow.iterations,
                      surface_fluxes(step, cells, after), extremes(step, numbering.vertex, boundary, after)};
    temperature.values = std::move(after);
    return report;
}

}  // namespace kropla
