#include "report/hydrostatic.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

constexpr const char* at_rest = R"(
[domain]
min = [0, 0, 0]
max = [1, 1, 4]
[flow]
gravity = [0, 0, -10]
[flow.region."surroundings"]
density = 1000
)";

constexpr const char* weightless = R"(
[domain]
min = [0, 0, 0]
max = [1, 1, 4]
[flow.region."surroundings"]
density = 1000
)";

TEST(Hydrostatic, RisesDownwards) {
    const Hydrostatic column = hydrostatic(at_rest);
    EXPECT_TRUE(is_there(column));
    EXPECT_EQ(pressure_at(column, {0.3, 0.2, 2}), 0);
    EXPECT_EQ(pressure_at(column, {0.3, 0.2, 1}), 1e4);
}

TEST(Hydrostatic, IsNotThereWithoutGravity) {
    EXPECT_FALSE(is_there(hydrostatic(weightless)));
    EXPECT_FALSE(is_there(hydrostatic("")));
}

}  // namespace
}  // namespace kropla
