// A worked example of an equation: two substances that diffuse, of which one decays into the other,
//     du/dt = div(D grad u) - k u,    dv/dt = div(D grad v) + k u,
// by backward Euler with lumped masses. Per step u first, then v with the new u: each system is an M-matrix, so that
// neither is ever negative, and what u loses v gains, to rounding.
#include "meshes.h"
#include "session.h"
#include "simulate/assembly.h"
#include "simulate/elements.h"
#include "simulate/solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

using std::numbers::pi;

/// Of one substance: what a cell adds to a step. A scalar c per vertex [1/m^3]; rows are amounts [-].
struct Reaction {
    const Mesh& mesh;
    double diffusivity, decay, dt;           // [m^2/s], [1/s], [s]
    const Array<Vertex, double>& old;        // c at the step's begin
    const Array<Vertex, double>& produced;   // [1/(m^3 s)]

    template <class Name>
    auto operator()(const Name& cell) const {
        const auto v = cell_vertices(mesh, cell);
        constexpr std::size_t n = std::tuple_size_v<decltype(v)>;
        const auto points = cell_points(corners(mesh, cell));
        CellSystem<n> system;
        for (std::size_t k = 0; k < points.size(); ++k) {
            for (std::size_t i = 0; i < n; ++i) {
                const double lumped = points[k].volume * shape_means<n>[k].value[i];
                system.held[i] += lumped;
                system.row_sum[i] += lumped * (1 + dt * decay);
                system.right[i] += lumped * old[v[i]];
                system.load[i] += lumped * dt * produced[v[i]];
                for (std::size_t j = 0; j < n; ++j)
                    system.matrix[i][j] += dt * diffusivity / points[k].volume *
                                           dot(points[k].volume_gradient[i], points[k].volume_gradient[j]);
            }
        }
        return system;
    }
};

/// One step of one substance, on all ranks.
Array<Vertex, double> step(const Ranks& ranks, const Pattern& pattern, const Reaction& reaction) {
    CellSystems cells;
    ask_cells(pattern.cells, reaction, [](const auto&) { return true; }, cells, ranks.watch);
    LinearSystem system(pattern.rows);
    add_cells(pattern, cells, system);
    const Solution solution = solve(ranks, system, {.name = "reaction", .preconditioner = preconditioner_for(ranks, system)});
    Array<Vertex, double> after = reaction.old;
    for (std::size_t r = 0; r < solution.value.size(); ++r) after[pattern.numbering.vertex[r]] = solution.value[r];
    return after;
}

double amount(const Mesh& mesh, const Array<Vertex, double>& c) {
    return energy(mesh, {.regions = std::vector<HeatRegion>(count_regions(mesh))}, c);  // of a capacity of one
}

// u = exp(-k t) w and u + v = w with w = 1 + exp(-D pi^2 t) cos(pi x).
TEST(ReactionDiffusion, WhatDecaysIsFoundAgain) {
    const double d = 0.1, k = 2, end = 0.5;
    const int steps = 200;
    const Mesh mesh = cube_grid(30, 1, 1, [](int i, int j, int l) { return Vec3{i / 30.0, j / 30.0, l / 30.0}; },
                                [](int, int, int) { return 0; });
    const auto both = [&](const Vec3& x, double t) { return 1 + std::exp(-d * pi * pi * t) * std::cos(pi * x.x); };
    Array<Vertex, double> u(mesh.position.size()), v(u.size(), 0.0), produced = v;
    for (Vertex a : u.indices()) u[a] = both(mesh.position[a], 0);
    const double begin = amount(mesh, u);
    const Pattern pattern = make_pattern(mesh, living_cells(mesh), petsc().all_ranks());
    for (int n = 0; n < steps; ++n) {
        const double dt = end / steps;
        u = step(petsc().all_ranks(), pattern, {mesh, d, k, dt, u, Array<Vertex, double>(u.size(), 0.0)});
        for (Vertex a : u.indices()) produced[a] = k * u[a];
        v = step(petsc().all_ranks(), pattern, {mesh, d, 0, dt, v, produced});
        EXPECT_GE(*std::ranges::min_element(v), 0);
    }
    EXPECT_NEAR(amount(mesh, u) + amount(mesh, v), begin, 1e-12 * begin);
    const auto exact_u = [&](const Vec3& x) { return std::exp(-k * end) * both(x, end); };
    const auto exact_v = [&](const Vec3& x) { return both(x, end) - exact_u(x); };
    const double area = 1 / 900.0;
    EXPECT_LT(l2_error(mesh, {"u", "", u}, exact_u) / std::sqrt(area), 1.35e-3);
    EXPECT_LT(l2_error(mesh, {"v", "", v}, exact_v) / std::sqrt(area), 1.31e-3);
}

}  // namespace
}  // namespace kropla
