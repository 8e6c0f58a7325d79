// Liquid bodies: their keys, and runs of them.
#include "app/case.h"
#include "case_text.h"
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
    const Case it = parse_case(std::string(drop_case), "case.toml");
    EXPECT_TRUE(it.domain.bodies[0].keeps_volume);
    ASSERT_TRUE(it.flow->options.regions[1]);
    EXPECT_EQ(it.flow->options.tension.at(0)->operator()(0), 1);
    const std::string written = to_toml(it);
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
    const Outcome it = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(it.code, 0) << it.err;
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

}  // namespace
}  // namespace kropla
