#include "adapt/endurance.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

// The short form of `make endurance`: its bounds over sixty steps. Work is counted in cells here, which no
// busy machine disturbs.
TEST(Endurance, ALayeredDropletWandersAmongBodies) {
    constexpr std::uint64_t seed = 1;
    const EnduranceBounds bounds;
    constexpr int steps = 60;
    const EnduranceReport report = endure(steps, seed, bounds);
    EXPECT_EQ(report.steps.size(), std::size_t(steps)) << "seed " << seed;
    for (const std::string& line : broken_bounds(report, bounds)) ADD_FAILURE() << line << ", seed " << seed;
    EXPECT_LE(growth_of(report, [](const EnduranceStep& s) { return double(s.cells_touched); }), bounds.growth);
}

TEST(Endurance, TheWalkStaysWithinItsReachAndMovesOn) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const Motion walk = random_walk(1, seed);
        double longest = 0;
        for (int step = 0; step < 5000; ++step) {
            const Vec3 here = walk(step).displacement;
            for (int axis = 0; axis < 3; ++axis) ASSERT_LE(std::abs(here[axis]), 1) << "seed " << seed;
            longest = std::max(longest, distance(here, walk(step + 1).displacement));
        }
        EXPECT_GT(longest, 0.12) << "seed " << seed;
        EXPECT_LT(longest, 0.35) << "seed " << seed;
    }
}

}  // namespace
}  // namespace kropla
