#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "adapt/star.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// ball_of_vertex with its corner 1 at (3, 0, 0) instead of (1, 0, 0): the side of +x is sparse.
Mesh sparse_to_the_right() {
    Mesh mesh = ball_of_vertex();
    mesh.position[Vertex(1)] = {3, 0, 0};
    return mesh;
}

TEST(LaplacianPlace, IsTheMeanOfTheNeighbours) {
    const Vec3 place = laplacian_place(sparse_to_the_right(), Vertex(0), {1, 0});
    EXPECT_NEAR(place.x, (3.0 - 1.0) / 6, 1e-15);
    EXPECT_NEAR(place.y, 0, 1e-15);
    EXPECT_NEAR(place.z, 0, 1e-15);
}

TEST(LaplacianPlace, EqualVolumeWeightsFollowThePapersFormula) {
    // The sums of the distances from (3,0,0), from (-1,0,0) and from each of the four on the axes y and z.
    const double right = 4 + 4 * std::sqrt(10.0), left = 4 + 4 * std::sqrt(2.0);
    const double aside = std::sqrt(10.0) + 3 * std::sqrt(2.0) + 2;
    const double total = right + left + 4 * aside;
    const double by_hand = (3 * right - left) / total;
    const Vec3 place = laplacian_place(sparse_to_the_right(), Vertex(0), {0, 1});
    EXPECT_NEAR(place.x, by_hand, 1e-14);
    EXPECT_NEAR(place.y, 0, 1e-15);
    EXPECT_GT(place.x, 1.5 / 3);  // the sparse side pulls harder than by the mean, 1/3

    // Both weights sum to the number of neighbours, so that x1 = x2 = 1 is half of each.
    const Vec3 both = laplacian_place(sparse_to_the_right(), Vertex(0), {1, 1});
    EXPECT_NEAR(both.x, (by_hand + 1.0 / 3) / 2, 1e-14);
}

TEST(LaplacianPlace, SlidesOnTheFacesOfTheBox) {
    Mesh mesh = cube_of_tets(2);
    const Vertex on_face(12), on_edge(9), corner(0);  // (0, .5, .5), (0, 0, .5), (0, 0, 0)
    mesh.position[on_face] = {0, 0.6, 0.45};
    mesh.position[on_edge] = {0, 0, 0.6};
    ASSERT_EQ(verify(mesh), "");

    Vec3 mean;
    const auto neighbours = adjacent_vertices(mesh, on_face);
    for (Vertex v : neighbours) mean += mesh.position[v] / static_cast<double>(neighbours.size());
    const Vec3 on_face_after = laplacian_place(mesh, on_face, {1, 0});
    EXPECT_EQ(on_face_after.x, 0);
    EXPECT_NEAR(on_face_after.y, mean.y, 1e-15);
    EXPECT_NEAR(on_face_after.z, mean.z, 1e-15);
    EXPECT_GT(mean.x, 0.1);  // it would leave the face

    const Vec3 on_edge_after = laplacian_place(mesh, on_edge, {1, 0});
    EXPECT_EQ(on_edge_after.x, 0);
    EXPECT_EQ(on_edge_after.y, 0);
    EXPECT_NE(on_edge_after.z, 0.6);
    EXPECT_EQ(laplacian_place(mesh, corner, {1, 0}), mesh.position[corner]);
}

TEST(LaplacianPlace, StaysOnInterfacesAndOnOtherSurfaces) {
    Mesh mesh = cube_in_cube(4);
    jiggle(mesh, 0.02, 1);
    int held = 0;
    for (Vertex v : all_vertices(mesh)) {
        if (!on_interface(mesh, v)) continue;
        EXPECT_EQ(laplacian_place(mesh, v, {0, 1}), mesh.position[v]);
        ++held;
    }
    EXPECT_EQ(held, 26);  // of the 3^3 vertices of the inner cube all but its centre

    Mesh shelled = cube_of_tets(2);
    rename_patch(shelled, Patch(0), rigid_patch);
    EXPECT_EQ(laplacian_place(shelled, Vertex(12), {1, 0}), shelled.position[Vertex(12)]);
}

TEST(SmoothLaplacian, SeesTheNewPlacesOfTheVerticesBefore) {
    Mesh mesh = cube_of_tets(3);
    jiggle(mesh, 0.03, 1);
    Mesh by_hand = mesh;
    const std::vector<Vertex> two = {Vertex(21), Vertex(22)};  // (1,1,1)/3 and (2,1,1)/3, joined by an edge
    by_hand.position[two[0]] = laplacian_place(by_hand, two[0], {1, 0});
    const Vec3 alone = laplacian_place(mesh, two[1], {1, 0});
    by_hand.position[two[1]] = laplacian_place(by_hand, two[1], {1, 0});
    smooth_laplacian(mesh, two, {1, 0});
    EXPECT_EQ(mesh, by_hand);
    EXPECT_NE(mesh.position[two[1]], alone);
}

double worst_of_ball(const Mesh& mesh, Vertex v) { return worst_aspect_ratio(mesh, ball(mesh, v)); }

/// Does `move` to vertex 0 of many random balls and counts how often it moved; `goal` must fall if it did,
/// and the ball stay as it was if not.
template <class Move, class Goal>
int moves_of_random_balls(Move move, Goal goal, double least_fall) {
    int moved = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        Mesh mesh = random_ball(seed);
        const Mesh before = mesh;
        const bool did = move(mesh, Vertex(0));
        EXPECT_EQ(did, !(mesh == before)) << "seed " << seed;
        EXPECT_EQ(verify(mesh), "") << "seed " << seed;
        if (!did) continue;
        ++moved;
        EXPECT_LE(goal(mesh, Vertex(0)), (1 - least_fall) * goal(before, Vertex(0))) << "seed " << seed;
    }
    return moved;
}

TEST(SmoothGuarded, NeverWorsensTheWorstOfABall) {
    for (const LaplaceWeights& weights : {LaplaceWeights{1, 0}, LaplaceWeights{0, 1}}) {
        const auto move = [&](Mesh& mesh, Vertex v) {
            return !smooth_guarded(mesh, {&v, 1}, weights).empty();
        };
        const int moved = moves_of_random_balls(move, worst_of_ball, 0);
        EXPECT_GE(moved, 200);   // it did happen
        EXPECT_LE(moved, 290);  // and so did its refusal
    }
}

TEST(OptimiseVertex, MovesOnlyIfTheWorstFalls) {
    const auto move = [](Mesh& mesh, Vertex v) { return optimise_vertex(mesh, v, 3); };
    EXPECT_GE(moves_of_random_balls(move, worst_of_ball, 1e-3), 150);
    const auto idle = [](Mesh& mesh, Vertex v) { return optimise_vertex(mesh, v, worst_of_ball(mesh, v)); };
    EXPECT_EQ(moves_of_random_balls(idle, worst_of_ball, 1e-3), 0);  // already good enough
}

TEST(Smoothing, KeepsTheShapeOfBoxAndBody) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = cube_in_cube(5);
        jiggle(mesh, 0.018, seed);
        const Mesh before = mesh;
        const auto vertices = all_vertices(mesh);
        EXPECT_FALSE(smooth_guarded(mesh, vertices, {0, 1}).empty());
        int optimised = 0;
        for (Vertex v : vertices) optimised += optimise_vertex(mesh, v, 3) ? 1 : 0;
        EXPECT_GT(optimised, 0);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same(properties(mesh), properties(before)));
        for (Vertex v : vertices)
            EXPECT_TRUE(!on_interface(mesh, v) || mesh.position[v] == before.position[v]);
    }
}

}  // namespace
}  // namespace kropla
