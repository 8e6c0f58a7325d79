// A small body in a large box: far from it, where nothing moves, target sizes change too.

#include "adapt/cases.h"
#include "adapt/stepping.h"
#include <kropla/step/initial_mesh.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace kropla {
namespace {

Domain small_sphere_in_long_box(Motion motion) {
    return {{{-2, -1, -1}, {2, 1, 1}}, {{"sphere", {{0, 0, 0}, {0.08, 0.08, 0.08}, {}}, std::move(motion)}},
            {0.06, 0.3, 0.5}};
}

/// What a step costs, in cells looked at and replaced.
double work(const StepCost& cost) {
    return cost.changes.cells_replaced + cost.changes.treated + cost.changes.cut_out;
}

/// The share of edges that are far from their size.
double misfits(const Mesh& mesh, const Snapshot& at) {
    int edges = 0, wrong = 0;
    for (Vertex v : all_vertices(mesh))
        for (Vertex w : adjacent_vertices(mesh, v)) {
            const Vec3 a = mesh.position[v], b = mesh.position[w];
            const double size = distance(a, b) / ((target_size(at, a) + target_size(at, b)) / 2);
            wrong += size < 0.5 || size > 2 ? 1 : 0;
            ++edges;
        }
    return double(wrong) / edges;
}

/// The work of the last `window` steps is bounded by that of as many from `first` on, each against the way gone.
void expect_constant_cost(Motion motion, int steps, int first, int window, std::uint64_t seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Domain domain = small_sphere_in_long_box(std::move(motion));
    const Mesh start = initial_mesh(domain, seed);
    MovingMesh moving(domain, start, 0);
    const double misfits_at_start = misfits(start, snapshot(domain, 0));
    std::vector<double> works, ways;
    Vec3 centre = shape_at(domain.bodies.front(), 0).centre;
    for (int i = 1; i <= steps; ++i) {
        const StepCost cost = step_to(moving, double(i) / steps);
        EXPECT_EQ(cost.attempts, 1) << "step " << i;
        EXPECT_EQ(cost.changes.given_up, 0) << "step " << i;
        works.push_back(work(cost));
        const Vec3 next = shape_at(domain.bodies.front(), moving.time()).centre;
        ways.push_back(distance(centre, next));
        centre = next;
        ASSERT_EQ(verify(moving.reference()), "") << "step " << i;
        EXPECT_LE(worst_of(moving.reference()), 6) << "step " << i;
    }
    const auto work_per_way = [&](int from) {
        return std::accumulate(works.begin() + from, works.begin() + from + window, 0.0) /
               std::accumulate(ways.begin() + from, ways.begin() + from + window, 0.0);
    };
    EXPECT_GT(work_per_way(first), 0);
    EXPECT_LE(work_per_way(steps - window), 1.5 * work_per_way(first));
    EXPECT_NEAR(count_vertices(moving.reference()), count_vertices(start), 0.07 * count_vertices(start));
    EXPECT_LE(misfits(moving.reference(), snapshot(domain, 1)), misfits_at_start + 5e-4);
}

TEST(Wake, CellsLeftBehindAreCoarsenedAndThoseAheadRefined) {
    expect_constant_cost([](double t) { return Pose{{3.2 * t - 1.6, 0, 0}, {}}; }, 45, 10, 10, 1);
}

// What is beyond the cells that move is told by the mesh and the motion alone: a run may be resumed anywhere.
TEST(Wake, OneThatBeginsHereGoesOnLikeOneThatCame) {
    const Domain domain = small_sphere_in_long_box([](double t) { return Pose{{2.4 * t - 1.2, 0.2, 0}, {}}; });
    MovingMesh came(domain, initial_mesh(domain, 3), 0);
    int far_away = 0;
    for (int i = 1; i <= 12; ++i) {
        MovingMesh begins(domain, came.reference(), came.time());
        const StepCost cost = step_to(came, i / 30.0);
        step_to(begins, i / 30.0);
        ASSERT_EQ(came.reference(), begins.reference()) << "step " << i;
        const Vec3 centre = shape_at(domain.bodies.front(), came.time()).centre;
        for (Tet t : cost.changes.cells)
            far_away += alive(came.reference(), t) && distance(centroid(came.reference(), t), centre) > 1;
    }
    EXPECT_GE(far_away, 2700);  // the motion reaches 0.8 away at most
}

TEST(Wake, ToAndFro) {
    expect_constant_cost(
        [](double t) {
            const double turn = 6 * std::numbers::pi * t;  // three rounds
            return Pose{{0.3 * std::sin(turn), 0.1 * std::cos(2 * turn), 0}, {}};
        },
        36, 12, 12, 2);
}

}  // namespace
}  // namespace kropla
