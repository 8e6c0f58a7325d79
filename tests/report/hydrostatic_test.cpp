#include "report/hydrostatic.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

constexpr const char* box = "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 4]\n";
constexpr const char* liquid = "[flow.region.\"surroundings\"]\ndensity = 1000\n";

TEST(Hydrostatic, RisesDownwards) {
    const Hydrostatic at_rest = hydrostatic(std::string(box) + "[flow]\ngravity = [0, 0, -10]\n" + liquid);
    EXPECT_TRUE(is_there(at_rest));
    EXPECT_EQ(pressure_at(at_rest, {0.3, 0.2, 2}), 0);
    EXPECT_EQ(pressure_at(at_rest, {0.3, 0.2, 1}), 1e4);
}

TEST(Hydrostatic, IsNotThereWithoutGravity) {
    EXPECT_FALSE(is_there(hydrostatic(std::string(box) + liquid)));
    EXPECT_FALSE(is_there(hydrostatic("")));
}

}  // namespace
}  // namespace kropla
