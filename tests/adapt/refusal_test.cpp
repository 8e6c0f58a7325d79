#include "adapt/cases.h"
#include <kropla/adapt/attempt.h>
#include "domain/approach.h"

#include <gtest/gtest.h>

using namespace kropla;

namespace {

/// The sphere of `sphere_in_box`, radius 0.6, falls by 1.4 within 1 s and stops 0.02 above the floor of the
/// box.
Domain landing_sphere() {
    Domain domain = sphere_in_box();
    domain.bodies[0].motion = [](double t) { return Pose{{0, 0, -1.38 * t}, {}}; };
    return domain;
}

/// An attempt from 0 up to `t`.
std::optional<Refusal> attempt(MovingMesh& moving, double t) {
    return move_bodies(Attempt(moving), t).refusal();
}

void expect_words(const std::string& text, std::initializer_list<const char*> words) {
    for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
}

}  // namespace

TEST(Refusal, OfANarrowGapSaysWhatIsNearWhatAndTheSizeThatWouldDo) {
    const Domain domain = landing_sphere();
    const Refusal said =
        explained(domain, {"would have R/r 10.1, limit 10", Tet(7), {0.01, 0, -1.99}, 0.9, 1, 10}, 0.05);
    EXPECT_EQ(
        said.why,
        "at t = 1 s body \"sphere\" is 0.02 m from the wall z min, 0.0571 of size.surface = 0.35 m: too "
        "narrow for the mesh; at most 0.088 m would do (cell 7 at (0.01, 0, -1.99) m would have R/r "
        "10.1, limit 10)");
    ASSERT_TRUE(said.near);
    EXPECT_EQ(said.near->wall, 4);
    EXPECT_NEAR(said.near->gap, 0.02, 1e-12);
    EXPECT_EQ(said.time, 1);
    EXPECT_EQ(said.advised_dt, 0.05);
    EXPECT_EQ(said.place, (Vec3{0.01, 0, -1.99}));
    EXPECT_EQ(said.limiting, Tet(7));
    EXPECT_TRUE(said.in_gap);
}

TEST(Refusal, WithoutAGapSaysWhatTouchesWhat) {
    const Domain domain = landing_sphere();
    const Refusal said = explained(domain, {"would be turned over", Tet(7), {0.01, 0, -1.99}, 1.1, 1.2, 10}, 0);
    expect_words(said.why, {"at t = 1.2 s body \"sphere\" touches the wall z min: no room is left for the mesh (cell 7"});
    EXPECT_TRUE(said.in_gap);
}

TEST(Refusal, ThatAdvisesASizeTakesNoGapForNarrowWithIt) {
    Domain domain = landing_sphere();
    domain.size.surface = 0.088;
    EXPECT_GE(0.02 - stand_out(domain, {.body = 0, .wall = 4}), doubtful_gap(10) * domain.size.surface);
}

TEST(Refusal, BetweenBodiesNamesBoth) {
    Domain domain = sphere_in_box();
    domain.bodies.push_back({"other", {{0, 0, 1.25}, {0.6, 0.6, 0.6}, {}}});
    const Refusal said = explained(domain, {"would be turned over", Tet(7), {0, 0, 0.63}, 0, 1, 10}, 0);
    expect_words(said.why, {"body \"sphere\" and body \"other\" are 0.05 m apart, 0.143 of size.surface"});
}

TEST(Refusal, OfAWideMotionSaysHowFarTheBodyGoes) {
    const Domain domain = landing_sphere();
    const Refusal said = explained(domain, {"would be turned over", Tet(7), {0.7, 0, 0}, 0, 0.5, 10}, 0.1);
    expect_words(said.why,
                 {"at t = 500 ms the mesh near body \"sphere\" does not follow it, which moves by 0.69 m, "
                  "1.97 of size.surface, within 500 ms",
                  "(cell 7 at (0.7, 0, 0) m would be turned over)"});
}

TEST(Refusal, OfAnAttemptIntoANarrowGapNamesTheGap) {
    const Domain domain = landing_sphere();
    MovingMesh moving(domain, improved_mesh(domain, 1), 0);
    const auto said = attempt(moving, 1);
    ASSERT_TRUE(said);
    expect_words(said->why, {"at t = 1 s ", "body \"sphere\"", "size.surface", "(cell "});
    EXPECT_GT(said->advised_dt, 0);
    EXPECT_LT(said->advised_dt, 1);
}

TEST(Refusal, TheTimeUntilAGapIsExact) {
    const Domain domain = landing_sphere();
    const Approach floor{0, 4, 0, 0, 0};
    EXPECT_NEAR(time_until_gap(domain, floor, 0, 1, 0.3), (1.4 - 0.3) / 1.38, 1e-12);
    EXPECT_NEAR(time_until_gap(domain, floor, 0.5, 1, 0.3), (1.4 - 0.3) / 1.38 - 0.5, 1e-12);
    EXPECT_EQ(time_until_gap(domain, floor, 0, 1, 0.01), 1);
    EXPECT_EQ(time_until_gap(domain, floor, 0.9, 1, 0.3), 0);
}

TEST(Refusal, OfALayersGapAdvisesTheLargestStep) {
    Domain domain = landing_sphere();
    domain.bodies[0].layer = LayerOptions{.count = 2, .first_height = 0.02, .growth = 1, .min_gap = 0.4};
    MovingMesh moving(domain, improved_mesh(domain, 1), 0);
    const auto said = attempt(moving, 0.9);
    ASSERT_TRUE(said);
    ASSERT_TRUE(said->near) << said->why;
    expect_words(said->why, {"at t = 900 ms body \"sphere\" is ", " m from the wall z min",
                             "less than layer.min_gap = 0.4 m"});
    EXPECT_NEAR(said->advised_dt, 1 / 1.38, 1e-12);  // from 1.4 to 0.4
    const auto names_gap = [&](double dt) {
        const auto refusal = attempt(moving, dt);
        return refusal && refusal->why.find("less than layer.min_gap") != std::string::npos;
    };
    EXPECT_TRUE(names_gap(1.01 * said->advised_dt));
    EXPECT_FALSE(names_gap(0.99 * said->advised_dt));  // it is far for one step: cells may be in its way, the gap is not
}
