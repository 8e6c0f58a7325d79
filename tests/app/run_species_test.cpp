// What a run does of species: what leaves a body is in the gas, and frames show both sides.
#include "run_results.h"
#include <kropla/io/vtk.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace kropla {
namespace {

std::string drop_with_vapour(const std::string& more = "") {
    return "[domain]\nmin = [0, 0, 0]\nmax = [1, 1, 1]\n"
           "[[body]]\nname = \"drop\"\nshape = \"sphere\"\ncentre = [0.5, 0.5, 0.6]\nradius = 0.15\n"
           "[body.motion]\nz = \"-0.2*t\"\n"
           "[size]\nsurface = 0.12\nfar = 0.3\n[time]\nend = 0.5\nsteps = 4\n"
           "[[species]]\nname = \"vapour\"\n"
           "[species.region.surroundings]\ndiffusivity = 0.01\ninitial = \"z < 0.3 ? 1 : 0\"\n"
           "[species.region.drop]\ndiffusivity = 1e-4\ninitial = 7\n"
           "[species.surface.drop]\nflux = \"0.1*t\"\n" + more;
}

TEST(RunSpecies, WhatLeavesABodyIsInTheGasAndNothingIsLost) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", drop_with_vapour());
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    const std::vector<double> amount = numbers(steps, "vapour_integral"), error = numbers(steps, "vapour_error"),
                              transfer = numbers(steps, "vapour_transfer_error");
    for (std::size_t step = 0; step < amount.size(); ++step) {
        EXPECT_NEAR(amount[step], amount[0], 1e-12 * amount[0]);
        EXPECT_NEAR(error[step], 0, 1e-12 * amount[0]);
        EXPECT_NEAR(transfer[step], 0, 1e-12);
    }
    const Frame frame = read_vtu(folder.path / "d/frames/00004.vtu");
    ASSERT_EQ(frame.fields.size(), 2u);
    EXPECT_EQ(frame.fields[0].name, "vapour");
    EXPECT_EQ(frame.fields[1].name, "vapour_within");
    EXPECT_GT(*std::ranges::max_element(frame.fields[1].values), 6);  // in the middle of the drop
    EXPECT_GE(*std::ranges::min_element(frame.fields[0].values), -1e-9);
    write(folder.path / "d2.toml", contents(folder.path / "d/case.toml"));
    const Outcome again = kropla_program(folder, "run d2.toml --out e");
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(contents(folder.path / "d/frames/00004.vtu"), contents(folder.path / "e/frames/00004.vtu"));
}

TEST(RunSpecies, WhatIsWrongIsNamed) {
    const TemporaryFolder folder;
    const std::pair<std::string, std::string> wrong[] = {
        {drop_with_vapour("per_heat = 1\n"), "species[0].surface.drop.per_heat (line 27): needs heat in the case"},
        {drop_with_vapour("[species.face]\nz_min = 3\n"),
         "species[0].face.z_min (line 28): must be { value = ... } [kg/m^3] or { flux = ... } [kg/(m^2 s)], got 3"},
        {drop_with_vapour("[[species]]\nname = \"vapour\"\n[species.region]\n"),
         "species[1].name (line 28): must be one that is not taken yet, got \"vapour\""},
        {drop_with_vapour("[[species]]\nname = \"a b\"\n[species.region]\n"),
         "species[1].name (line 28): must be of letters, digits and underscores, got \"a b\""},
        {drop_with_vapour("[[species]]\nname = \"b\"\n[species.region]\n"),
         "species[1].region (line 29): must name at least one region that the species is in"}};
    for (const auto& [text, refusal] : wrong) {
        write(folder.path / "a.toml", text);
        const Outcome ended = kropla_program(folder, "run a.toml --out d");
        EXPECT_EQ(ended.code, 2);
        expect_one_line(ended.err, "a.toml: " + refusal);
        EXPECT_FALSE(std::filesystem::exists(folder.path / "d"));
    }
}

}  // namespace
}  // namespace kropla
