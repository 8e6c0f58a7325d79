// kropla_spread [STEPS]: how the displacement of a body is best spread into its surroundings. The motion of
// cases/droplet.toml, its first STEPS of 50 steps (25 unless told), with no change of connectivity, by
//   ours        move_boundary: a share of the displacement by distance and cell size, no system solved;
//   harmonic    the displacement that solves Laplace's equation with linear elements, given on the body,
//               none at the rim of the zone of ours, none across the faces of the box, where vertices slide;
//   stiffened   the same with each cell's stiffness divided by its volume, so that small cells keep their
//               shape, after [Masud, Hughes 1997], "A space-time Galerkin/least-squares finite element
//               formulation of the Navier-Stokes equations for moving domain problems".
// Each is followed by the same optimise_places. How long does the mesh stay good on its connectivity, and
// what does it cost?

#include "adapt/stepping.h"
#include <kropla/step/initial_mesh.h>
#include "adapt/constants.h"
#include "adapt/zone.h"
#include <kropla/mesh/quality.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>

namespace kropla {
namespace {

constexpr double limit = 10;          // of R/r
constexpr double end = 0.01;          // [s]
constexpr int case_steps = 50;
constexpr double tolerance = 1e-6;    // of the residual, to that at the start
constexpr int report_every = 5;       // steps

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

Domain droplet() {
    Domain domain;
    domain.box = {{-0.004, -0.004, 0}, {0.004, 0.004, 0.016}};
    domain.size = {.surface = 2e-4, .growth = 0.1, .far = 8e-4};
    Body body{"droplet", {{0, 0, 0.013}, {0.001, 0.001, 0.001}, {}}};
    body.motion = [](double t) {
        return Pose{{0.0003 * std::sin(4 * std::numbers::pi * t / end), 0, -t}, {}};
    };
    domain.bodies.push_back(body);
    return domain;
}

std::vector<Vertex> body_vertices(const Mesh& mesh) {
    std::vector<Vertex> vertices;
    for (Tet t : all_tets(mesh, Region(1)))
        vertices.insert(vertices.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    std::ranges::sort(vertices);
    const auto repeated = std::ranges::unique(vertices);
    vertices.erase(repeated.begin(), repeated.end());
    return vertices;
}

// ---- the harmonic displacement

using Stiffness = std::array<std::array<double, 4>, 4>;

/// Of a cell: its volume times the products of its shape functions' gradients; or those products alone.
Stiffness stiffness(const Mesh& mesh, Tet t, bool stiffened) {
    std::array<Vec3, 4> x, gradient;
    for (std::size_t i = 0; i < 4; ++i) x[i] = mesh.position[mesh.tets[t][i]];
    const double six_volumes = determinant(x[1] - x[0], x[2] - x[0], x[3] - x[0]);
    gradient[1] = cross(x[2] - x[0], x[3] - x[0]) / six_volumes;
    gradient[2] = cross(x[3] - x[0], x[1] - x[0]) / six_volumes;
    gradient[3] = cross(x[1] - x[0], x[2] - x[0]) / six_volumes;
    gradient[0] = -(gradient[1] + gradient[2] + gradient[3]);
    const double weight = stiffened ? 1 : six_volumes / 6;
    Stiffness k;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) k[i][j] = weight * dot(gradient[i], gradient[j]);
    return k;
}

/// The system for one component, by the mesh's vertices, where only those that are `open` may change it.
struct System {
    const Mesh& mesh;
    const ZoneMotion& motion;
    const std::vector<Stiffness>& cells;
    std::vector<char> open;

    /// The product of the stiffness and `u`, 0 at vertices that are not open.
    [[nodiscard]] std::vector<double> product(const std::vector<double>& u) const {
        std::vector<double> result(u.size(), 0.0);
        for (std::size_t c = 0; c < cells.size(); ++c) {
            const auto& v = mesh.tets[motion.cells[c]];
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < 4; ++j) result[at(v[i].value)] += cells[c][i][j] * u[at(v[j].value)];
        }
        for (std::size_t v = 0; v < u.size(); ++v)
            if (open[v] == 0) result[v] = 0;
        return result;
    }

    [[nodiscard]] std::vector<double> diagonal() const {
        std::vector<double> d(open.size(), 0.0);
        for (std::size_t c = 0; c < cells.size(); ++c)
            for (std::size_t i = 0; i < 4; ++i) d[at(mesh.tets[motion.cells[c]][i].value)] += cells[c][i][i];
        return d;
    }
};

double product(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// Conjugate gradients, preconditioned by the diagonal, from the values given at vertices that are not open.
/// Returns the number of iterations.
int solve(const System& system, std::vector<double>& u) {
    const auto diagonal = system.diagonal();
    std::vector<double> r = system.product(u), z(u.size(), 0.0);
    const auto precondition = [&] {
        for (std::size_t v = 0; v < u.size(); ++v) z[v] = system.open[v] != 0 ? r[v] / diagonal[v] : 0;
    };
    for (double& x : r) x = -x;
    precondition();
    auto p = z;
    double rz = product(r, z);
    const double wanted = tolerance * tolerance * rz;
    int iterations = 0;
    for (; rz > wanted && iterations < 10000; ++iterations) {
        const auto kp = system.product(p);
        const double step = rz / product(p, kp);
        for (std::size_t v = 0; v < u.size(); ++v) {
            u[v] += step * p[v];
            r[v] -= step * kp[v];
        }
        precondition();
        const double next = product(r, z);
        for (std::size_t v = 0; v < u.size(); ++v) p[v] = z[v] + next / rz * p[v];
        rz = next;
    }
    return iterations;
}

/// Puts the zone's vertices where the harmonic displacement takes them; those of bodies stand there already. `mesh`
/// is as it was before. Returns the number of iterations.
int spread_harmonically(const Mesh& mesh, const Zone& zone, ZoneMotion& motion, bool stiffened) {
    std::vector<Stiffness> cells;
    for (Tet t : motion.cells) cells.push_back(stiffness(mesh, t, stiffened));
    int iterations = 0;
    for (int axis = 0; axis < 3; ++axis) {
        System system{mesh, motion, cells, std::vector<char>(mesh.position.size(), 0)};
        std::vector<double> u(mesh.position.size(), 0.0);
        for (Vertex v : motion.vertices) system.open[at(v.value)] = freedom(zone, motion, v).along[at(axis)];
        for (Vertex v : motion.bodies) u[at(v.value)] = motion.place[v][axis] - mesh.position[v][axis];
        iterations += solve(system, u);
        for (Vertex v : motion.vertices)
            if (system.open[at(v.value)] != 0) motion.place[v][axis] = mesh.position[v][axis] + u[at(v.value)];
    }
    return iterations;
}

// ---- the ways compared

enum class Way { ours, harmonic, stiffened };

struct Outcome {
    int good_steps = 0;               // before R/r first is above the limit
    int steps = 0;                    // before a cell would turn over on its way
    std::vector<long> above;          // cells above the limit after each `report_every` steps
    std::vector<double> mean;         // R/r of the zone's cells there
    double spread_seconds = 0, optimise_seconds = 0;  // of the processor, all steps
    long iterations = 0;
};

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// One step by the way; the mesh is moved if no cell turns over.
bool step(Way way, Mesh& mesh, const Domain& domain, double t0, double t1, ZoneMotion& motion, Outcome& outcome) {
    const MovedBodies bodies{{body_vertices(mesh)}};
    Mesh moved = mesh;
    Zone zone;
    begin_motion(motion);
    const double begin = cpu_seconds();
    const bool arrived = move_boundary(moved, domain, bodies, t0, t1, zone, motion).arrived;
    if (way != Way::ours)
        outcome.iterations += spread_harmonically(mesh, zone, motion, way == Way::stiffened);
    const double spread = cpu_seconds();
    if (way == Way::ours ? !arrived : !check_way(motion, mesh, mesh.position, least_volume_kept).arrived) return false;
    const double checked = cpu_seconds();
    if (!optimise_places(zone, motion, mesh, AdaptOptions{})) return false;
    outcome.spread_seconds += spread - begin;
    outcome.optimise_seconds += cpu_seconds() - checked;
    write_places(motion, mesh);
    return true;
}

Outcome run(Way way, Mesh mesh, int steps) {
    const Domain domain = droplet();
    Outcome outcome;
    ZoneMotion motion;
    for (int i = 0; i < steps; ++i) {
        if (!step(way, mesh, domain, end * i / case_steps, end * (i + 1) / case_steps, motion, outcome)) break;
        const auto bad = std::ranges::count_if(motion.cells, [&](Tet t) { return motion.ratio[t] > limit; });
        if (bad == 0 && outcome.good_steps == i) ++outcome.good_steps;
        ++outcome.steps;
        if (outcome.steps % report_every != 0) continue;
        outcome.above.push_back(bad);
        double sum = 0;
        for (Tet t : motion.cells) sum += motion.ratio[t];
        outcome.mean.push_back(sum / static_cast<double>(motion.cells.size()));
    }
    return outcome;
}

void print_row(const char* name, const Outcome& o, int steps) {
    std::printf("| %s | %d | %d |", name, o.good_steps, o.steps);
    for (std::size_t i = 0; i < at(steps / report_every); ++i)
        if (i < o.above.size()) std::printf(" %ld (%.2f) |", o.above[i], o.mean[i]);
        else std::printf(" - |");
    const double done = std::max(o.steps, 1);
    std::printf(" %.3f | %.3f | %.0f |\n", o.spread_seconds / done, o.optimise_seconds / done,
                static_cast<double>(o.iterations) / done);
}

}  // namespace
}  // namespace kropla

int main(int count, char** arguments) try {
    using namespace kropla;
    const int steps = count > 1 ? std::atoi(arguments[1]) : 25;
    if (steps < 1 || steps > case_steps) return std::fprintf(stderr, "kropla_spread [STEPS]\n"), 2;
    const oneapi::tbb::global_control one(oneapi::tbb::global_control::max_allowed_parallelism, 1);
    const Mesh start = initial_mesh(droplet(), 1);
    std::printf("| way | steps until R/r > %g | steps done without a cell turned over |", limit);
    for (int i = report_every; i <= steps; i += report_every)
        std::printf(" above %g after %d (mean R/r) |", limit, i);
    std::printf(" spread, CPU s per step | optimise, CPU s per step | iterations per step |\n|");
    for (int i = 0; i < 6 + steps / report_every; ++i) std::printf("---|");
    std::printf("\n");
    print_row("ours", run(Way::ours, start, steps), steps);
    print_row("harmonic", run(Way::harmonic, start, steps), steps);
    print_row("harmonic, stiffened by 1/volume", run(Way::stiffened, start, steps), steps);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "kropla_spread: %s\n", error.what());
    return 1;
}
