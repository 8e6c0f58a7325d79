// Liquid bodies: their keys, and runs of them.
#include "case/case.h"
#include "case/case_text.h"
#include "run_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace kropla {
namespace {

constexpr std::string_view drop_case = R"toml([domain]
min = [-2.5, -2.5, -2.5]
max = [2.5, 2.5, 2.5]
[[body]]
name = "drop"
shape = "ellipsoid"
centre = [0.0, 0.0, 0.0]
axes = [0.9535, 0.9535, 1.1]
[body.motion]
kind = "flow"
[size]
surface = 0.4
growth = 0.5
far = 1.5
[time]
end = 0.4
steps = 4
[flow]
[flow.region.surroundings]
density = 0.1
viscosity = 0.002
[flow.region.drop]
density = 1
viscosity = 0.02
[flow.surface.drop]
tension = 1
)toml";

TEST(CaseLiquid, IsReadAndWrittenAgain) {
    const Case given = parse_case(std::string(drop_case), "case.toml");
    EXPECT_TRUE(given.domain.bodies[0].keeps_volume);
    ASSERT_TRUE(given.flow->options.regions[1]);
    EXPECT_EQ(given.flow->options.tension.at(0)->operator()(0), 1);
    const std::string written = to_toml(given);
    EXPECT_EQ(to_toml(parse_case(written, "again.toml")), written);
    EXPECT_NE(written.find("[flow.surface.\"drop\"]\ntension = 1"), std::string::npos) << written;
}

TEST(CaseLiquid, RefusalsNameKeyAndLine) {
    const auto refused = [](std::string_view from, std::string_view to) { return refusal(replaced(drop_case, from, to)); };
    EXPECT_EQ(refused("kind = \"flow\"", "kind = \"path\""),
              "case.toml: flow.region.drop (line 22): is of a liquid, and the body is solid: give it motion.kind = \"flow\", or "
              "leave this out");
    EXPECT_EQ(refused("[flow.region.drop]\ndensity = 1\nviscosity = 0.02\n", ""),
              "case.toml: flow.region (line 19): must have drop, which goes with the flow (motion.kind = \"flow\"): its density "
              "[kg/m^3] and viscosity [Pa s]");
    EXPECT_EQ(refused("tension = 1", "tension = -1"), "case.toml: flow.surface.drop.tension (line 26): must be positive, got -1");
}

TEST(RunLiquid, RingsAndKeepsItsVolume) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(drop_case));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    const auto number = [&](const char* name, std::size_t step) { return std::stod(columns.at(name).at(step)); };
    EXPECT_NEAR(number("volume_drop", 3) / number("volume_drop", 0), 1, 1e-13);
    EXPECT_LT(number("area_drop", 3), number("area_drop", 0)) << "tension makes it round";
    EXPECT_GT(number("kinetic_energy", 3), number("kinetic_energy", 0)) << "by making it flow";
    for (const std::string& r : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(r), 5.5);
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
}

TEST(RunLiquid, RingsWithLayersOnEachSide) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(drop_case, "[size]", "[body.layer]\ncount = 2\nfirst_height = 0.05\nside = \"both\"\n[size]"));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d --test-rollback").code, 0);
    const auto columns = lasting_columns(folder.path / "d");
    const auto number = [&](const char* name, std::size_t step) { return std::stod(columns.at(name).at(step)); };
    EXPECT_NEAR(number("volume_drop", 3) / number("volume_drop", 0), 1, 1e-13);
    EXPECT_LT(number("area_drop", 3), number("area_drop", 0));
    EXPECT_EQ(number("prisms", 3), number("prisms", 0));
    for (const std::string& r : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(r), 5.5);
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
}

TEST(RunLiquid, GoesOnAsIfItHadNotStoppedOrBeenTakenBack) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(drop_case));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out whole --test-rollback").code, 0);
    write(folder.path / "a.toml", replaced(replaced(drop_case, "end = 0.4", "end = 0.2"), "steps = 4", "steps = 2"));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    write(folder.path / "a.toml", std::string(drop_case));
    const Outcome rest = kropla_program(folder, "run a.toml --out d --resume");
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(frames(folder.path / "d").at("00004.vtu"), frames(folder.path / "whole").at("00004.vtu"));
}

/// A drop that sits on a floor, half a ball.
std::string sessile_case(std::string_view contact, std::string_view floor) {
    return R"toml([domain]
min = [-2.5, -2.5, 0]
max = [2.5, 2.5, 2.5]
[[body]]
name = "drop"
shape = "sphere"
centre = [0, 0, 0]
radius = 1
cut = true
[body.motion]
kind = "flow"
[size]
surface = 0.35
growth = 0.5
far = 1.5
[time]
end = 1
steps = 10
[flow]
[flow.region.surroundings]
density = 0.1
viscosity = 0.03
[flow.region.drop]
density = 1
viscosity = 0.3
[flow.surface.drop]
tension = 1
contact = )toml" + std::string(contact) + "\n[flow.face]\nz_min = " + std::string(floor) + "\n";
}

TEST(CaseLiquid, OnAFloorIsReadAndWrittenAgain) {
    for (const auto& [contact, floor] : {std::pair{"60", "\"slip\""}, std::pair{"\"pinned\"", "\"wall\""},
                                         std::pair{"{ z_min = 60 }", "\"slip\""}}) {
        const Case given = parse_case(sessile_case(contact, floor), "case.toml");
        const auto& angle = given.flow->options.contact.at(0).at(4);
        EXPECT_EQ(angle.has_value(), given.flow->options.faces[4].kind == FlowFace::Kind::slip);
        EXPECT_EQ(angle.value_or(60), 60);
        EXPECT_EQ((given.domain.bodies[0].pinned >> 4 & 1u) != 0, !angle.has_value());
        const std::string written = to_toml(given);
        EXPECT_EQ(to_toml(parse_case(written, "again.toml")), written);
        EXPECT_NE(written.find(std::string("contact = ") + contact), std::string::npos) << written;
        EXPECT_NE(written.find("radius = 1\ncut = true"), std::string::npos) << written;
    }
}

TEST(CaseLiquid, RefusesLinesThatCannotMove) {
    EXPECT_EQ(refusal(sessile_case("60", "\"wall\"")),
              "case.toml: flow.surface.drop.contact (line 28): has the line move along z_min, where a wall without slip holds it: "
              "give it flow.face.z_min = \"slip\", or pin it");
    EXPECT_EQ(refusal(sessile_case("180", "\"slip\"")),
              "case.toml: flow.surface.drop.contact (line 28): must be \"pinned\", or an angle in the liquid between 0 and 180 "
              "degrees, got 180");
    EXPECT_EQ(refusal(sessile_case("{ x_min = 60 }", "\"slip\"")),
              "case.toml: flow.surface.drop.contact.x_min (line 28): is a face through which the body does not reach");
    EXPECT_EQ(refusal(sessile_case("60", "{ pressure = 0 }")),
              "case.toml: flow.face.z_min (line 30): must be \"wall\" or \"slip\": liquid body drop reaches through it");
    EXPECT_EQ(refusal(replaced(drop_case, "tension = 1", "tension = 1\ncontact = 60")),
              "case.toml: flow.surface.drop.contact (line 27): is how a surface ends on faces of the box, and this body is wholly "
              "in it");
}

TEST(RunLiquid, SpreadsOnAFloorThatItWets) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", sessile_case("60", "\"slip\""));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    const auto number = [&](const char* name, std::size_t step) { return std::stod(columns.at(name).at(step)); };
    EXPECT_NEAR(number("volume_drop", 9) / number("volume_drop", 0), 1, 1e-13);
    EXPECT_GT(number("wetted_drop", 9), 1.1 * number("wetted_drop", 0));
    EXPECT_LT(number("surface_energy", 9), number("surface_energy", 0));
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
}

TEST(RunLiquid, SagsOnALineThatIsPinned) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", sessile_case("\"pinned\"", "\"wall\""));
    const Outcome ended = kropla_program(folder, "run a.toml --out d --set flow.gravity=[0,0,-1]");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    const auto number = [&](const char* name, std::size_t step) { return std::stod(columns.at(name).at(step)); };
    EXPECT_NEAR(number("volume_drop", 9) / number("volume_drop", 0), 1, 1e-13);
    EXPECT_NEAR(number("wetted_drop", 9) / number("wetted_drop", 0), 1, 1e-13);
    EXPECT_LT(number("z_drop", 9), 0.99 * number("z_drop", 0));
    EXPECT_GT(number("area_drop", 9), number("area_drop", 0)) << "what gravity gives to the tension";
}

}  // namespace
}  // namespace kropla
