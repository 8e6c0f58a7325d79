#include "simulate/step_mean.h"

#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

/// A thousand places along x, from 0 to 1, at rest.
std::vector<Way> places(int count = 1000) {
    std::vector<Way> ways;
    for (int k = 0; k < count; ++k) {
        const Vec3 x{(k + 0.5) / count, 0, 0};
        ways.push_back({x, x});
    }
    return ways;
}

double largest_error(const Quantity& quantity, const std::vector<Way>& ways, double t, double dt,
                     const std::function<double(const Vec3&)>& exact) {
    const std::vector<double> means = step_means(quantity, ways, t, dt, "heat.region.drop.source");
    EXPECT_EQ(means.size(), ways.size());
    double largest = 0;
    for (std::size_t k = 0; k < means.size(); ++k)
        largest = std::max(largest, std::abs(means[k] - exact(ways[k].from)));
    return largest;
}

// Whenever it says stop, no more is asked than a close look or a piece and its halves take.
TEST(StepMean, EndsWhereverTheWatchSaysStop) {
    constexpr int most_at_once = 2100;
    Watch watch;
    int asked = 0, last = 0;
    const auto hats = [&](const Vec3& x, double t) {
        if (++asked == last) watch.stop = true;
        return std::abs(std::sin(40 * t + x.x));
    };
    static_cast<void>(step_means(hats, places(3), 0, 1, "source", &watch));
    const int all = asked;
    ASSERT_GT(all, 10 * most_at_once);
    for (last = 1; last < all - most_at_once; last += all / 40) {
        SCOPED_TRACE(last);
        asked = 0;
        watch.stop = false;
        EXPECT_THROW(static_cast<void>(step_means(hats, places(3), 0, 1, "source", &watch)), Interrupted);
        EXPECT_LE(asked, last + most_at_once);
    }
}

TEST(StepMean, APulseBetweenTwoStepEndsCountsInFull) {
    const auto pulse = [](double from, double to) {
        return [=](const Vec3&, double t) { return t > from && t < to ? 1.0 : 0.0; };
    };
    const auto share = [](double value) { return [=](const Vec3&) { return value; }; };
    EXPECT_LT(largest_error(pulse(0.31, 0.39), places(), 0.3, 0.1, share(0.8)), 1e-12);
    EXPECT_LT(largest_error(pulse(0.3141, 0.3142), places(), 0.3, 0.1, share(1e-3)), 1e-12);
    EXPECT_LT(largest_error(pulse(0.31, 0.39), {places(1)}, 0.3, 0.1, share(0.8)), 1e-12);
    EXPECT_LT(largest_error(pulse(0.2, 0.3), places(), 0.3, 0.1, share(0)), 1e-12);  // over, at the beginning
    EXPECT_LT(largest_error(pulse(0.35, 9), places(), 0.3, 0.1, share(0.5)), 1e-12);
    // A train of them, each of another height, scaled by the place.
    const auto train = [](const Vec3& x, double t) { return (1 + x.x) * std::floor(10 * t); };
    EXPECT_LT(largest_error(train, places(), 0, 1, [](const Vec3& x) { return 4.5 * (1 + x.x); }), 1e-11);
}

TEST(StepMean, SmoothQuantitiesAreExact) {
    const auto wave = [](const Vec3& x, double t) { return std::sin(7 * t + x.x); };
    const auto mean = [](const Vec3& x) { return (std::cos(x.x) - std::cos(14 + x.x)) / 14; };
    EXPECT_LT(largest_error(wave, places(), 0, 2, mean), 1e-9);
    const auto bend = [](const Vec3& x, double t) { return std::abs(t - x.x); };  // each place at another time
    EXPECT_LT(largest_error(bend, places(), 0, 1,
                            [](const Vec3& x) { return (x.x * x.x + (1 - x.x) * (1 - x.x)) / 2; }),
              1e-8);
}

TEST(StepMean, EveryPlaceHasTimesOfItsOwn) {
    const auto front = [](const Vec3& x, double t) { return x.x < t ? 1.0 : 0.0; };
    EXPECT_LT(largest_error(front, places(), 0, 1, [](const Vec3& x) { return 1 - x.x; }), 1e-6);
    // A spot a fiftieth of its way wide, as it passes by.
    const auto spot = [](const Vec3& x, double t) { return std::exp(-std::pow((x.x - t) / 0.02, 2)); };
    const auto passed = [](const Vec3& x) {
        return 0.01 * std::sqrt(std::acos(-1.0)) * (std::erf((1 - x.x) / 0.02) + std::erf(x.x / 0.02));
    };
    EXPECT_LT(largest_error(spot, places(), 0, 1, passed), 1e-9);
}

TEST(StepMean, IsTakenWhereThePlaceIs) {
    const std::vector<Way> ways(40, {{0, 1, 2}, {1, 1, 0}});
    const auto steady = [](const Vec3& x, double) { return x.x + 10 * x.y + 100 * x.z; };
    for (double mean : step_means(steady, ways, 5, 1e-6, "")) EXPECT_NEAR(mean, 0.5 + 10 + 100, 1e-10);
    const auto wall = [](const Vec3& x, double) { return x.x > 0.3 ? 1.0 : 0.0; };
    for (double mean : step_means(wall, ways, 5, 1e-6, "")) EXPECT_NEAR(mean, 0.7, 1e-9);
}

TEST(StepMean, WhatStaysIsAskedForSeldom) {
    int asked = 0;
    const auto steady = [&asked](const Vec3& x, double) {
        ++asked;
        return 3 + x.x;
    };
    EXPECT_EQ(largest_error(steady, places(20000), 0, 1, [](const Vec3& x) { return 3 + x.x; }), 0);
    EXPECT_LT(asked, 3 * 20000 + 25000);  // and what the witnesses are asked
}

TEST(StepMean, SaysWhereThereIsNoValue) {
    const auto lost = [](const Vec3& x, double t) {
        return t < 0.5 || x.x < 0.5 ? 1 : std::numeric_limits<double>::quiet_NaN();
    };
    EXPECT_NO_THROW(static_cast<void>(step_means(lost, places(), 0, 0.4, "heat.region.drop.source")));
    try {
        static_cast<void>(step_means(lost, places(), 0, 1, "heat.region.drop.source"));
        FAIL();
    } catch (const CaseError& error) {
        const std::string said = error.what();
        EXPECT_EQ(said.find("heat.region.drop.source is nan at (0.5"), 0u) << said;
        EXPECT_NE(said.find("m, t = 0.5"), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace kropla
