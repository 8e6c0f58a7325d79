// Steps that are ended from outside, wherever they are.
#include "adapt/cases.h"
#include <kropla/adapt/attempt.h>

#include <gtest/gtest.h>

namespace kropla {
namespace {

Domain falling_sphere() {
    Domain domain = sphere_in_box();
    domain.bodies[0].motion = [](double t) { return Pose{{0.1 * t, 0, -0.8 * t}, {}}; };
    return domain;
}

void step_to(MovingMesh& moving, double t) {
    MovedAttempt moved = move_bodies(Attempt(moving), t);
    ASSERT_FALSE(moved.refusal());
    accept(remesh(std::move(moved)));
}

/// Begins a step to `t`; the watch says stop before its stage 0, 1, ...
void step_until(MovingMesh& moving, Watch& watch, int stage, double t) {
    watch.stop = stage == 0;
    Attempt attempt(moving);
    watch.stop = stage == 1;
    MovedAttempt moved = move_bodies(std::move(attempt), t);
    watch.stop = stage == 2;
    (void)remesh(std::move(moved));
}

TEST(DroppedStep, LeavesTheReferenceAndIsDoneAnewToTheBit) {
    const Domain domain = falling_sphere();
    const Mesh start = improved_mesh(domain, 1);
    MovingMesh whole(domain, start, 0);
    for (const double t : {0.2, 0.4, 0.6}) step_to(whole, t);
    for (int stage = 0; stage < 3; ++stage) {
        SCOPED_TRACE(stage);
        Watch watch;
        AdaptOptions options;
        options.watch = &watch;
        MovingMesh moving(domain, start, 0, options);
        step_to(moving, 0.2);
        const Mesh before = moving.reference();
        EXPECT_THROW(step_until(moving, watch, stage, 0.4), Interrupted);
        EXPECT_EQ(moving.reference(), before);
        EXPECT_EQ(moving.time(), 0.2);
        watch.stop = false;
        for (const double t : {0.4, 0.6}) step_to(moving, t);
        EXPECT_EQ(moving.reference(), whole.reference());
    }
}

TEST(Improvement, IsEndedByItsWatch) {
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    spoil(mesh, surroundings, 10, 1);
    Watch watch;
    watch.stop = true;
    AdaptOptions options;
    options.watch = &watch;
    const Snapshot at = snapshot(domain, 0);
    EXPECT_THROW(improve(mesh, all_tets(mesh), at, options), Interrupted);
    EXPECT_THROW(repair(mesh, all_tets(mesh), at, options), Interrupted);
    EXPECT_THROW(static_cast<void>(cluster_remesh(mesh, all_tets(mesh), at, options)), Interrupted);
}

}  // namespace
}  // namespace kropla
