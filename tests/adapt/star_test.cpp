#include "adapt/cases.h"
#include "adapt/star.h"
#include "base/random.h"
#include "base/tetrahedron.h"
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<StarFacet> star_of(const Mesh& mesh, Vertex v) {
    std::vector<StarFacet> star;
    star_of_ball(mesh, mesh.position, v, ball(mesh, v), star);
    return star;
}

TEST(Star, OfABallMakesItsTets) {
    const Mesh mesh = random_ball(1);
    const Vec3 x = mesh.position[Vertex(0)];
    double sum = 0;
    const auto star = star_of(mesh, Vertex(0));
    ASSERT_EQ(star.size(), 8u);
    for (const auto& [a, b, c] : star) {
        EXPECT_GT(tet_volume(x, a, b, c), 0);
        sum += tet_volume(x, a, b, c);
    }
    EXPECT_NEAR(sum, region_volume(mesh, surroundings), 1e-14);
    EXPECT_NEAR(worst_in_star(star, x, infinity), worst_of(mesh), 1e-12 * worst_of(mesh));
}

TEST(Star, FreedomIsAcrossNoFaceOfTheBox) {
    const auto along = [](unsigned patches, bool interface) { return freedom({patches, interface}).along; };
    using Axes = std::array<bool, 3>;
    EXPECT_EQ(along(0, false), (Axes{true, true, true}));
    EXPECT_EQ(along(1u << 1, false), (Axes{false, true, true}));
    EXPECT_EQ(along(1u << 0 | 1u << 5, false), (Axes{false, true, false}));
    EXPECT_TRUE(freedom({1u << 0 | 1u << 3 | 1u << 4, false}).none());
    EXPECT_TRUE(freedom({0, true}).none());
    EXPECT_TRUE(freedom({1u << box_faces, false}).none());  // not a plane face
    EXPECT_EQ(restricted({1, 2, 3}, freedom({1u << 3, false})), (Vec3{1, 0, 3}));
}

TEST(Star, BoundsEndTheEvaluationButNotTheAnswer) {
    const auto star = star_of(random_ball(2), Vertex(0));
    const double worst = worst_in_star(star, {}, infinity);
    EXPECT_EQ(worst_in_star(star, {}, worst), worst);
    EXPECT_GT(worst_in_star(star, {}, 0.9 * worst), 0.9 * worst);
    EXPECT_EQ(worst_in_star(star, {100, 0, 0}, infinity), infinity);  // outside the star
}

/// The least worst ratio on a grid over the ball's bounds, which closes in on its best point `rounds` times.
double by_grid(std::span<const StarFacet> star, const Freedom& f, const Vec3& start) {
    constexpr int half = 10;
    Vec3 best = start;
    double worst = worst_in_star(star, start, infinity);
    double reach = 3;
    for (int round = 0; round < 5; ++round, reach /= half / 2.0) {
        const Vec3 centre = best;
        for (int i = -half; i <= half; ++i)
            for (int j = -half; j <= half; ++j)
                for (int k = -half; k <= half; ++k) {
                    const Vec3 step = restricted(reach / half * Vec3{double(i), double(j), double(k)}, f);
                    const double found = worst_in_star(star, centre + step, worst);
                    if (found >= worst) continue;
                    worst = found;
                    best = centre + step;
                }
    }
    return worst;
}

TEST(Star, BestPlaceIsNearlyAsGoodAsAGridSearch) {
    // Descent of a maximum stops short where it creeps along a kink; these are the shares that it may leave.
    double sum = 0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = random_ball(seed);
        const auto star = star_of(mesh, Vertex(0));
        const Vec3 start = mesh.position[Vertex(0)];
        const Place place = best_place(star, start, {}, 3);
        EXPECT_EQ(place.worst, worst_in_star(star, place.x, infinity));
        EXPECT_LE(place.worst, worst_in_star(star, start, infinity));
        const double grid = by_grid(star, {}, start);
        EXPECT_LE(place.worst, 1.25 * grid);
        sum += place.worst / grid;
        ++count;
    }
    EXPECT_LE(sum / count, 1.05);
}

TEST(Star, BestPlaceStopsWhereItIsGoodEnoughAndMovesOnlyWhereItMay) {
    int stopped = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = random_ball(seed);
        const auto star = star_of(mesh, Vertex(0));
        const Vec3 start = mesh.position[Vertex(0)];
        const double worst = worst_in_star(star, start, infinity);
        EXPECT_EQ(best_place(star, start, {}, worst).x, start);
        const Freedom in_plane = freedom({1u << 4, false});
        const Place place = best_place(star, start, in_plane, 3);
        EXPECT_EQ(place.x.z, start.z);
        if (place.worst < worst) ++stopped;
        EXPECT_EQ(best_place(star, start, freedom({0, true}), 3).x, start);
    }
    EXPECT_GE(stopped, 20);
}

}  // namespace
}  // namespace kropla
