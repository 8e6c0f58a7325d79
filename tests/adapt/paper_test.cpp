// A step by the paper's own method.
#include "adapt/paper.h"

#include <kropla/adapt/attempt.h>
#include "adapt/cases.h"
#include "adapt/stepping.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

namespace kropla {
namespace {

const AdaptOptions by_paper{.paper = PaperMethod{}};

/// The sphere of `sphere_in_box`, smaller, from one end of the box to the other in the time of 1.
Domain crossing_sphere() {
    Domain domain = sphere_in_box();
    domain.bodies[0].shape = {{0, 0, 1}, {0.5, 0.5, 0.5}, {}};
    domain.bodies[0].motion = [](double t) { return Pose{{0.2 * t, -0.1 * t, -2 * t}, {}}; };
    return domain;
}

/// ball_of_vertex with its vertex 0 moved almost onto a facet.
Mesh spoilt_ball() {
    Mesh mesh = ball_of_vertex();
    mesh.position[Vertex(0)] = {0.28, 0.29, 0.3};
    rename_patch(mesh, Patch(0), rigid_patch);
    return mesh;
}

TEST(PaperMethod, KeepsTheFloorsWhileASphereCrossesABox) {
    const Domain domain = crossing_sphere();
    MovingMesh moving(domain, improved_mesh(domain, 1), 0, by_paper);
    const Properties start = properties(moving.reference());
    Changes all;
    constexpr int steps = 20;
    for (int i = 1; i <= steps; ++i) {
        const StepCost cost = step_to(moving, static_cast<double>(i) / steps);
        all += cost.changes;
        ASSERT_EQ(verify(moving.reference()), "") << i;
        EXPECT_LE(worst_of(moving.reference()), by_paper.floor) << i;
        const Properties now = properties(moving.reference());
        EXPECT_TRUE(same_shape(now, start)) << i;
        EXPECT_NEAR(now.volume.at(surroundings) / start.volume.at(surroundings), 1, 1e-12);
    }
    EXPECT_GT(all.smoothing_sweeps, 0);
    EXPECT_GT(all.swaps, 0);
    EXPECT_GT(all.local_remeshes, 0);
    EXPECT_EQ(all.splits, 0);  // sizes are not adapted
    EXPECT_EQ(all.collapses, 0);
}

TEST(PaperMethod, ARefusedStepLeavesTheMeshAsItWas) {
    const Domain domain = crossing_sphere();
    const Mesh start = improved_mesh(domain, 1);
    MovingMesh moving(domain, start, 0, by_paper), other(domain, start, 0, by_paper);
    MovedAttempt giant = move_bodies(Attempt(moving), 0.8);
    ASSERT_TRUE(giant.refusal());
    EXPECT_NE(giant.refusal()->why.find("cell "), std::string::npos) << giant.refusal()->why;
    EXPECT_EQ(giant.before().tets, giant.current().tets);
    refuse(std::move(giant));
    EXPECT_EQ(moving.reference(), start);
    {
        const Attempt again(moving);  // remeshed where it got stuck, and dropped
        EXPECT_GT(again.refined().cells.size(), 0u);
        EXPECT_EQ(verify(again.before()), "");
    }
    EXPECT_EQ(moving.reference(), start);
    (void)step_to(other, 0.05);
    MovingMesh third(domain, start, 0, by_paper);
    (void)step_to(third, 0.05);
    EXPECT_EQ(third.reference(), other.reference());  // the same bits
}

TEST(PaperSmoothing, PutsAVertexWhereItsWeightsSay) {
    for (const LaplaceWeights weights : {LaplaceWeights{1, 0}, LaplaceWeights{0, 1}, LaplaceWeights{0.5, 1}}) {
        Mesh mesh = spoilt_ball();
        mesh.position[Vertex(1)] = {1.6, 0, 0};  // a sparse side
        const Vec3 expected = laplacian_place(mesh, Vertex(0), weights);
        auto [zone, motion] = movable(mesh, all_tets(mesh));
        // Far below the limit: a sweep of the Laplacian and no more.
        const auto changes = smooth_places(zone, motion, mesh, {.floor = 1000, .paper = PaperMethod{weights, 1e-9, 0.9, 0.9, 1}});
        ASSERT_TRUE(changes);
        EXPECT_EQ(changes->moved, 1);
        EXPECT_EQ(changes->smoothing_sweeps, 1);
        EXPECT_NEAR(distance(motion.place[Vertex(0)], expected), 0, 1e-15);
    }
}

TEST(PaperSmoothing, EqualisesVolumesFirstAboutTheLimit) {
    Mesh mesh = spoilt_ball();
    auto [zone, motion] = movable(mesh, all_tets(mesh));
    ASSERT_GT(worst_of(mesh), by_paper.floor);
    const auto changes = smooth_places(zone, motion, mesh, by_paper);
    ASSERT_TRUE(changes);
    EXPECT_GE(changes->smoothing_sweeps, 2);
    write_places(motion, mesh);
    EXPECT_LT(worst_of(mesh), 5);
}

TEST(PaperSmoothing, LeavesGoodCellsAlone) {
    Mesh mesh = improved_mesh(sphere_in_box(), 1);
    auto [zone, motion] = movable(mesh, all_tets(mesh));
    const auto changes = smooth_places(zone, motion, mesh, {.floor = 20, .paper = PaperMethod{}});
    ASSERT_TRUE(changes);
    EXPECT_EQ(changes->smoothing_sweeps, 0);
    for (Vertex v : motion.vertices) EXPECT_EQ(motion.place[v], mesh.position[v]);
}

TEST(PaperSmoothing, TellsThatACellStaysTurnedOver) {
    Mesh mesh = ball_of_vertex();
    auto [zone, motion] = movable(mesh, all_tets(mesh));
    zone.axes[Vertex(0)] = 0;  // held
    motion.place[Vertex(0)] = {2, 0, 0};
    EXPECT_FALSE(smooth_places(zone, motion, mesh, by_paper));
}

TEST(PaperRemeshing, CutsOutWhatIsBad) {
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    spoil(mesh, surroundings, 10, 1);
    ASSERT_GT(worst_of(mesh), by_paper.floor);
    const Properties before = properties(mesh);
    const Changes changes = remesh_clusters(mesh, all_tets(mesh), about_the_limit(by_paper), snapshot(domain, 0), by_paper);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), before));
    EXPECT_LE(worst_of(mesh), about_the_limit(by_paper));
    EXPECT_GT(changes.swaps + changes.local_remeshes, 0);
}

}  // namespace
}  // namespace kropla
