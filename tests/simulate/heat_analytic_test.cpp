#include "meshes.h"
#include "session.h"
#include "simulate/elements.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

HeatFace face_value(double value) {
    return {HeatFace::Kind::value, [value](const Vec3&, double) { return value; }};
}

/// Steps of equal length on a mesh that stands still.
void run(const Mesh& mesh, const HeatOptions& options, NodalField& field, double dt, int steps) {
    for (int k = 0; k < steps; ++k) step_heat(petsc().all_ranks(), mesh, mesh, options, field, k * dt, dt);
}

// T = 1 - x + sin(pi x) exp(-pi^2 t) between two plates at 1 and 0.
double slab_error(int n, int steps) {
    const double end = 0.1;
    const auto place = [n](int i, int j, int k) { return Vec3{1.0 * i / n, 0.1 * j, 0.1 * k}; };
    const Mesh mesh = cube_grid(n, 1, 1, place, [](int, int, int) { return 0; });
    const auto exact = [](const Vec3& x, double t) {
        return 1 - x.x + std::sin(pi * x.x) * std::exp(-pi * pi * t);
    };
    HeatOptions options{.regions = {HeatRegion{}}};
    options.faces[0] = face_value(1);
    options.faces[1] = face_value(0);
    NodalField field = initial_temperature(mesh, options);
    for (Vertex v : mesh.position.indices()) field.values[v] = exact(mesh.position[v], 0);
    run(mesh, options, field, end / steps, steps);
    const double error = l2_error(mesh, field, [&](const Vec3& x) { return exact(x, end); });
    return error / 0.1;  // rms: the slab is 0.1 x 0.1
}

TEST(HeatAnalytic, SlabBetweenTwoTemperatures) {
    // Backward Euler decays too slowly, by pi^4 t dt / 2 = 1.2 % of sin(pi x)/e at 40 steps, rms 0.0032; the
    // mesh of 16 cells adds a fifth of that.
    const double coarse = slab_error(16, 40), fine = slab_error(32, 160);
    EXPECT_LT(coarse, 0.0045);
    EXPECT_GT(std::log2(coarse / fine), 1.9);  // dt as h^2: second order in space
}

/// The outer facets of a hollow ball become patch 1, those of the hole patch 0.
void name_inner_and_outer(Mesh& mesh, double between) {
    for (Tet t : mesh.tets.indices()) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (!mesh.patch[t][corner].exists()) continue;
            const Vertex v = mesh.tets[t][(corner + 1) % 4];
            mesh.patch[t][corner] = Patch(norm(mesh.position[v]) > between ? 1 : 0);
        }
    }
}

/// Integral of |grad T|^2: for conductivity 1 the heat flow times the temperature difference.
double dissipation(const Mesh& mesh, const NodalField& field) {
    double sum = 0;
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        const auto values = at_corners(field.values, cell_vertices(mesh, cell));
        for (const auto& point : cell_points(corners(mesh, cell)))
            sum += point.volume * squared_norm(gradient(point, values));
    });
    return sum;
}

// Nu = Q 2a / (4 pi a^2 k dT) of the shell between the radii 1 and 2, n shells of cubes: 4 exactly.
double shell_nusselt(int n) {
    std::vector<double> radii;
    for (int k = 0; k <= 2 * n; ++k) radii.push_back(1.0 * k / n);
    Mesh mesh = ball_of_shells(radii, [n](int shell) { return shell < n ? -1 : 0; });
    name_inner_and_outer(mesh, 1.5);
    HeatOptions options{.regions = {HeatRegion{}}};
    options.faces[0] = face_value(1);
    options.faces[1] = face_value(0);
    NodalField field = initial_temperature(mesh, options);
    run(mesh, options, field, 1e8, 1);  // one step, so long that the steady state is reached
    return dissipation(mesh, field) / (2 * pi);
}

TEST(HeatAnalytic, ShellHasItsNusseltNumber) {
    const double coarse = std::abs(shell_nusselt(3) - 4), fine = std::abs(shell_nusselt(6) - 4);
    EXPECT_LT(fine, 0.02);  // 0.5 %: inscribed facets of a sixth of the radius, linear in six cells
    EXPECT_GT(std::log2(coarse / fine), 1.7);
}

// A sphere of radius 1 and ten times the medium's conductivity, the same diffusivity, at 1 in a medium at 0.
// Temperatures at t alpha / a^2 = 0.2 by Laplace inversion: centre 0.88635, surface 0.78929, mean 0.82567.
TEST(HeatAnalytic, SphereCoolsInAMedium) {
    const std::vector<double> radii = {0, 0.3, 0.6, 0.85, 1, 1.08, 1.2, 1.4, 1.75, 2.3, 3.3};
    const Mesh mesh = ball_of_shells(radii, [](int shell) { return shell < 4 ? 1 : 0; });
    HeatOptions options{.regions = std::vector<HeatRegion>(2)};
    options.regions[1] = {.material = {.conductivity = 10, .density = 10, .specific_heat = 1},
                          .carried = Carried::with_mesh, .initial = 1};
    NodalField field = initial_temperature(mesh, options);
    run(mesh, options, field, 0.01, 20);
    // Of the coarse mesh: facets inscribed in the sphere, and an initial jump spread over the first cell
    // outside, which holds 1 % of the heat. Of backward Euler: 1 % of what was lost.
    const double mean = energy(mesh, options, field.values, Region(1)) / (10 * 4 * pi / 3);
    double centre = 0, surface = 0, vertices = 0;
    for (Vertex v : mesh.position.indices()) {
        if (norm(mesh.position[v]) < 1e-9) centre = field.values[v];
        if (std::abs(norm(mesh.position[v]) - 1) < 1e-9) surface += field.values[v], vertices += 1;
    }
    EXPECT_NEAR(centre, 0.88635, 0.02);
    EXPECT_NEAR(surface / vertices, 0.78929, 0.0028);
    EXPECT_NEAR(mean, 0.82567, 0.0119);
}

}  // namespace
}  // namespace kropla
