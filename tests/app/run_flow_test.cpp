// What a run does of flow: bodies that fall in it, gas that passes through the box and carries heat.
#include "run_results.h"
#include <kropla/io/checkpoint.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace kropla {
namespace {

const std::string box = "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1.5]\n[size]\nsurface = 0.12\nfar = 0.3\n";
const std::string ball = "[[body]]\nname = \"ball\"\nshape = \"sphere\"\ncentre = [0.5, 0.5, 0.9]\nradius = 0.15\n";

std::string falling(double end, int steps, const std::string& motion = "density = 3\n") {
    return box + "[time]\nend = " + std::to_string(end) + "\nsteps = " + std::to_string(steps) + "\n" + ball +
           "[body.motion]\nkind = \"free\"\n" + motion +
           "[flow]\ngravity = [0, 0, -1]\n[flow.region.surroundings]\ndensity = 1\nviscosity = 0.05\n";
}

/// Gas goes down around a ball that goes up, and warms it.
const std::string blown = box + "[time]\nend = 0.4\nsteps = 4\n" + ball + "[body.motion]\nz = \"0.1*t\"\n" +
                          "[flow.region.surroundings]\ndensity = 1\nviscosity = 0.05\n[flow.face]\n"
                          "z_max = { velocity = [0, 0, \"-16*x*(1-x)*y*(1-y)\"] }\nz_min = { pressure = 0 }\n"
                          "x_min = \"slip\"\n"
                          "[heat.region.surroundings]\nconductivity = 0.01\ndensity = 1\nspecific_heat = 1\ninitial = 300\n"
                          "[heat.region.ball]\nconductivity = 1\ndensity = 5\nspecific_heat = 1\ninitial = 300\n"
                          "[heat.face]\nz_max = { value = 1000 }\n"
                          "[[species]]\nname = \"smoke\"\n[species.region.surroundings]\ndiffusivity = 0.001\ninitial = 0\n"
                          "[species.face]\nz_max = { value = 2 }\n";

TEST(RunFlow, ABallFallsAndGoesOnBitByBit) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", falling(0.8, 4));
    write(folder.path / "half.toml", falling(0.4, 2));
    const Outcome ended = kropla_program(folder, "run a.toml --out whole");
    ASSERT_EQ(ended.code, 0) << ended.err;
    ASSERT_EQ(kropla_program(folder, "run half.toml --out d").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    EXPECT_EQ(lasting_columns(folder.path / "d"), lasting_columns(folder.path / "whole"));
    EXPECT_EQ(contents(folder.path / "d/frames/00004.vtu"), contents(folder.path / "whole/frames/00004.vtu"));

    const Table steps = read_table(folder.path / "whole/steps.csv");
    const double volume = numbers(steps, "volume_ball").back();
    EXPECT_LT(numbers(steps, "z_ball").back(), 0.9 - 0.02);
    for (const double w : numbers(steps, "w_ball")) EXPECT_LT(w, 0);
    // By the law of motion, with the force at the end of each step.
    const std::vector<double> force = numbers(steps, "force_z_ball"), dt = numbers(steps, "dt");
    double velocity = 0, gone = 0;
    for (std::size_t n = 0; n < force.size(); ++n) {
        const double rate = force[n] / (3 * volume) - 1;
        gone += dt[n] * velocity + 0.5 * dt[n] * dt[n] * rate;
        velocity += dt[n] * rate;
    }
    EXPECT_NEAR(numbers(steps, "z_ball").back() - numbers(steps, "z_ball").front(),
                gone - numbers(steps, "w_ball").front() * dt.front(), 1e-4);
    for (const double lost : numbers(steps, "mass_error_surroundings")) EXPECT_NEAR(lost, 0, 1e-12);
}

// The pressure of what rests is there from the start, around a body too, so nothing has to be found.
TEST(RunFlow, WhatRestsUnderGravityRests) {
    const TemporaryFolder folder;
    std::string text = falling(0.8, 2);
    text.erase(text.find("[body.motion]"), text.find("[flow]") - text.find("[body.motion]"));
    write(folder.path / "a.toml", text);
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    const double weight = numbers(steps, "volume_ball").back();
    for (const double energy : numbers(steps, "kinetic_energy")) EXPECT_LE(energy, 1e-28);
    for (const double force : numbers(steps, "force_z_ball")) EXPECT_NEAR(force, weight, 1e-12 * weight) << "that of Archimedes";
}

TEST(RunFlow, WhatIsHeldStaysAndSpinsGoOn) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", falling(0.2, 2, "density = 3\nspin = [0, 0, 2]\nhold = [\"x\", \"y\", \"turn_x\"]\n"));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    EXPECT_NEAR(numbers(steps, "x_ball").back(), numbers(steps, "x_ball").front(), 1e-12);
    EXPECT_EQ(numbers(steps, "spin_x_ball").back(), 0);
    EXPECT_GT(numbers(steps, "spin_z_ball").back(), 0.2);
    EXPECT_LT(numbers(steps, "spin_z_ball").back(), 2);
    EXPECT_LT(numbers(steps, "torque_z_ball").back(), 0);
}

TEST(RunFlow, ABallLandsAndRestsBitByBit) {
    const TemporaryFolder folder;
    const std::string near = replaced(ball, "0.9]", "0.22]");
    const auto landing = [&](double end, int steps) {
        return replaced(falling(end, steps), ball, near) + "[contact]\n";
    };
    write(folder.path / "a.toml", landing(1.2, 8));
    write(folder.path / "part.toml", landing(0.9, 6));  // until it touches
    const Outcome ended = kropla_program(folder, "run a.toml --out whole");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find("warning: body \"ball\" touches the wall z min at ("), std::string::npos) << ended.out;
    ASSERT_EQ(kropla_program(folder, "run part.toml --out d").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    EXPECT_EQ(lasting_columns(folder.path / "d"), lasting_columns(folder.path / "whole"));

    const Table steps = read_table(folder.path / "whole/steps.csv");
    const std::vector<double> gap = numbers(steps, "gap_ball"), force = numbers(steps, "contact_force_z_ball"),
                              contacts = numbers(steps, "contacts"), w = numbers(steps, "w_ball");
    const double allowed = parse_case(landing(1.2, 8), "a.toml").contact->gap;
    for (std::size_t n = 0; n < gap.size(); ++n) EXPECT_GE(gap[n], allowed * (1 - 1e-6));
    EXPECT_EQ(contacts.front(), 0);
    EXPECT_EQ(contacts.back(), 1);
    EXPECT_NEAR(gap.back(), allowed, 1e-6 * allowed);
    EXPECT_NEAR(w.back(), 0, 1e-7);
    EXPECT_GT(force[gap.size() - 4], 0);  // of lubrication alone
    // At rest the floor carries what the flow does not, which comes to rest too.
    const double weight = 3 * numbers(steps, "volume_ball").back();
    EXPECT_NEAR(force.back() + numbers(steps, "force_z_ball").back(), weight, 1e-3 * weight);
}

/// The drag of a sphere on its slow way to a wall, by that in an unbounded liquid; `gap` is by its radius [Brenner 1961].
double drag_at_wall(double gap) {
    const double alpha = std::acosh(1 + gap);
    double sum = 0;
    for (int n = 1; n * alpha < 30; ++n) {
        const double above = 2 * std::sinh((2 * n + 1) * alpha) + (2 * n + 1) * std::sinh(2 * alpha);
        const double below = 4 * std::pow(std::sinh((n + 0.5) * alpha), 2) - std::pow((2 * n + 1) * std::sinh(alpha), 2);
        sum += n * (n + 1.0) / ((2 * n - 1) * (2 * n + 3)) * (above / below - 1);
    }
    return 4.0 / 3 * std::sinh(alpha) * sum;
}

TEST(RunFlow, ASphereNearsTheFloorAsLubricationLetsIt) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml",
          "[domain]\nmin = [-12, -12, 0]\nmax = [12, 12, 16]\n[size]\nsurface = 0.4\ngrowth = 0.3\nfar = 4\n[time]\nend = 25\n"
          "steps = 5\n[[body]]\nname = \"ball\"\nshape = \"sphere\"\ncentre = [0, 0, 1.155]\nradius = 1\n[body.motion]\n"
          "kind = \"free\"\ndensity = 2\n[flow]\ngravity = [0, 0, -0.045]\nconvection = false\n"
          "[flow.region.surroundings]\ndensity = 1\nviscosity = 2\n[contact]\n");
    const auto speed_by_known = [&](const std::string& set) {
        const Outcome ended = kropla_program(folder, "run a.toml --out d --force " + set);
        EXPECT_EQ(ended.code, 0) << ended.err;
        const Table steps = read_table(folder.path / "d/steps.csv");
        const double speed = -numbers(steps, "w_ball").back(), pi = std::acos(-1.0);
        const double gap = numbers(steps, "gap_ball").back() + 0.5 * numbers(steps, "dt").back() * speed;  // half-way
        const double weight = 4.0 / 3 * pi * 0.045;  // less buoyancy
        return speed / (weight / (6 * pi * 2 * drag_at_wall(gap)));
    };
    EXPECT_NEAR(speed_by_known(""), 1.03, 0.05);  // on so coarse a mesh
    EXPECT_GT(speed_by_known("--set contact.lubrication=false"), 1.2);
}

TEST(RunFlow, ABodyMayNotBeginNearerThanItMayCome) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(falling(1, 5), "0.9]", "0.2]") + "[contact]\ngap = 0.055\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 2);
    expect_one_line(ended.err, "body \"ball\" begins 0.05 m from what is nearest to it, less than contact.gap = 0.055 m");
}

/// In all steps, to this much [kg].
void expect_mass_kept(const Table& steps, double bound) {
    double largest = 0;
    for (const double missed : numbers(steps, "mass_error_surroundings")) largest = std::max(largest, std::abs(missed));
    testing::Test::RecordProperty("mass_error", std::to_string(1e18 * largest) + " fg");
    EXPECT_LT(largest, bound);
}

/// Between what is cold at the start and what comes in hot, at the end of the run in `d`.
void expect_temperatures_kept(const TemporaryFolder& folder) {
    const Checkpoint last = read_checkpoint(folder.path / "d/checkpoint.h5");
    for (Tet t : last.mesh.tets.indices()) {
        if (!alive(last.mesh, t)) continue;
        for (Vertex v : last.mesh.tets[t]) {
            EXPECT_GE(last.fields[0].values[v], 300 - 1e-7);
            EXPECT_LE(last.fields[0].values[v], 1000 + 1e-7);
        }
    }
}

TEST(RunFlow, CarriesHeatAndSpecies) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", blown);
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    EXPECT_GT(numbers(steps, "volume_out_z_min").back(), 0.3);
    const std::vector<double> energy = numbers(steps, "energy_integral"), error = numbers(steps, "energy_error"),
                              smoke = numbers(steps, "smoke_integral"), smoke_error = numbers(steps, "smoke_error");
    for (std::size_t n = 0; n < energy.size(); ++n) {
        EXPECT_NEAR(error[n], 0, 1e-12 * energy[n]);
        EXPECT_NEAR(smoke_error[n], 0, 1e-12 * smoke.back());
    }
    expect_mass_kept(steps, 1e-16);  // of 0.04 that pass
    EXPECT_GT(smoke.back(), 0.2);
    for (const double coldest : numbers(steps, "temperature_min_ball")) EXPECT_GE(coldest, 300 - 1e-7);
    expect_temperatures_kept(folder);
    write(folder.path / "again.toml", contents(folder.path / "d/case.toml"));
    const Outcome again = kropla_program(folder, "run again.toml --out e");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(contents(folder.path / "d/frames/00004.vtu"), contents(folder.path / "e/frames/00004.vtu"));
}

/// What blows is thinner where it is hot, and what it is blown into is cold.
std::string expanding() {
    const std::string thin = "density = { T = [300, 400, 600, 1000], value = [1, 0.75, 0.5, 0.3] }\n";
    std::string text = replaced(blown, "surroundings]\ndensity = 1\nviscosity", "surroundings]\n" + thin + "viscosity");
    text = replaced(text, "conductivity = 0.01\ndensity = 1\n", "conductivity = 0.01\n" + thin);
    return text.substr(0, text.find("[[species]]"));
}

TEST(RunFlow, AGasExpandsAndKeepsMassAndEnergy) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", expanding());
    write(folder.path / "half.toml", replaced(expanding(), "end = 0.4\nsteps = 4", "end = 0.2\nsteps = 2"));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    const std::vector<double> energy = numbers(steps, "energy_integral"), error = numbers(steps, "energy_error");
    for (std::size_t n = 0; n < energy.size(); ++n) {
        EXPECT_NEAR(error[n], 0, 1e-11 * energy[n]);
    }
    expect_mass_kept(steps, 1e-16);  // of 0.01 that pass
    EXPECT_GT(std::abs(numbers(steps, "volume_out_z_min").back() + numbers(steps, "volume_out_z_max").back()), 1e-3);
    expect_temperatures_kept(folder);
    ASSERT_EQ(kropla_program(folder, "run half.toml --out e").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out e --resume").code, 0);
    EXPECT_EQ(lasting_columns(folder.path / "e"), lasting_columns(folder.path / "d"));
    EXPECT_EQ(contents(folder.path / "e/frames/00004.vtu"), contents(folder.path / "d/frames/00004.vtu"));
}

// The first guess of how a body answers to forces is of the gas as it is; at 0 K, where a law need not hold, it may be far off.
TEST(RunFlow, ABodyIsFreeInGasWhoseDensityDependsOnItsTemperature) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml",
          "[domain]\nmin = [-2, -2, -2]\nmax = [2, 2, 2]\n[[body]]\nname = \"b\"\nshape = \"sphere\"\ncentre = [0, 0, 0.1]\nradius = 0.7\n"
          "[body.motion]\nkind = \"free\"\ndensity = 3\n[size]\nsurface = 0.35\ngrowth = 0.3\nfar = 1\n[time]\nend = 0.4\nsteps = 2\n"
          "[heat.region.surroundings]\nconductivity = 0.02\ndensity = \"480/T\"\nspecific_heat = 520\ninitial = 300\n"
          "[heat.region.b]\nconductivity = 35\ndensity = 70\nspecific_heat = 80\ninitial = 300\n[flow]\ngravity = [0, 0, -1]\n"
          "[flow.region.surroundings]\ndensity = \"480/T\"\nviscosity = 0.05\n[flow.face]\nz_max = { pressure = 0 }\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    for (const double rounds : numbers(read_table(folder.path / "d/steps.csv"), "flow_rounds")) EXPECT_LE(rounds, 5);
}

TEST(RunFlow, CutsStepsByCourantNumbers) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(blown, "steps = 4", "steps = 4\ncourant = 0.3"));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::vector<double> courant = numbers(read_table(folder.path / "d/steps.csv"), "courant");
    EXPECT_GT(courant.size(), 6u);
    for (std::size_t n = 0; n < courant.size(); ++n) EXPECT_LT(courant[n], 1.1 * 0.3);
}

// Vertices that are smoothed go a fifth of a cell in a step, however short it is: that is no limit.
TEST(RunFlow, StepsAroundABodyThatMovesMayBeShort) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", "[domain]\nmin = [-2.5, -2.5, 0]\nmax = [2.5, 2.5, 6]\n[[body]]\nname = \"ball\"\nshape = \"sphere\"\n"
                                  "centre = [0, 0, 3.8]\nradius = 1\n[body.motion]\nz = \"-t\"\n[size]\nsurface = 0.4\ngrowth = 0.2\n"
                                  "far = 0.8\n[time]\nend = 0.1\nsteps = 1\ncourant = 0.1\n[flow.region.surroundings]\ndensity = 1\n"
                                  "viscosity = 0.01\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const std::vector<double> courant = numbers(read_table(folder.path / "d/steps.csv"), "courant");
    EXPECT_GE(courant.size(), 2u);
    EXPECT_LT(*std::ranges::max_element(courant), 1.1 * 0.1);
}

TEST(RunFlow, WhatIsWrongIsNamed) {
    const TemporaryFolder folder;
    const std::string text = falling(0.2, 2);
    const std::pair<std::string, std::string> wrong[] = {
        {replaced(text, "[flow]\ngravity = [0, 0, -1]\n[flow.region.surroundings]\ndensity = 1\nviscosity = 0.05\n", ""),
         "body[0].motion.kind (line 16): \"free\" needs [flow]: the forces that move the body"},
        {replaced(text, "kind = \"free\"", "kind = \"free\"\nz = \"t\""),
         "body[0].motion.z (line 17): unknown key; known here: kind, density, velocity, spin, hold"},
        {replaced(text, "density = 3\n", ""), "body[0].motion.density (line 15): is missing; it must be positive"},
        {replaced(text, "density = 3\n", "density = 3\nhold = [\"w\"]\n"),
         "body[0].motion.hold (line 18): must be of x, y, z, turn, turn_x, turn_y and turn_z, got [\"w\"]"},
        {replaced(text, "viscosity = 0.05\n", ""),
         "flow.region.surroundings.viscosity (line 20): is missing; it must be positive"},
        {replaced(text, "viscosity = 0.05\n", "viscosity = \"0.05*T\"\n"),
         "flow.region.surroundings.viscosity (line 22): depends on T, but there is no heat in the case; give a number or [heat]"},
        {text + "[flow.face]\nz_max = { velocity = [0, 0, -1] }\n", "flow"},
        {text + "[flow.face]\nz_max = \"open\"\n",
         "flow.face.z_max (line 24): must be \"wall\", \"slip\", { velocity = [u, v, w] } [m/s] or { pressure = ... } [Pa], got "
         "\"open\""},
        {replaced(expanding(), "{ pressure = 0 }", "\"slip\""),
         "flow.region.surroundings.density (line 18): depends on T, and what expands has no way out: give a face of flow.face a pressure"},
        {replaced(expanding(), "conductivity = 0.01\ndensity = { T = [300, 400, 600, 1000], value = [1, 0.75, 0.5, 0.3] }\n",
                  "conductivity = 0.01\ndensity = 1\n"),
         "flow.region.surroundings.density (line 18): depends on T, so heat.region.surroundings.density must be the same"},
        {expanding() + "[[species]]\nname = \"smoke\"\n[species.region.surroundings]\ndiffusivity = 0.001\ninitial = 0\n",
         "flow.region.surroundings.density (line 18): must be a number in a case with [[species]]: what expands does not carry them yet"},
        {replaced(text, "[time]\n", "[time]\ncourant = -1\n"), "time.courant (line 8): must be positive, got -1"}};
    for (const auto& [spoiled, refusal] : wrong) {
        write(folder.path / "a.toml", spoiled);
        const Outcome ended = kropla_program(folder, "run a.toml --out d --force");
        EXPECT_EQ(ended.code, 2) << refusal;
        expect_one_line(ended.err, refusal);
    }
}

}  // namespace
}  // namespace kropla
