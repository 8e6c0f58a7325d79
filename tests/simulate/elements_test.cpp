#include "base/random.h"
#include "simulate/elements.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

Vec3 random_point(Random& random) {
    return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Corners<4> random_corners(Random& random) {
    return {random_point(random), random_point(random), random_point(random), random_point(random)};
}

TEST(Elements, GradientsReproduceLinearFunctions) {
    Random random{7};
    for (int trial = 0; trial < 100; ++trial) {
        const Corners<4> x = random_corners(random);
        const CellPoint<4> tet = linear_tet(x);
        const Vec3 slope = random_point(random);
        Vec3 gradient;
        for (std::size_t i = 0; i < 4; ++i)
            gradient += dot(slope, x[i]) / tet.volume * tet.volume_gradient[i];
        EXPECT_LT(distance(gradient, slope), 1e-12 / std::abs(tet.volume)) << "seed 7, trial " << trial;
    }
}

TEST(Elements, VolumeSweptIsVolumeGained) {
    Random random{11};
    for (int trial = 0; trial < 100; ++trial) {
        const Corners<4> x0 = random_corners(random), x1 = random_corners(random);
        const auto mean = mean_volume_gradients(x0, x1)[0];
        double swept = 0;
        for (std::size_t i = 0; i < 4; ++i) swept += dot(x1[i] - x0[i], mean[i]);
        EXPECT_NEAR(swept, linear_tet(x1).volume - linear_tet(x0).volume, 1e-14)
            << "seed 11, trial " << trial;
    }
}

TEST(Elements, MeanAreaIsThatOfTheFacetOfTheTet) {
    Random random{13};
    const Corners<4> x0 = random_corners(random), x1 = random_corners(random);
    const Vec3 area = mean_area_vector({x0[1], x0[2], x0[3]}, {x1[1], x1[2], x1[3]});
    const Vec3 inwards = 3.0 * mean_volume_gradients(x0, x1)[0][0];  // to corner 0, away from facet 0
    EXPECT_LT(distance(area, -inwards), 1e-14);
}

/// A prism of about unit size, its corners off by up to 0.2: twisted, no quad is plane.
Corners<6> random_prism(Random& random) {
    Corners<6> x = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    for (Vec3& corner : x) corner += 0.2 * random_point(random);
    return x;
}

TEST(Elements, PrismsHaveTheirVolumeAndReproduceLinearFunctions) {
    Random random{17};
    for (int trial = 0; trial < 100; ++trial) {
        SCOPED_TRACE(testing::Message() << "seed 17, trial " << trial);
        const Corners<6> x = random_prism(random);
        const CellPoints<6> points = cell_points(x);
        EXPECT_NEAR(total_volume<6>(points), prism_volume(x), 1e-15);
        const Vec3 slope = random_point(random);
        std::array<double, 6> values;
        for (std::size_t i = 0; i < 6; ++i) values[i] = dot(slope, x[i]);
        for (const CellPoint<6>& point : points) EXPECT_LT(distance(gradient(point, values), slope), 1e-13);
    }
}

TEST(Elements, PrismsSweepWhatTheyGain) {
    Random random{19};
    for (int trial = 0; trial < 100; ++trial) {
        const Corners<6> x0 = random_prism(random), x1 = random_prism(random);
        double swept = 0;
        for (const auto& mean : mean_volume_gradients(x0, x1))
            for (std::size_t i = 0; i < 6; ++i) swept += dot(x1[i] - x0[i], mean[i]);
        EXPECT_NEAR(swept, prism_volume(x1) - prism_volume(x0), 1e-15) << "seed 19, trial " << trial;
    }
}

TEST(Elements, MeansOfPrismsAreThoseOfTriangleAndColumn) {
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) {
            double mean = 0;
            for (const ShapeMeans<6>& at : shape_means<6>) mean += at.product[i][j] / 6;
            const double triangle = i % 3 == j % 3 ? 1.0 / 6 : 1.0 / 12;
            const double column = i / 3 == j / 3 ? 1.0 / 3 : 1.0 / 6;
            EXPECT_NEAR(mean, triangle * column, 1e-16);
        }
    }
}

}  // namespace
}  // namespace kropla
