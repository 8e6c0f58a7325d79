#include "base/random.h"
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/transfer/transfer.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

Vec3 point_at(const Mesh& mesh, const Location& at) {
    Vec3 x;
    for (std::size_t i = 0; i < 4; ++i) x += at.weights[i] * mesh.position[mesh.tets[at.tet][i]];
    return x;
}

double sum_of(const Location& at) { return std::accumulate(at.weights.begin(), at.weights.end(), 0.0); }

/// A point inside the tet, drawn at random.
Vec3 point_in(const Mesh& mesh, Tet t, Random& random) {
    std::array<double, 4> weights;
    for (double& w : weights) w = random.uniform(0.01, 1);
    const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& w : weights) w /= whole;
    return point_at(mesh, {t, weights});
}

std::vector<Tet> tets_of(const Mesh& mesh, Region region) {
    auto tets = all_tets(mesh);
    std::erase_if(tets, [&](Tet t) { return mesh.region[t] != region; });
    return tets;
}

/// From anywhere in the region to anywhere in it.
void expect_found(const Mesh& mesh, Region region, std::uint64_t seed) {
    SCOPED_TRACE("region " + std::to_string(region.value) + ", seed " + std::to_string(seed));
    const auto tets = tets_of(mesh, region);
    Random random{seed};
    for (int i = 0; i < 500; ++i) {
        const Tet start = tets[random.below(tets.size())], goal = tets[random.below(tets.size())];
        const Vec3 x = point_in(mesh, goal, random);
        const Location found = locate(mesh, x, start);
        EXPECT_EQ(found.tet, goal);
        EXPECT_NEAR(sum_of(found), 1, 1e-14);
        EXPECT_GE(std::ranges::min(found.weights), 0);
        EXPECT_LE(distance(point_at(mesh, found), x), 1e-14);
    }
}

TEST(Locate, FindsEveryPointOfAConvexRegion) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Mesh mesh = cube_of_tets(5);
        jiggle(mesh, 0.02, seed);
        expect_found(mesh, surroundings, seed);
    }
}

TEST(Locate, FindsEveryPointRoundABodyAndInIt) {
    // The body stands in the way of a walk between most tets of the thin layer round it.
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        Mesh mesh = cube_in_cube(6);
        jiggle(mesh, 0.016, seed);
        expect_found(mesh, surroundings, seed);
        expect_found(mesh, Region(1), seed);
    }
}

TEST(Locate, FindsVerticesAndPointsOfEdgesAndFacets) {
    Mesh mesh = cube_in_cube(4);
    jiggle(mesh, 0.02, 1);
    const std::array<double, 4> places[] = {{1, 0, 0, 0}, {0, 0.25, 0.75, 0}, {0.5, 0, 0.25, 0.25}};
    for (Tet t : all_tets(mesh))
        for (const auto& weights : places) {
            const Vec3 x = point_at(mesh, {t, weights});
            const Location found = locate(mesh, x, tets_of(mesh, mesh.region[t]).back());
            EXPECT_EQ(mesh.region[found.tet], mesh.region[t]);
            EXPECT_GE(std::ranges::min(found.weights), -1e-9);
            EXPECT_LE(distance(point_at(mesh, found), x), 1e-14);
        }
}

TEST(Locate, NeverLeavesTheRegion) {
    // Points of the body, sought in the surroundings: a tet there is taken, and its weights say "outside".
    Mesh mesh = cube_in_cube(5);
    jiggle(mesh, 0.02, 1);
    const auto outer = tets_of(mesh, surroundings);
    Random random{1};
    for (Tet t : tets_of(mesh, Region(1))) {
        const Vec3 x = point_in(mesh, t, random);
        const Location found = locate(mesh, x, outer[random.below(outer.size())]);
        EXPECT_EQ(mesh.region[found.tet], surroundings);
        EXPECT_LT(std::ranges::min(found.weights), 0);
        EXPECT_NEAR(sum_of(found), 1, 1e-13);
        EXPECT_LE(distance(point_at(mesh, found), x), 1e-13);
    }
}

}  // namespace
}  // namespace kropla
