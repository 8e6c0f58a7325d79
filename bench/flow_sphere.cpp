// The drag of a sphere at a Reynolds number of 100, 1.0882 in an unbounded stream (docs: validation): what it
// takes to have it, by the size of triangles on the sphere [diameters], the growth of sizes outwards and the
// half-width of the box.
#include <kropla/mesh/prisms.h>
#include <kropla/simulate/flow.h>
#include <kropla/step/initial_mesh.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>

using namespace kropla;

int main(int count, char** words) {
    const auto word = [&](int k, double otherwise) { return count > k ? std::atof(words[k]) : otherwise; };
    const double size = word(1, 0.06), growth = word(2, 0.15), half = word(3, 16);
    const PetscSession session;
    Domain domain{.box = {{-half, -half, -half}, {half, half, 2 * half}}, .bodies = {}, .size = {}};
    domain.bodies.push_back({.name = "sphere",
                             .shape = {.centre = {}, .semi_axes = {0.5, 0.5, 0.5}, .orientation = {}},
                             .layer = LayerOptions{.count = 4, .first_height = 0.3 * size}});
    domain.size = {.surface = size, .growth = growth, .far = half / 4};
    const Mesh mesh = initial_mesh(domain, 1);
    FlowOptions options{.regions = {FlowRegion{.density = 1, .viscosity = 0.01}, {}}};
    options.faces.fill({.kind = FlowFace::Kind::velocity,
                        .velocity = {Quantity{}, Quantity{}, [](const Vec3&, double) { return 1.0; }}});
    options.faces[5] = {.kind = FlowFace::Kind::open};
    options.scheme = FlowScheme::steady;
    FlowState state = still_flow(mesh);
    const std::clock_t begin = std::clock();
    const FlowReport report = step_flow(session.all_ranks(), mesh, mesh, options, state, 0, 1);
    std::printf(
        "%zu triangles, %d tets, %d prisms, %d vertices: Cd %.4f in %.2f s of CPU, %d passes, %d "
        "iterations\n",
        mesh.layers[0].triangles.size(), count_tets(mesh), count_prisms(mesh), count_vertices(mesh),
        report.bodies[0].force.z / (0.5 * std::numbers::pi / 4),
        static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, report.passes, report.iterations);
}
