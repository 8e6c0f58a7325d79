#include <kropla/base/error.h>
#include "domain/approach.h"
#include "domain/paths.h"
#include "domain/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

using namespace kropla;

namespace {

constexpr double end = 0.01;

/// A box of 8 x 8 x 16 with a ball of radius 1 at height 13, which goes its way in ten steps.
Domain one_ball(Motion motion) {
    Domain domain;
    domain.box = {{-4, -4, 0}, {4, 4, 16}};
    domain.size = {0.2, 0.1, 0.8};
    domain.bodies = {body("droplet", ball({0, 0, 13}, 1))};
    domain.bodies[0].motion = std::move(motion);
    return domain;
}
Motion along_z(std::function<double(double)> z) {
    return [z](double t) { return Pose{{0, 0, z(t)}, {}}; };
}

PathLook look(const Domain& domain, double near = 0.2, std::vector<double> also_at = {}) {
    return look_at_paths(domain,
                         {.start = 0, .end = end, .steps = 10, .near = near, .also_at = std::move(also_at)});
}
std::string refusal(const Domain& domain, const std::vector<double>& also_at = {}) {
    try {
        (void)look(domain, 0.2, also_at);
    } catch (const DomainError& error) {
        return error.what();
    }
    return "";
}

bool begins(const std::string& text, const std::string& with) { return text.starts_with(with); }

}  // namespace

TEST(Paths, AcceptsPathsWithin) {
    EXPECT_EQ(refusal(one_ball(along_z([](double t) { return -1000 * t; }))), "");
    EXPECT_EQ(refusal(one_ball(along_z([](double t) { return std::abs(t - 0.00321) * -500; }))),
              "");  // a kink
    // As steep as 3 m in 10 ns, but no jump.
    const auto steep = [](double t) { return -1.5 - 1.5 * std::tanh((t - 0.00456) / 1e-8); };
    EXPECT_EQ(refusal(one_ball(along_z(steep))), "");
}

TEST(Paths, RefusesAPathOutOfTheBox) {
    const std::string said = refusal(one_ball(along_z([](double t) { return -1300 * t; })));
    EXPECT_TRUE(begins(said, "body \"droplet\": motion takes it out of the box at t = 9.2")) << said;
    EXPECT_NE(said.find(" ms: its lowest z is -0.0"), std::string::npos) << said;
    EXPECT_TRUE(said.ends_with(" m, the box begins at 0 m")) << said;
}

TEST(Paths, FindsWhereABodyJustLeavesTheBoxBetweenLooks) {
    // The lowest point of the path is 1e-5 below the floor, for a moment.
    const auto dip = [](double t) { return -12.00001 + 1e7 * (t - 0.0037123) * (t - 0.0037123); };
    Domain domain = one_ball(along_z(dip));
    domain.box.max.z = 1e4;
    EXPECT_TRUE(begins(refusal(domain), "body \"droplet\": motion takes it out of the box at t = 3.71"))
        << refusal(domain);
}

TEST(Paths, RefusesAMotionThatIsNotANumber) {
    for (double wrong : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        const std::string said = refusal(one_ball(along_z([=](double t) { return t < 0.003 ? 0 : wrong; })));
        EXPECT_EQ(said, "body \"droplet\": motion is not a number at t = 3 ms");  // the end of a step
    }
}

TEST(Paths, RefusesPathsThatMeet) {
    Domain domain = one_ball(along_z([](double t) { return -1000 * t; }));
    domain.bodies.push_back(body("drop2", ball({0, 0, 5}, 1)));
    EXPECT_TRUE(begins(refusal(domain),
                       "body \"droplet\" and body \"drop2\": motion takes them into each other at t = 6"))
        << refusal(domain);
}

TEST(Paths, RefusesJumpsWithWhenAndHowFar) {
    const auto jumps = [](double at, double by) {
        return refusal(one_ball(along_z([=](double t) { return t < at ? -100 * t : -100 * t - by; })));
    };
    EXPECT_EQ(jumps(0.002, 2.4),
              "body \"droplet\": motion makes it jump by 2.4 m at t = 2 ms; a path must not leap");
    EXPECT_EQ(jumps(0.00456789, 0.5),
              "body \"droplet\": motion makes it jump by 0.5 m at t = 4.56789 ms; a path must not leap");
    EXPECT_NE(jumps(1e-7, 0.03), "");
    EXPECT_NE(jumps(0.01 - 1e-7, 0.03), "");
    EXPECT_EQ(jumps(0.00456789, 0.01), "");  // a twentieth of a surface size: the constants of a formula
}

TEST(Paths, RefusesATurnAtOnce) {
    const auto turned = [](double degrees) {
        return refusal(one_ball([=](double t) {
            return Pose{{}, rotation_about({0, 1, 1}, t < 0.0031 ? 0.0 : degrees * std::numbers::pi / 180)};
        }));
    };
    EXPECT_EQ(turned(30),
              "body \"droplet\": motion turns it by 30 degrees at t = 3.1 ms; a path must not leap");
    EXPECT_EQ(turned(360), "");  // all the same
    EXPECT_EQ(refusal(one_ball([](double t) { return Pose{{}, rotation_about({0, 1, 0}, 3000 * t)}; })), "");
}

TEST(Paths, FindsExcursionsOfASixtyFourthOfAStep) {
    Random random{1};
    for (int i = 0; i < 200; ++i) {
        SCOPED_TRACE("pulse " + std::to_string(i) + " of seed 1");
        const double width = end / 10 / 64 * random.uniform(2, 3), from = random.uniform(0, end - width);
        const auto pulse = [=](double t) { return t > from && t < from + width ? 1.0 : 0.0; };
        EXPECT_TRUE(begins(refusal(one_ball(along_z(pulse))),
                           "body \"droplet\": motion makes it jump by 1 m at t = "));
    }
}

TEST(Paths, FindsTheShortestExcursionAtATimeThatIsNamed) {
    const auto pulse = [](double t) { return t > 0.00123 && t < 0.0012300001 ? 1.0 : 0.0; };
    EXPECT_EQ(refusal(one_ball(along_z(pulse)), {0.00123, 0.0012300001}),
              "body \"droplet\": motion makes it jump by 1 m at t = 1.23 ms; a path must not leap");
}

TEST(Paths, NoPeriodHidesInThatOfTheLooks) {
    // At the ends of all steps, and of all their 64ths, the body is where it began.
    for (int periods : {10, 640, 1280}) {
        const auto swing = [=](double t) { return 6 * std::sin(2 * std::numbers::pi * periods * t / end); };
        EXPECT_TRUE(
            begins(refusal(one_ball(along_z(swing))), "body \"droplet\": motion takes it out of the box"))
            << periods;
    }
}

TEST(Paths, NamesABodyThatIsTooFastToFollow) {
    const auto trembles = [](double t) { return 0.5 * std::sin(2e8 * t); };
    Domain domain = one_ball(along_z(trembles));
    domain.bodies.push_back(body("still", ball({0, 0, 5}, 1)));
    EXPECT_EQ(look(domain).too_fast, std::vector<std::size_t>{0});
    EXPECT_TRUE(look(one_ball(along_z([](double t) { return 1.5 * std::sin(1e4 * t); }))).too_fast.empty());
}

TEST(Paths, FindsTheLeastGapAndItsTime) {
    // Two balls pass each other at 0.14, and one comes down to 0.02 above the floor.
    Domain domain = one_ball([](double t) { return Pose{{-1.07, 0, -400 * t}, {}}; });
    domain.bodies.push_back(body("b", ball({1.07, 0, 9}, 1)));
    domain.bodies.push_back(body("c", ball({0, -2, 3}, 1)));
    domain.bodies[2].motion =
        along_z([](double t) { return -1.98 + 2e5 * (t - 0.0071234) * (t - 0.0071234); });
    const PathLook found = look(domain);
    ASSERT_EQ(found.closest.size(), 2U);
    const Approach &floor = found.closest[0], &pair = found.closest[1];
    EXPECT_EQ(in_words(domain, floor), "body \"c\" is 0.02 m from the wall z min");
    EXPECT_NEAR(floor.gap, 0.02, 1e-12);
    EXPECT_NEAR(floor.time, 0.0071234, 1e-9);
    EXPECT_EQ(in_words(domain, pair), "body \"droplet\" and body \"b\" are 0.14 m apart");
    EXPECT_NEAR(pair.gap, 0.14, 1e-12);
    EXPECT_NEAR(pair.time, end, 1e-8);
    EXPECT_EQ(look(domain, 0.03).closest.size(), 1U);
}

TEST(Paths, ASweepFindsAllPairsThatAreNear) {
    Random random{2};
    std::size_t pairs = 0;
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE("round " + std::to_string(round) + " of seed 2");
        std::vector<Bounds> held;
        for (int i = 0; i < 30; ++i) {
            const Vec3 x = random_vector(random, 4);
            held.push_back({x, x + Vec3{random.uniform(), random.uniform(), random.uniform()}});
        }
        std::vector<std::pair<std::size_t, std::size_t>> expected, found = pairs_within(held, 0.3);
        for (std::size_t a = 0; a < held.size(); ++a)
            for (std::size_t b = a + 1; b < held.size(); ++b) {
                bool near = true;
                for (int axis = 0; axis < 3; ++axis)
                    near = near && held[a].min[axis] <= held[b].max[axis] + 0.3 &&
                           held[b].min[axis] <= held[a].max[axis] + 0.3;
                if (near) expected.emplace_back(a, b);
            }
        std::ranges::sort(found);
        EXPECT_EQ(found, expected);
        pairs += expected.size();
    }
    EXPECT_GT(pairs, 50U);
}

TEST(Words, TimesAreInTheUnitThatIsEasyToRead) {
    EXPECT_EQ(time_words(0.0012), "1.2 ms");
    EXPECT_EQ(time_words(0), "0 s");
    EXPECT_EQ(time_words(12.5), "12.5 s");
    EXPECT_EQ(time_words(1e-3 * (1 - 1e-12)), "1 ms");
    EXPECT_EQ(time_words(3.25e-8), "32.5 ns");
    EXPECT_EQ(time_words(1e-12), "1e-12 s");
    EXPECT_EQ(time_words(3e9), "3e+09 s");
}

TEST(Words, AdviceIsRoundedDownToTwoDigits) {
    EXPECT_EQ(rounded_down(0.0625), 0.062);
    EXPECT_EQ(rounded_down(1e-5), 1e-5);
    EXPECT_EQ(rounded_down(0.16), 0.16);
    EXPECT_EQ(rounded_down(9.99e-13), 9.9e-13);
}
