// Bodies that deform: their keys, and runs of them.
#include "case/case.h"
#include "case/case_text.h"
#include "run_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace kropla {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view drop_case = R"toml([domain]
min = [0.0, 0.0, 0.0]
max = [1.0, 1.0, 1.0]
[[body]]
name = "drop"
shape = "sphere"
centre = [0.5, 0.5, 0.5]
radius = 0.2
[body.motion]
kind = "field"
velocity = ["0.5*sin(pi*x)*cos(pi*y)", "-0.5*cos(pi*x)*sin(pi*y)", 0]
[size]
surface = 0.08
growth = 0.3
far = 0.2
[time]
end = 0.6
steps = 4
)toml";

TEST(CaseDeforming, AVelocityTakesPlacesAlong) {
    const Case given = parse_case(replaced(drop_case, "[\"0.5*sin(pi*x)*cos(pi*y)\", \"-0.5*cos(pi*x)*sin(pi*y)\", 0]",
                                        "[\"-y\", \"x\", \"t\"]"), "case.toml");
    const Deformation& deformation = given.domain.bodies[0].deformation;
    ASSERT_TRUE(deformation);
    const Vec3 there = deformation({2, 0, 1}, 0.1, 0.5);  // turned, by the classical method to the fourth power
    EXPECT_NEAR(there.x, 2 * std::cos(0.4), 2e-5);
    EXPECT_NEAR(there.y, 2 * std::sin(0.4), 2e-5);
    EXPECT_NEAR(there.z, 1 + (0.25 - 0.01) / 2, 1e-15);
    const Vec3 here = deformation(there, 0.5, 0.1);
    EXPECT_LE(distance(here, {2, 0, 1}), 4e-6);
}

TEST(CaseDeforming, IsWrittenAsItWasRead) {
    const Case given = parse_case(std::string(drop_case), "case.toml");
    const std::string written = to_toml(given);
    EXPECT_EQ(to_toml(parse_case(written, "again.toml")), written);
    EXPECT_NE(written.find("kind = \"field\""), std::string::npos);
}

TEST(CaseDeforming, RefusalsNameKeyAndLine) {
    const auto refused = [](std::string_view from, std::string_view to) { return refusal(replaced(drop_case, from, to)); };
    EXPECT_EQ(refused("velocity", "speed"),
              "case.toml: body[0].motion.speed (line 11): unknown key; known here: kind, velocity");
    EXPECT_EQ(refused("\"-0.5*cos(pi*x)*sin(pi*y)\", 0]", "0]").substr(0, 43),
              "case.toml: body[0].motion.velocity (line 11");
    EXPECT_EQ(refused("\"field\"", "\"fields\""), "case.toml: body[0].motion.kind (line 10): must be \"path\", \"field\", "
                                                 "\"free\" or \"flow\", got \"fields\"");
    EXPECT_EQ(refused("[time]", "[quality]\nmethod = \"paper\"\n[time]"),
              "case.toml: quality.method (line 17): \"paper\" moves rigid bodies; body \"drop\" deforms");
}

TEST(RunDeforming, KeepsTheVolumeOfAFlowThatDoes) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(drop_case));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    const auto& volumes = columns.at("volume_drop");
    ASSERT_EQ(volumes.size(), 4u);
    for (const std::string& v : volumes) EXPECT_NEAR(std::stod(v), 4.0 / 3 * std::numbers::pi * 0.008, 1.1e-5 * 0.0335);
    for (const std::string& r : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(r), 5.5);
    EXPECT_EQ(kropla_program(folder, "check d").code, 0);
}

// The gas, which is not solved for, makes way. That what is in the drop goes with it is asked in told_flow_test.cpp.
TEST(RunDeforming, CarriesHeatAndSpecies) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(drop_case) + R"toml([heat.region.surroundings]
density = 1
specific_heat = 1000
conductivity = 1
initial = 300
[heat.region.drop]
density = 10
specific_heat = 800
conductivity = 1e-3
initial = "300 + 500*x"
[[species]]
name = "dye"
[species.region.drop]
diffusivity = 1e-6
initial = "x"
)toml");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    double dye = 0, by_volume = 0;
    for (std::size_t step = 0; step < 4; ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        EXPECT_NEAR(number("energy_error"), 0, 1e-12 * number("energy_integral"));
        EXPECT_NEAR(number("heat_by_volume") * number("dt"), 0, 4.4e-7 * number("energy_integral")) << "by facets alone";
        by_volume += number("dye_by_volume");
        EXPECT_NEAR(number("dye_error"), 0, 1e-12 * number("dye_integral"));
        if (step > 0) {
            EXPECT_NEAR(number("dye_integral") - by_volume, dye, 1e-12 * dye);
        }
        dye = number("dye_integral") - by_volume;
        EXPECT_GE(number("temperature_min_drop"), 300 - 1e-9);
        EXPECT_LE(number("temperature_max_drop"), 650 + 1e-9);
    }
}

// A ball in a box of liquid that swells pushes it out through the face that is open; and it turns.
TEST(RunDeforming, PushesTheFlow) {
    const TemporaryFolder folder;
    const std::string swells = replaced(drop_case, "[\"0.5*sin(pi*x)*cos(pi*y)\", \"-0.5*cos(pi*x)*sin(pi*y)\", 0]",
                                        "[\"0.3*(x-0.5) - 0.8*(y-0.5)\", \"0.3*(y-0.5) + 0.8*(x-0.5)\", \"0.3*(z-0.5)\"]");
    write(folder.path / "a.toml", swells + "[flow]\nconvection = false\n[flow.region.surroundings]\ndensity = 1\nviscosity = 1\n"
                                           "[flow.face]\nz_max = { pressure = 0 }\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto columns = lasting_columns(folder.path / "d");
    for (std::size_t step = 0; step < 4; ++step) {
        const auto number = [&](const std::string& name) { return std::stod(columns.at(name)[step]); };
        EXPECT_NEAR(number("volume_out_z_max"), 0.9 * number("volume_drop"), 1e-8);
        EXPECT_NEAR(number("spin_z_drop"), 0.8, 1.2e-8);
        EXPECT_GT(number("force_z_drop"), 0) << "towards the face that is open";
        EXPECT_LE(number("max_aspect_ratio"), 6);
    }
}

// Stopped at a time that has a checkpoint, and gone on with a later end: the same mesh as in one go, bit for bit.
TEST(RunDeforming, GoesOnAsIfItHadNotStopped) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(drop_case));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out whole").code, 0);
    write(folder.path / "a.toml", replaced(replaced(drop_case, "end = 0.6", "end = 0.3"), "steps = 4", "steps = 2"));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    write(folder.path / "a.toml", std::string(drop_case));
    const Outcome rest = kropla_program(folder, "run a.toml --out d --resume");
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(frames(folder.path / "d").at("00004.vtu"), frames(folder.path / "whole").at("00004.vtu"));
}

TEST(RunDeforming, AVelocityThatIsNoNumberEndsTheRunByItsName) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(drop_case, "sin(pi*y)\", 0]", "sin(pi*y)\", \"sqrt(0.4 - t)\"]"));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 2);
    EXPECT_NE(ended.err.find("a.toml: body[0].motion.velocity: is not a number at ("), std::string::npos) << ended.err;
    EXPECT_TRUE(fs::exists(folder.path / "d/report.html"));
}

// In a closed box of liquid a body may deform, and also come to a stop: then what its facets let in is rounding.
TEST(RunDeforming, StopsInAClosedBox) {
    const TemporaryFolder folder;
    const std::string stops = replaced(drop_case, "[\"0.5*sin(pi*x)*cos(pi*y)\", \"-0.5*cos(pi*x)*sin(pi*y)\", 0]",
                                       "[\"0.3*(x-0.5)*max(0, 1 - t/0.3)\", \"-0.3*(y-0.5)*max(0, 1 - t/0.3)\", 0]");
    write(folder.path / "a.toml", stops + "[flow.region.surroundings]\ndensity = 1\nviscosity = 1\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::string bends = replaced(drop_case, "0.5*sin(pi*x)*cos(pi*y)", "0.5*sin(pi*x)*cos(pi*y) + 0.1*sin(9*z)");
    write(folder.path / "b.toml", bends + "[flow.region.surroundings]\ndensity = 1\nviscosity = 1\n");
    const Outcome again = kropla_program(folder, "run b.toml --out e");
    ASSERT_EQ(again.code, 0) << again.err;
    for (const char* run : {"d", "e"})
        for (const std::string& error : lasting_columns(folder.path / run).at("mass_error_surroundings"))
            EXPECT_NEAR(std::strtod(error.c_str(), nullptr), 0, 1e-13) << run;
}

}  // namespace
}  // namespace kropla
