// One step of the heat equation: assembly and solution of the system derived in heat.h.
//   [Donea, Huerta 2003] Finite element methods for flow problems: the conservative ALE form.
//   [Brooks, Hughes 1982] Streamline upwind/Petrov-Galerkin formulations. CMAME 32: SUPG.
//   [Shakib, Hughes, Johan 1991] A new finite element formulation for computational fluid dynamics: X. CMAME
//     89: tau, here with the tet's length along the flow of [Tezduyar, Park 1986] CMAME 59.
#include "simulate/heat.h"

#include "base/error.h"
#include "mesh/cells.h"
#include "mesh/topology.h"
#include "simulate/carried.h"
#include "simulate/elements.h"
#include "simulate/flow_potential.h"
#include "simulate/linear_system.h"

#include <cmath>
#include <sstream>
#include <string>

namespace kropla {
namespace {

/// All that a tet needs to know of the step.
struct StepData {
    const Mesh& before;
    const Mesh& current;
    const HeatOptions& options;
    const Array<Vertex, double>& old_temperature;
    const Array<Tet, Vec3>& flow;               // of material at rest, per tet [m/s]
    std::vector<Array<Vertex, Vec3>> carried;   // per region: empty, or of a body, see start_of [m]
    std::vector<Array<Vertex, double>> source;  // per region: empty, or at its vertices [W/m^3]
    double dt;                                  // [s]
};

/// What a tet adds to the rows of its corners.
struct TetSystem {
    std::array<std::array<double, 4>, 4> matrix = {};  // [J/K]
    std::array<double, 4> right = {};                  // [J]
};

double evaluate(const Quantity& quantity, const Vec3& x, double t, const char* what) {
    const double value = quantity(x, t);
    if (std::isfinite(value)) return value;
    std::ostringstream message;
    message << "heat." << what << " is " << value << " at (" << x.x << ", " << x.y << ", " << x.z
            << "), t = " << t;
    throw CaseError(message.str());
}

const HeatRegion& region_of(const StepData& step, Tet t) {
    return step.options.regions[static_cast<std::size_t>(step.current.region[t].value)];
}

std::array<double, 4> at_corners(const Array<Vertex, double>& values, const std::array<Vertex, 4>& v) {
    if (values.empty()) return {};
    return {values[v[0]], values[v[1]], values[v[2]], values[v[3]]};
}

double sum(const std::array<double, 4>& a) {
    return a[0] + a[1] + a[2] + a[3];
}

/// The intrinsic time [s] of SUPG, for the speed |v| and its components v.grad phi_i, diffusivity [m^2/s] and
/// step.
double intrinsic_time(double speed, double sum_of_components, double diffusivity, double dt) {
    if (!(sum_of_components > 0)) return 0;
    const double length = 2 * speed / sum_of_components;
    const double transient = 2 / dt, convective = 2 * speed / length;
    const double diffusive = 12 * diffusivity / (length * length);
    return 1 / std::sqrt(transient * transient + convective * convective + diffusive * diffusive);
}

/// Mass, conduction and source: the terms that do not know of motion but for the volume's change. In the
/// matrix the consistent mass and L add up to the lumped one; on the old temperature they act with the old
/// and the new volume.
TetSystem conduction(const StepData& step, Tet t, const LinearTet& tet, const std::array<double, 4>& source) {
    const HeatMaterial& m = region_of(step, t).material;
    const double capacity = m.density * m.specific_heat;
    const double old_volume = linear_tet(corners(step.before, t)).volume;
    const auto old = at_corners(step.old_temperature, step.current.tets[t]);
    TetSystem system;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            system.matrix[i][j] = step.dt * m.conductivity / tet.volume *
                                  dot(tet.volume_gradient[i], tet.volume_gradient[j]);
        }
        system.matrix[i][i] += capacity * tet.volume / 4;
        const double kept = old_volume * (old[i] + sum(old)) + tet.volume * (4 * old[i] - sum(old));
        system.right[i] = capacity * kept / 20 + step.dt * tet.volume * source[i] / 4;
    }
    return system;
}

/// SUPG, for the velocity `v` [m/s] of the material relative to the mesh.
void add_upwinding(const StepData& step, Tet t, const LinearTet& tet, const Vec3& v,
                   const std::array<double, 4>& source, TetSystem& system) {
    const HeatMaterial& m = region_of(step, t).material;
    const double capacity = m.density * m.specific_heat;
    std::array<double, 4> along;  // V v.grad phi_i [m^3/s]
    double sum_along = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        along[i] = dot(v, tet.volume_gradient[i]);
        sum_along += std::abs(along[i]) / tet.volume;
    }
    const double tau = intrinsic_time(norm(v), sum_along, m.conductivity / capacity, step.dt);
    const double known =
        capacity * sum(at_corners(step.old_temperature, step.current.tets[t])) + step.dt * sum(source);
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            system.matrix[i][j] += tau * capacity * along[i] * (0.25 + step.dt * along[j] / tet.volume);
        }
        system.right[i] += tau * along[i] * known / 4;
    }
}

/// Where the corners of the tet came from, for one who goes with its body as a whole, if it is of a body.
Corners start_of(const StepData& step, Tet t) {
    const auto& carried = step.carried[static_cast<std::size_t>(step.current.region[t].value)];
    if (carried.empty()) return corners(step.before, t);
    const auto& v = step.current.tets[t];
    return {carried[v[0]], carried[v[1]], carried[v[2]], carried[v[3]]};
}

/// What the material and the mesh carry past each other: - dt C, and its upwinding.
void add_convection(const StepData& step, Tet t, const LinearTet& tet, const std::array<double, 4>& source,
                    TetSystem& system) {
    const HeatMaterial& m = region_of(step, t).material;
    const Corners x0 = start_of(step, t), x1 = corners(step.current, t);
    std::array<Vec3, 4> moved;  // dt w
    Vec3 moved_sum;
    for (std::size_t i = 0; i < 4; ++i) moved_sum += moved[i] = x1[i] - x0[i];
    const Vec3 flow = step.flow[t];
    if (x0 == x1 && flow == Vec3{}) return;
    const auto mean_gradient = mean_volume_gradient(x0, x1);
    for (std::size_t i = 0; i < 4; ++i) {
        const double by_flow = step.dt * dot(flow, tet.volume_gradient[i]) / 4;
        for (std::size_t j = 0; j < 4; ++j) {
            const double by_mesh = dot(moved[j] + moved_sum, mean_gradient[i]) / 20;
            const double by_lumping = dot(4.0 * moved[i] - moved_sum, tet.volume_gradient[j]) / 20;
            system.matrix[i][j] -= m.density * m.specific_heat * (by_flow - by_mesh + by_lumping);
        }
    }
    add_upwinding(step, t, tet, flow - moved_sum / (4 * step.dt), source, system);
}

TetSystem tet_system(const StepData& step, Tet t) {
    const auto region = static_cast<std::size_t>(step.current.region[t].value);
    const auto source = at_corners(step.source[region], step.current.tets[t]);
    const LinearTet tet = linear_tet(corners(step.current, t));
    TetSystem system = conduction(step, t, tet, source);
    add_convection(step, t, tet, source, system);
    return system;
}

/// The sources of each region at the vertices of `cells`.
std::vector<Array<Vertex, double>> evaluate_sources(const Mesh& mesh, const std::vector<Tet>& cells,
                                                    const HeatOptions& options, double t) {
    const double unknown = std::nan("");
    std::vector<Array<Vertex, double>> source(options.regions.size());
    for (std::size_t r = 0; r < source.size(); ++r) {
        if (options.regions[r].source) source[r] = Array<Vertex, double>(mesh.position.size(), unknown);
    }
    for (Tet cell : cells) {
        const auto r = static_cast<std::size_t>(mesh.region[cell].value);
        if (source[r].empty()) continue;
        for (Vertex v : mesh.tets[cell]) {
            if (!std::isnan(source[r][v])) continue;
            source[r][v] = evaluate(options.regions[r].source, mesh.position[v], t, "source");
        }
    }
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
    for_each_facet(mesh, all_tets(mesh), options, HeatFace::Kind::value, note);
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
LinearSystem heat_system(const StepData& step, const std::vector<Tet>& cells, const Numbering& numbering,
                         int rank, double end) {
    const std::vector<Tet> mine = cells_of_rank(step.current, cells, numbering, rank);
    LinearSystem system = empty_system(step.current, mine, numbering, rank);
    for (Tet t : mine) {
        const TetSystem part = tet_system(step, t);
        for (std::size_t i = 0; i < 4; ++i) {
            const int row = numbering.row[step.current.tets[t][i]];
            add_to_right(system, row, part.right[i]);
            for (std::size_t j = 0; j < 4; ++j) {
                add_to(system, row, numbering.row[step.current.tets[t][j]], part.matrix[i][j]);
            }
        }
    }
    const auto flux = [&](Tet t, std::size_t corner, std::size_t face) {
        add_flux(step.current, t, corner, step.options.faces[face].quantity, end, step.dt, numbering, system);
    };
    for_each_facet(step.current, cells, step.options, HeatFace::Kind::flux, flux);
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

std::vector<Array<Vertex, Vec3>> carry_bodies(const Mesh& before, const Mesh& current,
                                              const HeatOptions& options) {
    std::vector<Array<Vertex, Vec3>> carried(options.regions.size());
    for (Region body : regions_that(Carried::with_mesh, options)) {
        carried[static_cast<std::size_t>(body.value)] = carried_along(before, current, body);
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
    const std::vector<Tet> cells = all_tets(current);
    const Numbering numbering = number_vertices(current, cells, ranks.count);
    const StepData step{.before = before,
                        .current = current,
                        .options = options,
                        .old_temperature = temperature.values,
                        .flow = flow.velocity,
                        .carried = carry_bodies(before, current, options),
                        .source = evaluate_sources(current, cells, options, t + dt),
                        .dt = dt};
    const LinearSystem system = heat_system(step, cells, numbering, ranks.rank, t + dt);
    const SolverChoice choice{.name = "heat", .method = "gmres", .preconditioner = "bjacobi"};
    const Solution solution = solve(ranks, system, choice);
    for (std::size_t r = 0; r < numbering.vertex.size(); ++r) {
        temperature.values[numbering.vertex[r]] = solution.value[r];
    }
    return {solution.iterations, solution.residual, flow.iterations};
}

}  // namespace kropla
