// What a run does of heat: sources between step ends, options of the solver, and what it says of both.
#include "run_results.h"
#include <kropla/io/vtk.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace kropla {
namespace {

/// A unit cube at 300 K with this source, ten steps of 0.1 s.
std::string cube_with(const std::string& source, const std::string& more = "") {
    return "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n[size]\nsurface = 0.5\nfar = 0.5\n"
           "[time]\nend = 1.0\nsteps = 10\n"
           "[heat.region.surroundings]\nconductivity = 1.0\ndensity = 1.0\nspecific_heat = 1.0\ninitial = 300.0\n"
           "source = " + source + "\n" + more;
}

/// Steel in argon, so coarse that temperatures fall below any that there was.
std::string coarse_case() {
    std::string text = short_case(2);
    const auto conductivity = [&](const std::string& of, const std::string& value) {
        const std::size_t at = text.find("conductivity", text.find(of));
        text.replace(at, text.find('\n', at) - at, "conductivity = " + value);
    };
    conductivity("[heat.region.surroundings]", "1e-4");
    conductivity("[heat.region.droplet]", "1e4");
    return text;
}

TEST(RunHeat, WhatASourceGivesBetweenTwoStepEndsArrives) {
    const TemporaryFolder folder;
    const std::pair<const char*, double> pulses[] = {
        {"\"t > 0.31 ? (t < 0.39 ? 1e3 : 0) : 0\"", 80}, {"\"t > 0.3141 ? (t < 0.3142 ? 1e6 : 0) : 0\"", 100}};
    for (const auto& [source, joules] : pulses) {
        SCOPED_TRACE(source);
        write(folder.path / "a.toml", cube_with(source));
        std::filesystem::remove_all(folder.path / "d");
        const Outcome ended = kropla_program(folder, "run a.toml --out d");
        ASSERT_EQ(ended.code, 0) << ended.err;
        const auto energy = numbers(read_table(folder.path / "d/steps.csv"), "energy_integral");
        EXPECT_NEAR(energy.at(2), 300, 1e-9);
        EXPECT_NEAR(energy.at(3), 300 + joules, 1e-9 * joules);
        EXPECT_NEAR(energy.back(), 300 + joules, 1e-9 * joules);
    }
}

TEST(RunHeat, AQuantityWithoutAValueIsNamed) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", cube_with("\"sqrt(0.55 - t)\""));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 2);
    expect_one_line(ended.err, "a.toml: heat.region.surroundings.source is ");
    EXPECT_NE(ended.err.find(" m, t = 0.5"), std::string::npos) << ended.err;
    EXPECT_EQ(read_table(folder.path / "d/steps.csv").rows, 5u);
    write(folder.path / "b.toml", cube_with("0", "[heat.face]\nz_min = { flux = \"1/(t < 0.15)\" }\n"));
    expect_one_line(kropla_program(folder, "run b.toml --out e").err, "b.toml: heat.face.z_min.flux is inf at (");
}

// Cells as coarse as the body, steps of several of them: a scheme without bounds is 70 K below the coldest.
TEST(RunHeat, TemperaturesStayWithinTheirBounds) {
    const TemporaryFolder folder;
    write(folder.path / "coarse.toml", coarse_case());
    const Outcome ended = kropla_program(folder, "run coarse.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    for (const char* frame : {"d/frames/00001.vtu", "d/frames/00002.vtu"}) {
        const Frame read = read_vtu(folder.path / frame);
        const auto [least, most] = std::ranges::minmax(read.fields.at(0).values);
        EXPECT_GE(least, 300 - 1e-7);
        EXPECT_LE(most, 2400 + 1e-7);
        EXPECT_GT(most, 2000);
    }
}

TEST(RunHeat, OptionsOfTheSolverThatAreWrongEndWithTwo) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", cube_with("0"));
    const std::pair<const char*, const char*> wrong[] = {
        {"-ksp_rtoll 1e-9", "-ksp_rtoll is no option of the solver's"},
        {"-ksp_rtoll 1e-9", "did you mean \"-ksp_rtol\"?"},
        {"-potential_kps_type cg", "did you mean \"-potential_ksp_type\"?"},
        {"-resume", "did you mean \"--resume\"?"},
        {"-ksp_rtol abc", "-ksp_rtol abc: this value is not taken"},
        {"-ksp_type foo", "-ksp_type foo: this value is not taken"},
        {"-pc_type foo", "-pc_type foo: this value is not taken"}};
    for (const auto& [options, said] : wrong) {
        SCOPED_TRACE(options);
        const Outcome ended = kropla_program(folder, std::string("run a.toml --out d ") + options);
        EXPECT_EQ(ended.code, 2);
        expect_one_line(ended.err, said);
        EXPECT_EQ(ended.err.find("code 6"), std::string::npos) << ended.err;
        EXPECT_FALSE(std::filesystem::exists(folder.path / "d"));
    }
}

TEST(RunHeat, OptionsOfAllKindsReachTheSolver) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(1));
    for (const char* options : {"-ksp_type bcgs -ksp_rtol 1e-10 -sub_pc_factor_levels 1",
                                "-pc_type gamg -mg_levels_ksp_max_it 3 -ksp_converged_reason -log_view",
                                "-potential_pc_type icc -potential_ksp_rtol 1e-12",
                                "-pc_type hypre -pc_hypre_boomeramg_relax_type_all Jacobi",
                                "-potential_pc_hypre_boomeramg_strong_threshold 0.25"}) {
        SCOPED_TRACE(options);
        std::filesystem::remove_all(folder.path / "d");
        const Outcome ended = kropla_program(folder, std::string("run a.toml --out d ") + options);
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_EQ(ended.out.find("never used"), std::string::npos) << ended.out;
    }
    std::filesystem::remove_all(folder.path / "d");
    write(folder.path / "b.toml", cube_with("0"));
    const Outcome ended = kropla_program(folder, "run b.toml --out d -potential_ksp_rtol 1e-9");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find("-potential_ksp_rtol was never used"), std::string::npos) << ended.out;
}

TEST(RunHeat, NeedsNoRemoteShell) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", cube_with("0"));
    const std::string command = "cd '" + folder.path.string() +
                                "' && /usr/bin/env PATH=/nowhere '" KROPLA_PROGRAM
                                "' run a.toml --out d >out.txt 2>err.txt </dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0) << contents(folder.path / "err.txt");
}

/// A body in a box, coarse: with these keys of the body, conditions and materials.
std::string coarse(const std::string& body, const std::string& rest) {
    return "[domain]\nmin = [-2, -2, 0]\nmax = [2, 2, 4]\n[[body]]\nname = \"b\"\nshape = \"sphere\"\nradius = 0.8\n" + body +
           "[size]\nsurface = 0.35\ngrowth = 0.3\nfar = 1\n" + rest +
           "[heat.region.surroundings]\nconductivity = 0.02\ndensity = 1.6\nspecific_heat = 520\n";
}

/// What a run of the case has in steps.csv.
Table steps_of(const std::string& text) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", text);
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 0) << ended.err;
    return read_table(folder.path / "d/steps.csv");
}

TEST(RunHeat, WhatIsSteadyAroundABodyThatRestsStaysSo) {
    const Table steps = steps_of(coarse("centre = [0, 0, 2.1]\n",
                                        "[time]\nend = 1\nsteps = 5\n[heat.face]\nz_min = { value = 300 }\nz_max = { value = 400 }\n") +
                                 "initial = \"steady\"\n[heat.region.b]\nconductivity = 35\ndensity = 70\nspecific_heat = 80\n"
                                 "initial = \"steady\"\n");
    const auto into = numbers(steps, "heat_out_z_max"), out = numbers(steps, "heat_out_z_min");
    ASSERT_EQ(out.size(), 5u);
    for (std::size_t n = 0; n < out.size(); ++n) {
        EXPECT_NEAR(out[n], 8.957, 0.001);
        EXPECT_NEAR(into[n], -out[n], 1.2e-7 * out[n]);
    }
}

TEST(RunHeat, WhatMeltsSettlesInABodyThatAFaceCuts) {
    const Table steps = steps_of(coarse("centre = [0, 0, 0.1]\ncut = true\n", "[time]\nend = 0.2\nsteps = 1\n") +
                                 "initial = 300\n[heat.region.b]\nconductivity = 35\ndensity = 70\nspecific_heat = 80\n"
                                 "initial = \"1000+200*x\"\nlatent_heat = 1e5\nsolidus = 900\nliquidus = 1000\n");
    const auto error = numbers(steps, "energy_error"), energy = numbers(steps, "energy_integral");
    ASSERT_EQ(error.size(), 1u);
    EXPECT_LT(std::abs(error[0]), 1e-12 * energy[0]);
}

TEST(RunHeat, ASmallSourceLiftsNoBoundsWhereHeatIsNotLinear) {
    const auto most = numbers(steps_of(coarse("centre = [0, 0, 0.1]\ncut = true\n",
                                              "[time]\nend = 0.4\nsteps = 4\n[heat.surface.b]\nflux = 1e-3\n"
                                              "[heat.face]\nz_min = { value = 300 }\n") +
                                       "initial = 300\n[heat.region.b]\nconductivity = 30\ndensity = 7000\n"
                                       "specific_heat = { T = [300, 1800], value = [500, 800] }\ninitial = 1900\n"),
                              "temperature_max_b");
    ASSERT_EQ(most.size(), 4u);
    for (const double temperature : most) EXPECT_LT(temperature, 1900 + 1e-7);
}

}  // namespace
}  // namespace kropla
