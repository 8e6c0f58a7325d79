#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include "transfer/adapted.h"
#include "transfer/overlap.h"
#include "transfer/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <oneapi/tbb/global_control.h>

namespace kropla {
namespace {

constexpr double rounding = 1e-12;

/// Old cells are covered too: what the new ones take of each adds up to its volume.
void expect_covered(const Mesh& before, const Mesh& after, const ChangedCells& changed,
                    const Overlaps& found) {
    std::vector<double> taken(changed.gone.size(), 0);
    double largest = 0;
    for (std::size_t i = 0; i < changed.come.size(); ++i) {
        const double whole = volume(after, changed.come[i]);
        largest = std::max(largest, whole);
        double sum = 0;
        for (const CellShare& share : found.cell(i)) {
            sum += share.share;
            taken[static_cast<std::size_t>(share.gone)] += share.share * whole;
            EXPECT_EQ(before.region[changed.gone[static_cast<std::size_t>(share.gone)]],
                      after.region[changed.come[i]]);
        }
        EXPECT_NEAR(sum, 1, rounding);
    }
    for (std::size_t k = 0; k < taken.size(); ++k)
        EXPECT_NEAR(taken[k], volume(before, changed.gone[k]), rounding * largest);
    EXPECT_LE(found.worst_gap, rounding);
}

void expect_exact_cover(const Mesh& before, const Mesh& after) {
    const TransferPlan plan = plan_transfer(before, after);
    ASSERT_FALSE(plan.geometry->changed.come.empty());
    expect_covered(before, after, plan.geometry->changed, plan.geometry->overlaps);
}

TEST(Overlaps, CoverJitteredCubes) {
    std::size_t pairs = 0, searched = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh a = jittered_cube(6, seed), b = jittered_cube(5, seed + 100);
        const TransferPlan plan = plan_transfer(a, b);
        expect_covered(a, b, plan.geometry->changed, plan.geometry->overlaps);
        for (std::size_t i = 0; i < plan.geometry->changed.come.size(); ++i) pairs += plan.geometry->overlaps.cell(i).size();
        searched += plan.geometry->overlaps.searched;
    }
    EXPECT_GE(pairs, 50000u);
    EXPECT_EQ(searched, 0u);  // walking from neighbour to neighbour was enough
}

TEST(Overlaps, CoverGridsWhoseVerticesEdgesAndFacetsCoincide) {
    for (const auto& [n, m] : {std::pair{2, 4}, {4, 2}, {3, 4}, {2, 3}, {4, 4}}) {
        SCOPED_TRACE(std::to_string(n) + " to " + std::to_string(m));
        Mesh a = cube_of_tets(n), b = cube_of_tets(m);
        for (Vec3& x : b.position) x = {x.y, 1 - x.x, x.z};  // turned: its diagonals run the other way
        expect_exact_cover(a, b);
    }
}

TEST(Overlaps, CoverGridsThatAreOffByRounding) {
    Mesh a = cube_of_tets(3), b = cube_of_tets(3);
    for (Vec3& x : b.position) x = {x.y, 1 - x.x, x.z};
    jiggle(b, 1e-15, 1);
    expect_exact_cover(a, b);
    jiggle(b, 1e-9, 2);
    expect_exact_cover(a, b);
}

TEST(Overlaps, CoverFlatCells) {
    Mesh a = jittered_cube(5, 3), b = jittered_cube(5, 4);
    for (Mesh* mesh : {&a, &b})
        for (Vec3& x : mesh->position) x.z *= 1e-3;
    expect_exact_cover(a, b);
}

TEST(Overlaps, CoverWhatAdaptationChanged) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        const AdaptedMesh mesh = adapted_mesh(seed);
        const ChangedCells changed =
            changed_cells(mesh.before, mesh.after, mesh.changes.cells, mesh.changes.vertices);
        expect_covered(mesh.before, mesh.after, changed, overlaps(mesh.before, mesh.after, changed));
    }
}

TEST(Overlaps, NodalWeightsAreIntegralsOfShapeFunctions) {
    // With the old field 1, and with x: the weights give the integrals of the new shape functions, and of x
    // times them.
    const Mesh a = jittered_cube(4, 1), b = jittered_cube(3, 2);
    const TransferPlan plan = plan_transfer(a, b);
    for (std::size_t i = 0; i < plan.geometry->changed.come.size(); ++i) {
        const auto& corners = b.tets[plan.geometry->changed.come[i]];
        const double whole = volume(b, plan.geometry->changed.come[i]);
        double x_sum = 0;
        for (Vertex v : corners) x_sum += b.position[v].x;
        for (std::size_t k = 0; k < 4; ++k) {
            double one = 0, x = 0;
            for (const NodalShare& share : plan.geometry->overlaps.nodal(i)) {
                one += share.weight[k];
                x += share.weight[k] * a.position[share.from].x;
            }
            EXPECT_NEAR(one, whole / 4, rounding * whole);
            EXPECT_NEAR(x, whole / 20 * (x_sum + b.position[corners[k]].x), rounding * whole);
        }
    }
}

TEST(Overlaps, AreTheSameBitsForAnyNumberOfThreads) {
    const Mesh a = jittered_cube(6, 1), b = jittered_cube(6, 2);
    const auto weights = [&](std::size_t threads) {
        const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism,
                                                  threads);
        const TransferPlan plan = plan_transfer(a, b);
        std::vector<double> all;
        for (const auto& chunk : plan.geometry->overlaps.chunks)
            for (const NodalShare& share : chunk.nodal)
                all.insert(all.end(), share.weight.begin(), share.weight.end());
        return all;
    };
    EXPECT_TRUE(weights(1) == weights(2));
}

}  // namespace
}  // namespace kropla
