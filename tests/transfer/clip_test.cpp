#include "base/random.h"
#include "transfer/clip.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

double share(const TetMoments& m) {
    double sum = 0;
    for (const auto& row : m)
        for (double x : row) sum += x;
    return sum;
}

void expect_near(const TetMoments& a, const TetMoments& b, double tolerance) {
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance);
}

TEST(Clip, KnowsTheMomentsOfTheWholeTet) { expect_near(moments(whole_tet()), whole_moments(), 1e-16); }

TEST(Clip, CutsOffACornerOfHalfTheSize) {
    TetPart corner = whole_tet(), rest = whole_tet();
    EXPECT_TRUE(cut(corner, {-0.5, 0.5, -0.5, -0.5}));  // a1 >= 1/2
    EXPECT_TRUE(cut(rest, {0.5, -0.5, 0.5, 0.5}));
    EXPECT_EQ(corner.count, 1);
    EXPECT_EQ(rest.count, 3);  // a prism
    EXPECT_NEAR(share(moments(corner)), 1.0 / 8, 1e-16);
    EXPECT_NEAR(share(moments(rest)), 7.0 / 8, 1e-15);
    // In the corner, a1 = (1 + b) / 2 with b the coordinate of a whole tet: mean of a1^2 = (1 + 2/4 + 1/10) /
    // 4.
    EXPECT_NEAR(moments(corner)[1][1], (1 + 0.5 + 0.1) / 4 / 8, 1e-16);
}

TEST(Clip, LeavesWhatIsInsideAndNothingOfWhatIsOutside) {
    TetPart part = whole_tet();
    EXPECT_FALSE(cut(part, {1, 2, 0.5, 0}));
    EXPECT_EQ(part.count, 1);
    EXPECT_TRUE(cut(part, {-1, -2, -0.5, -1e-3}));
    EXPECT_EQ(part.count, 0);
    EXPECT_EQ(share(moments(part)), 0);
}

/// Planes through corners, edges and facets among them, and planes almost there.
double random_value(Random& random) {
    const double value = random.uniform(-1, 1);
    switch (random.below(6)) {
        case 0:
            return 0;
        case 1:
            return value * 1e-17;
        default:
            return value;
    }
}

TEST(Clip, PartsOfAnArrangementOfPlanesMakeUpTheWhole) {
    Random random{1};
    for (int n = 0; n < 20000; ++n) {
        std::array<std::array<double, 4>, 4> planes;
        for (auto& plane : planes) {
            for (double& value : plane) value = random_value(random);
            plane[random.below(4)] = random.uniform(0.5, 1);  // not zero everywhere
        }
        TetMoments sum{};
        for (unsigned side = 0; side < 16; ++side) {
            TetPart part = whole_tet();
            for (std::size_t i = 0; i < 4; ++i) {
                auto plane = planes[i];
                if (side >> i & 1u)
                    for (double& value : plane) value = -value;
                cut(part, plane);
            }
            const TetMoments m = moments(part);
            EXPECT_GE(share(m), -1e-15) << "seed 1, " << n;
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < 4; ++j) sum[i][j] += m[i][j];
        }
        ASSERT_NEAR(share(sum), 1, 1e-14) << "seed 1, " << n;
        expect_near(sum, whole_moments(), 1e-14);
    }
}

}  // namespace
}  // namespace kropla
