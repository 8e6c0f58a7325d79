// Prism layers and rotations in a case file.
#include "case/case.h"
#include <kropla/base/error.h>
#include "domain/paths.h"
#include "case_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

namespace kropla {
namespace {

/// The full case with these lines for its second body.
Case with(std::string_view lines) {
    return parse_case(replaced(full_case, "rotation = [0, 1, 1, 30.0]\n", lines), "case.toml");
}

std::string refusal(std::string_view lines) {
    try {
        (void)with(lines);
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

LayerOptions layer_of(const Case& given) { return given.domain.bodies[1].layer.value(); }

TEST(LayerInCase, EveryKeyArrives) {
    const Case given = with("[body.layer]\ncount = 3\nfirst_height = 1e-5\ngrowth = 1.2\nside = \"both\"\nmin_gap = 4e-5\n");
    EXPECT_FALSE(given.domain.bodies[0].layer);
    EXPECT_EQ(layer_of(given).count, 3);
    EXPECT_EQ(layer_of(given).first_height, 1e-5);
    EXPECT_EQ(layer_of(given).growth, 1.2);
    EXPECT_EQ(layer_of(given).side, LayerOptions::Side::both);
    EXPECT_EQ(least_gap(layer_of(given)), 4e-5);
}

TEST(LayerInCase, WhatIsLeftOutHasItsDefault) {
    const LayerOptions layer = layer_of(with("[body.layer]\n"));
    EXPECT_EQ(layer.count, 4);
    EXPECT_EQ(layer.first_height, 2e-5);
    EXPECT_EQ(layer.growth, 1.3);
    EXPECT_EQ(layer.side, LayerOptions::Side::outside);
    EXPECT_FALSE(layer.min_gap);
}

TEST(LayerInCase, IsWrittenAsItIsRun) {
    for (const char* side : {"outside", "inside", "both"}) {
        const Case given = with("[body.layer]\ncount = 2\nside = \"" + std::string(side) + "\"\n");
        const std::string written = to_toml(given);
        SCOPED_TRACE(written);
        const Case again = parse_case(written, "written.toml");
        EXPECT_FALSE(again.domain.bodies[0].layer);
        EXPECT_EQ(layer_of(again).count, 2);
        EXPECT_EQ(layer_of(again).first_height, 2e-5);
        EXPECT_EQ(layer_of(again).growth, 1.3);
        EXPECT_EQ(layer_of(again).side, layer_of(given).side);
        EXPECT_EQ(least_gap(layer_of(again)), least_gap(layer_of(given)));
        EXPECT_EQ(to_toml(again), written);
    }
}

TEST(LayerInCase, WrongValuesAreRefused) {
    const auto layer = [](const std::string& line) { return refusal("[body.layer]\n" + line + "\n"); };
    const std::string place = "case.toml: body[1].layer.";
    const std::string fits = "; the largest layer that fits is 0.000762 m thick";  // a third of 2.3 mm, less 0.15 * 0.3^2
    EXPECT_EQ(layer("first_height = -2e-5"), place + "first_height (line 19): must be positive, got -2e-05" + fits);
    EXPECT_EQ(layer("count = 0"), place + "count (line 19): must be a whole number from 1 to 100, got 0");
    EXPECT_EQ(layer("count = 101"), place + "count (line 19): must be a whole number from 1 to 100, got 101");
    EXPECT_EQ(layer("growth = 0"), place + "growth (line 19): must be positive, got 0");
    EXPECT_EQ(layer("growth = nan"), place + "growth (line 19): must be a finite number, got nan");
    EXPECT_EQ(layer("min_gap = 0.0"), place + "min_gap (line 19): must be positive, got 0");
    EXPECT_EQ(layer("side = \"outer\""),
              place + "side (line 19): must be \"outside\", \"inside\" or \"both\", got \"outer\"");
    EXPECT_EQ(layer("height = 1"), place + "height (line 19): unknown key; known here: count, first_height, "
                                           "growth, side, min_gap");
    EXPECT_EQ(refusal("layer = 4\n"), "case.toml: body[1].layer (line 18): must be a table [body[1].layer], got 4");
}

TEST(LayerInCase, AGrowthThatOverflowsIsRefusedWithTheLargestThatWouldDo) {
    const std::string infinite = refusal("[body.layer]\ncount = 4\ngrowth = 1e300\n");
    EXPECT_EQ(infinite.substr(0, infinite.find(" at most")),
              "case.toml: body[1].layer.growth (line 20): 1e+300 makes a layer of 4 prisms inf m thick, more than the "
              "box; the largest layer that fits is 0.000762 m thick:");
    // sum of 2e-5 g^k, k = 0 ... 3, below 0.762 mm
    EXPECT_NEAR(std::stod(infinite.substr(infinite.find("at most ") + 8)), 2.94, 0.01);
    const std::string large = refusal("[body.layer]\ncount = 100\ngrowth = 1.5\n");
    const double advised = std::stod(large.substr(large.find("at most ") + 8));
    SCOPED_TRACE(large);
    const double room = (3.3e-3 - 1e-3 - 0.15 * 9e-8 / 1e-3) / 3;  // of the gap to the nearest face
    EXPECT_LE(thickness({.count = 100, .growth = advised}), room);
    EXPECT_GT(thickness({.count = 100, .growth = 1.01 * advised}), room);
    EXPECT_EQ(refusal("[body.layer]\ncount = 100\ngrowth = " + std::to_string(advised) + "\n"), "");
    EXPECT_EQ(refusal("[body.layer]\nfirst_height = 1\n"),
              "case.toml: body[1].layer.first_height (line 19): must be below the size of the box, 0.016 m, "
              "got 1; the largest layer that fits is 0.000762 m thick");
}

TEST(RotationInCase, TurnsTheBodyAboutItsCentre) {
    const Case given = with("[body.motion]\nz = \"t\"\nangle = \"90*t\"\naxis = [0, 0, 2]\n");
    const Pose pose = given.domain.bodies[1].motion(1);
    EXPECT_NEAR(norm(rotated(pose.rotation, {1, 0, 0}) - Vec3{0, 1, 0}), 0, 1e-15);
    EXPECT_TRUE(pose.displacement == Vec3(0, 0, 1));
    const Shape turned = shape_at(given.domain.bodies[1], 1);
    EXPECT_NEAR(norm(turned.centre - Vec3{0, 0, 1.003}), 0, 1e-15);
    EXPECT_NEAR(norm(rotated(turned.orientation, {1, 0, 0}) - Vec3{0, 1, 0}), 0, 1e-15);
    const Pose at_start = given.domain.bodies[1].motion(0);
    EXPECT_TRUE(rotated(at_start.rotation, {1, 2, 3}) == Vec3(1, 2, 3));
}

TEST(RotationInCase, TheAxisMayBeOfExpressionsAndIsWrittenAsItStands) {
    const Case given = with("[body.motion]\nangle = 30\naxis = [\"cos(t)\", 0.5, \"t\"]\n");
    const std::string written = to_toml(given);
    SCOPED_TRACE(written);
    EXPECT_NE(written.find("angle = 30\naxis = [\"cos(t)\", 0.5, \"t\"]\n"), std::string::npos);
    const Case again = parse_case(written, "written.toml");
    EXPECT_EQ(to_toml(again), written);
    const Rotation expected = rotation_about({std::cos(0.7), 0.5, 0.7}, 30 * std::numbers::pi / 180);
    for (const Case* one : {&given, &again})
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_TRUE(one->domain.bodies[1].motion(0.7).rotation.axes[i] == expected.axes[i]);
}

TEST(RotationInCase, WrongValuesAreRefused) {
    const auto motion = [](const std::string& lines) { return refusal("[body.motion]\n" + lines + "\n"); };
    const std::string place = "case.toml: body[1].motion.";
    EXPECT_EQ(motion("angle = 3"),
              place + "axis (line 18): is missing; it must be 3 finite numbers or expressions in quotes [x, y, z]");
    EXPECT_EQ(motion("axis = [1, 0, 0]"),
              place + "angle (line 18): is missing; it must be a finite number or an expression in quotes");
    EXPECT_EQ(motion("angle = 3\naxis = [0, 0, \"t\"]"),
              place + "axis (line 20): must not be zero at t = 0, got [0, 0, \"t\"]");
    EXPECT_EQ(motion("angle = 3\naxis = [0, 1]"),
              place + "axis (line 20): must be 3 finite numbers or expressions in quotes [x, y, z], got [0, 1]");
    EXPECT_EQ(motion("angle = 3\naxis = [0, 1, \"u\"]"),
              place + "axis (line 20): \"u\": \"u\" at character 1 is not known; known are t, pi and functions such "
                      "as sin, exp, sqrt");
}

TEST(RotationInCase, AnAxisThatVanishesOnTheWayIsFound) {
    const Case given = with("[body.motion]\nangle = 3\naxis = [\"0.005-t\", 0, 0]\n");
    const auto look_until = [&](double end) {
        return look_at_paths(given.domain, {.start = 0, .end = end, .steps = 10, .also_at = {}}).closest.size();
    };
    EXPECT_THROW((void)look_until(0.005), DomainError);
    EXPECT_EQ(look_until(0.0049), 0U);
}

}  // namespace
}  // namespace kropla
