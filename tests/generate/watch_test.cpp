// The making of the initial mesh, followed and ended from outside.
#include "base/random.h"
#include <kropla/base/watch.h>
#include "generate/domains.h"
#include <kropla/generate/generate.h>

#include <gtest/gtest.h>

#include <vector>
#include <string>

namespace kropla {
namespace {

Domain one_ball() { return small_domain({ball({0, 0, 4}, 1)}); }

TEST(Watch, IsToldTheStagesInOrder) {
    std::vector<std::string> stages;
    Watch watch;
    watch.progress = [&](std::string_view stage, double share) {
        EXPECT_GE(share, 0);
        EXPECT_LE(share, 1);
        if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    };
    const Mesh watched = generate_mesh(one_ball(), 1, &watch);
    EXPECT_EQ(stages, (std::vector<std::string>{"meshing surfaces", "drawing points", "relaxing points", "joining cells"}));
    EXPECT_EQ(watched, generate_mesh(one_ball(), 1));  // nothing else comes of it
}

// Whenever it says stop, nothing more is begun.
TEST(Watch, EndsTheInitialMeshWhereverItIs) {
    int told = 0;
    Watch counting;
    counting.progress = [&](std::string_view, double) { ++told; };
    static_cast<void>(generate_mesh(one_ball(), 1, &counting));
    ASSERT_GT(told, 4);
    for (int last = 1; last <= told; ++last) {
        SCOPED_TRACE(last);
        int heard = 0;
        Watch watch;
        watch.progress = [&](std::string_view, double) { watch.stop = ++heard == last; };
        EXPECT_THROW(static_cast<void>(generate_mesh(one_ball(), 1, &watch)), Interrupted);
        EXPECT_EQ(heard, last);
    }
}

TEST(Watch, EndsEachPartOfItBeforeItsFirstPoint) {
    Watch watch;
    watch.stop = true;
    const Domain domain = one_ball();
    std::vector<Vec3> many;
    Random random{1};
    for (int i = 0; i < 10000; ++i) many.push_back({random.uniform(), random.uniform(), random.uniform()});
    EXPECT_THROW(static_cast<void>(triangulate(many, &watch)), Interrupted);
    EXPECT_THROW(static_cast<void>(sample_points(snapshot(domain, 0), 1, &watch)), Interrupted);
    EXPECT_THROW(static_cast<void>(triangulate_surface(domain.bodies[0].shape, 0.2, 1, &watch)), Interrupted);
}

}  // namespace
}  // namespace kropla
