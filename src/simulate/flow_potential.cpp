// The potential flow around moving bodies, by linear elements.
//   [Batchelor 1967] An introduction to fluid dynamics, 2.7 and 6.4: the irrotational flow that a moving
//     boundary sets up has the least kinetic energy of all that satisfy continuity.
#include "simulate/flow_potential.h"

#include "mesh/cells.h"
#include "mesh/topology.h"
#include "simulate/elements.h"
#include "simulate/linear_system.h"

#include <algorithm>
#include <numeric>

namespace kropla {
namespace {

struct Step {
    const Mesh& before;
    const Mesh& current;
    double dt;
};

Vec3 mesh_velocity(const Step& step, Vertex v) {
    return (step.current.position[v] - step.before.position[v]) / step.dt;
}

bool bounds_its_region(const Mesh& mesh, Tet t, std::size_t corner) {
    const Tet other = mesh.neighbour[t][corner];
    return !other.exists() || mesh.region[other] != mesh.region[t];
}

/// Adds what the facet sweeps, shared among its vertices by the integral of phi_i w.n [m^3/s].
void add_swept(const Step& step, Tet t, std::size_t corner, Array<Vertex, double>& swept) {
    std::array<Vertex, 3> v;
    std::array<Vec3, 3> x0, x1, w;
    Vec3 sum;
    for (std::size_t k = 0; k < 3; ++k) {
        v[k] = step.current.tets[t][static_cast<std::size_t>(tet_facets[corner][k])];
        x0[k] = step.before.position[v[k]];
        x1[k] = step.current.position[v[k]];
        sum += w[k] = mesh_velocity(step, v[k]);
    }
    const Vec3 area = mean_area_vector(x0, x1);
    for (std::size_t k = 0; k < 3; ++k) swept[v[k]] += dot(area, w[k] + sum) / 12;
}

Array<Vertex, double> swept_by_boundary(const Step& step, const std::vector<Tet>& cells) {
    Array<Vertex, double> swept(step.current.position.size(), 0.0);
    for (Tet t : cells) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (bounds_its_region(step.current, t, corner)) add_swept(step, t, corner, swept);
        }
    }
    return swept;
}

/// Takes the sum out of `swept`, from each vertex after its share of the volume: else there is no solution.
void balance(const Mesh& mesh, const std::vector<Tet>& cells, Array<Vertex, double>& swept) {
    double total_volume = 0;
    for (Tet t : cells) total_volume += linear_tet(corners(mesh, t)).volume;
    const double rate = std::accumulate(swept.begin(), swept.end(), 0.0) / total_volume;
    for (Tet t : cells) {
        const double volume = linear_tet(corners(mesh, t)).volume;
        for (Vertex v : mesh.tets[t]) swept[v] -= rate * volume / 4;
    }
}

LinearSystem potential_system(const Mesh& mesh, const std::vector<Tet>& cells, const Numbering& numbering,
                              int rank, const Array<Vertex, double>& swept) {
    const std::vector<Tet> mine = cells_of_rank(mesh, cells, numbering, rank);
    LinearSystem system = empty_system(mesh, mine, numbering, rank);
    for (Tet t : mine) {
        const LinearTet tet = linear_tet(corners(mesh, t));
        for (std::size_t i = 0; i < 4; ++i) {
            const int row = numbering.row[mesh.tets[t][i]];
            for (std::size_t j = 0; j < 4; ++j) {
                add_to(system, row, numbering.row[mesh.tets[t][j]],
                       dot(tet.volume_gradient[i], tet.volume_gradient[j]) / tet.volume);
            }
        }
    }
    for (std::size_t r = 0; r < numbering.vertex.size(); ++r) {
        add_to_right(system, static_cast<int>(r), swept[numbering.vertex[r]]);
    }
    return system;
}

void add_gradient(const Mesh& mesh, const std::vector<Tet>& cells, const Numbering& numbering,
                  const std::vector<double>& potential, Array<Tet, Vec3>& velocity) {
    for (Tet t : cells) {
        const LinearTet tet = linear_tet(corners(mesh, t));
        for (std::size_t i = 0; i < 4; ++i) {
            const int row = numbering.row[mesh.tets[t][i]];
            velocity[t] += potential[static_cast<std::size_t>(row)] / tet.volume * tet.volume_gradient[i];
        }
    }
}

}  // namespace

DisplacedFlow solve_displaced_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                                   const std::vector<Region>& resting, double dt) {
    DisplacedFlow flow{Array<Tet, Vec3>(current.tets.size()), 0};
    const Step step{before, current, dt};
    // The residual is gas lost or gained; 1e-14 of what the bodies sweep keeps a constant state to rounding.
    const SolverChoice choice{.name = "potential flow", .prefix = "potential_", .method = "cg",
                              .preconditioner = "sor", .relative_tolerance = 1e-14, .singular = true};
    for (Region region : resting) {
        const std::vector<Tet> cells = all_tets(current, region);
        Array<Vertex, double> swept = swept_by_boundary(step, cells);
        if (std::ranges::all_of(swept, [](double s) { return s == 0; })) continue;
        balance(current, cells, swept);
        const Numbering numbering = number_vertices(current, cells, ranks.count);
        const auto system = potential_system(current, cells, numbering, ranks.rank, swept);
        const Solution potential = solve(ranks, system, choice);
        add_gradient(current, cells, numbering, potential.value, flow.velocity);
        flow.iterations += potential.iterations;
    }
    return flow;
}

}  // namespace kropla
