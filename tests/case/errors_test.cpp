// Every refusal of a case file, word for word: one line that names file, key, line and value, and what would
// be right.
#include "case/case.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

struct Spoiled {
    std::string_view from, to, refusal;
};

void expect_refusals(std::initializer_list<Spoiled> all) {
    for (const Spoiled& s : all) {
        EXPECT_EQ(refusal(replaced(full_case, s.from, s.to)), "case.toml: " + std::string(s.refusal)) << s.to;
    }
}

TEST(CaseErrors, UnknownKeysComeWithASuggestion) {
    expect_refusals({
        {"radius =", "radus =", "body[0].radus (line 8): unknown key; did you mean \"radius\"?"},
        {"centre =", "center =", "body[0].center (line 7): unknown key; did you mean \"centre\"?"},
        {"[size]", "[sizes]", "sizes (line 19): unknown key; did you mean \"size\"?"},
        {"growth = 0.15", "slope = 0.15",
         "size.slope (line 21): unknown key; known here: surface, growth, far, least"},
        {"z = \"-1.0*t\"", "w = 1", "body[0].motion.w (line 12): unknown key; did you mean \"x\"?"},
        {"[heat.region.droplet]", "[heat.region.drop]",
         "heat.region.drop (line 33): unknown key; known here: surroundings, droplet, egg \"2\""},
        {"initial = 300\n", "inital = 300\n",
         "heat.region.surroundings.inital (line 32): unknown key; did you mean \"initial\"?"},
        {"x_min =", "xmin =", "heat.face.xmin (line 45): unknown key; did you mean \"x_min\"?"},
        {"{ flux =", "{ fluxx =", "heat.face.y_max.fluxx (line 46): unknown key; did you mean \"flux\"?"},
        {"seed =", "sead =", "random.sead (line 51): unknown key; did you mean \"seed\"?"},
    });
}

TEST(CaseErrors, ExpressionsKnowWhatTheirKeyDependsOn) {
    expect_refusals({
        {"source = \"1e6*x*t + y - z\"", "power = \"100*z\"",
         "heat.region.droplet.power (line 38): \"100*z\": \"z\" at character 5 is not known; known are t, pi and functions such as "
         "sin, exp, sqrt"},
        {"initial = 2400.5", "initial = \"2400 + t\"",
         "heat.region.droplet.initial (line 37): \"2400 + t\": \"t\" at character 8 is not known; known are x, y, z, pi and functions "
         "such as sin, exp, sqrt"},
    });
}

TEST(CaseErrors, NamesOfSpeciesAreNotThoseOfOtherArrays) {
    for (const char* name : {"region", "velocity", "pressure", "salt_within", "layer"})
        EXPECT_EQ(refusal(std::string(full_case) + "[[species]]\nname = \"" + name + "\"\n"),
                  std::string("case.toml: species[0].name (line 53): must be one that is not taken yet, got \"") + name + "\"");
}

TEST(CaseErrors, MissingKeys) {
    expect_refusals({
        {"radius = 0.001\n", "", "body[0].radius (line 4): is missing; it must be positive"},
        {"name = \"droplet\"\n", "", "body[0].name (line 4): is missing; it must be a text in quotes"},
        {"[time]\nend = 0.01\nsteps = 40\n", "", "time: is missing; it must be a table [time]"},
        {"steps = 40\n", "", "time.steps (line 25): is missing; it must be a whole number from 1 to 1000000"},
        {"density = 7000\n", "", "heat.region.droplet.density (line 33): is missing; it must be positive"},
        {"surface = 3e-4\n", "", "size.surface (line 19): is missing; it must be positive"},
    });
}

TEST(CaseErrors, WrongTypes) {
    expect_refusals({
        {"radius = 0.001", "radius = \"big\"",
         "body[0].radius (line 8): must be a finite number, got \"big\": \"big\" at character 1 is not known; known are "
         "pi and functions such as sin, exp, sqrt"},
        {"name = \"droplet\"", "name = 3", "body[0].name (line 5): must be a text in quotes, got 3"},
        {"max_aspect_ratio = 9.5", "method = \"papers\"",
         "quality.method (line 24): must be \"kropla\" or \"paper\", got \"papers\""},
        {"max_aspect_ratio = 9.5", "weights = [1, 0]",
         "quality.weights (line 24): are those of method = \"paper\"; the method here is \"kropla\""},
        {"max_aspect_ratio = 9.5", "method = \"paper\"\nweights = [1, 2]",
         "quality.weights (line 25): must be [X1, X2], each from 0 to 1, one of them at least 0.001, got [1, 2]"},
        {"max_aspect_ratio = 9.5", "method = \"paper\"\nweights = [0, 0]",
         "quality.weights (line 25): must be [X1, X2], each from 0 to 1, one of them at least 0.001, got [0, 0]"},
        {"max_aspect_ratio = 9.5", "method = \"paper\"\nweights = [1]",
         "quality.weights (line 25): must be 2 finite numbers [X1, X2], got [1]"},
        {"centre = [0.0, 0.0, 0.013]", "centre = [0, 0]",
         "body[0].centre (line 7): must be 3 finite numbers [x, y, z], got [0, 0]"},
        {"centre = [0.0, 0.0, 0.013]", "centre = [0, 0, nan]",
         "body[0].centre (line 7): must be 3 finite numbers [x, y, z], got [0, 0, nan]"},
        {"steps = 40", "steps = 40.5",
         "time.steps (line 27): must be a whole number from 1 to 1000000, got 40.5"},
        {"[quality]\nmax_aspect_ratio = 9.5", "[[quality]]\nmax_aspect_ratio = 9.5",
         "quality (line 23): must be a table [quality], got [a table]"},
        {"x = \"0.0003*sin(4*pi*t/0.01)\"", "x = true",
         "body[0].motion.x (line 10): must be a finite number or an expression in quotes, got true"},
        {"z_min = \"insulated\"", "z_min = 300",
         "heat.face.z_min (line 47): must be \"insulated\", { value = ... } [K], { flux = ... } [W/m^2] or "
         "{ coefficient = ... [W/(m^2 K)], emissivity = ..., ambient = ... [K] }, got 300"},
        {"{ value = 300 }", "{ value = 300, flux = 1 }",
         "heat.face.x_min (line 45): must have one condition: a value [K], a flux [W/m^2] (or its power [W]), or an "
         "exchange of heat by a coefficient or an emissivity with an ambient"},
    });
    EXPECT_EQ(refusal("body = 3\n"), "case.toml: domain: is missing; it must be a table [domain]");
    EXPECT_EQ(refusal(replaced(replaced(full_case, "[[body]]", "[body.a]"), "[[body]]", "[body.b]")),
              "case.toml: body (line 4): must be tables, each under [[body]], got a table");
}

TEST(CaseErrors, ValuesOutOfRange) {
    expect_refusals({
        {"radius = 0.001", "radius = -1", "body[0].radius (line 8): must be positive, got -1"},
        {"radius = 0.001", "radius = 0.0", "body[0].radius (line 8): must be positive, got 0"},
        {"radius = 0.001", "radius = nan", "body[0].radius (line 8): must be a finite number, got nan"},
        {"radius = 0.001", "radius = inf", "body[0].radius (line 8): must be a finite number, got inf"},
        {"axes = [1e-3, 0.8e-3, 0.7e-3]", "axes = [1e-3, 0.8e-3, 0]",
         "body[1].axes (line 17): must all be positive, got [0.001, 0.0008, 0]"},
        {"rotation = [0, 1, 1, 30.0]", "rotation = [0, 0, 0, 30.0]",
         "body[1].rotation (line 18): must have an axis that is not zero, got [0, 0, 0, 30]"},
        {"rotation = [0, 1, 1, 30.0]", "rotation = [0, 0, 1]",
         "body[1].rotation (line 18): must be 4 finite numbers [axis x, y, z, degrees], got [0, 0, 1]"},
        {"max = [ 0.004,  0.004, 0.016]", "max = [ 0.004,  -0.004, 0.016]",
         "domain.max (line 3): must be above min, got y = -0.004 where min has -0.004"},
        {"surface = 3e-4", "surface = -3e-4", "size.surface (line 20): must be positive, got -0.0003"},
        {"growth = 0.15", "growth = 1.5", "size.growth (line 21): must be from 0 to 1, got 1.5"},
        {"far = 7e-4", "far = 2e-4", "size.far (line 22): must be at least surface = 0.0003, got 0.0002"},
        {"max_aspect_ratio = 9.5", "max_aspect_ratio = 3",
         "quality.max_aspect_ratio (line 24): must be at least 5 (3 is a perfect tet), got 3"},
        {"end = 0.01", "end = 0", "time.end (line 26): must be positive, got 0"},
        {"steps = 40", "steps = 40.0",
         "time.steps (line 27): must be a whole number from 1 to 1000000, got 40.0, which has a fraction to TOML; write 40"},
        {"steps = 40", "steps = 0", "time.steps (line 27): must be a whole number from 1 to 1000000, got 0"},
        {"steps = 40", "steps = 2000000",
         "time.steps (line 27): must be a whole number from 1 to 1000000, got 2000000"},
        {"conductivity = 0.02", "conductivity = 0",
         "heat.region.surroundings.conductivity (line 29): must be positive, got 0"},
        {"every = 5", "every = 0", "output.every (line 49): must be a whole number from 1 to 1000000, got 0"},
        {"seed = 9223372036854775807", "seed = -1",
         "random.seed (line 51): must be a whole number from 0 to 9223372036854775807, got -1"},
    });
}

TEST(CaseErrors, MaterialsByTheTemperature) {
    expect_refusals({
        {"density = 7000", "density = { T = [300, 300], value = [1, 2] }",
         "heat.region.droplet.density.T (line 35): must rise, got 300 after 300"},
        {"density = 7000", "density = { T = [300, 400], value = [1, 0] }",
         "heat.region.droplet.density.value (line 35): must be positive, got 0 at T = 400"},
        {"density = 7000", "density = { T = [300, 400], value = [1] }",
         "heat.region.droplet.density.value (line 35): must be as many numbers as T has, 2, got 1"},
        {"density = 7000", "density = { T = [300], value = [1] }",
         "heat.region.droplet.density.T (line 35): must be at least two temperatures, got [300]"},
        {"density = 7000", "density = \"300 - T\"",
         "heat.region.droplet.density (line 35): must be positive, but \"300 - T\" is -2100.5 at T = 2400.5"},
        {"density = 7000", "density = 7000\nlatent_heat = -1\nsolidus = 1\nliquidus = 2",
         "heat.region.droplet.latent_heat (line 36): must be at least 0, got -1"},
        {"density = 7000", "density = 7000\nlatent_heat = 2e5\nsolidus = 1800\nliquidus = 1800",
         "heat.region.droplet.solidus (line 37): must be below liquidus, 1800, got 1800"},
        {"density = 7000", "density = 7000\nlatent_heat = 2e5\nsolidus = 1800",
         "heat.region.droplet.liquidus (line 33): is missing; it must be a finite number"},
    });
}

TEST(CaseErrors, WhatExchangesHeatAndPowers) {
    expect_refusals({
        {"{ value = 300 }", "{ emissivity = 1.2, ambient = 300 }",
         "heat.face.x_min.emissivity (line 45): must be from 0 to 1, got 1.2"},
        {"{ value = 300 }", "{ emissivity = -0.1, ambient = 300 }",
         "heat.face.x_min.emissivity (line 45): must be from 0 to 1, got -0.1"},
        {"{ value = 300 }", "{ coefficient = -5, ambient = 300 }",
         "heat.face.x_min.coefficient (line 45): must be at least 0, got -5"},
        {"{ value = 300 }", "{ emissivity = 0.5, ambient = -3 }",
         "heat.face.x_min.ambient (line 45): must be at least 0 [K] where something radiates, got -3"},
        {"{ value = 300 }", "{ emissivity = 0.5 }",
         "heat.face.x_min.ambient (line 45): is missing; it must be the temperature [K] with which heat is exchanged"},
        {"{ value = 300 }", "{ ambient = 300 }",
         "heat.face.x_min.ambient (line 45): needs a coefficient [W/(m^2 K)] or an emissivity beside it"},
        {"{ value = 300 }", "{ flux = 0, power = 5 }",
         "heat.face.x_min.flux (line 45): must not be zero beside power, which is spread by it; leave it out to spread it "
         "evenly, got 0"},
        {"source = \"1e6*x*t + y - z\"", "source = 0\npower = 10",
         "heat.region.droplet.source (line 38): must not be zero beside power, which is spread by it; leave it out to "
         "spread it evenly, got 0"},
    });
}

TEST(CaseErrors, SteadyStatesThatAreNotUnique) {
    std::string text(full_case);
    for (const std::string_view initial : {"initial = 300\n", "initial = 2400.5\n", "initial = 300.1\n"})
        text = replaced(text, initial, "initial = \"steady\"\n");
    EXPECT_EQ(refusal(text), "");  // a face says how warm it is
    EXPECT_EQ(refusal(replaced(text, "{ value = 300 }", "\"insulated\"")),
              "case.toml: heat.region.surroundings.initial (line 32): there is no steady state, or more than one, as nothing "
              "says how warm it is: give a region a temperature, or a face a value or an exchange of heat");
}

TEST(CaseErrors, Bodies) {
    expect_refusals({
        {"\"droplet\"", "\"\"", "body[0].name (line 5): must not be empty, got \"\""},
        {"\"droplet\"", "\"surroundings\"",
         "body[0].name (line 5): \"surroundings\" is the name of the rest of the box"},
        {"name = \"egg \\\"2\\\"\"", "name = \"droplet\"",
         "body[1].name (line 14): \"droplet\" is the name of body[0] already; names must differ"},
        {"\"droplet\"", "\"egg__2_\"",
         "body[1].name (line 14): \"egg \\\"2\\\"\" and \"egg__2_\", the name of body[0], would both have the columns of egg__2_ in "
         "steps.csv; letters, digits, \"_\", \".\" and \"-\" tell names apart"},
        {"\"sphere\"", "\"cube\"",
         "body[0].shape (line 6): must be \"sphere\", \"ellipsoid\", \"slab\", \"cylinder\" or \"surface\", got \"cube\""},
        {"radius = 0.001", "radius = 0.001\nfile = \"a.stl\"", "body[0].file (line 9): is of shape = \"surface\""},
        {"radius = 0.001", "radius = 0.001\nsize = 1e-3", "body[0].size (line 9): must be at most size.far = 0.0007, got 0.001"},
        {"\"sphere\"", "\"ellipsoid\"", "body[0].radius (line 8): an ellipsoid has axes = [a, b, c] instead"},
        {"\"ellipsoid\"", "\"sphere\"", "body[1].axes (line 17): a sphere has a radius instead"},
    });
}

TEST(CaseErrors, Expressions) {
    const auto motion = [](const std::string& x) {
        return refusal(replaced(full_case, "\"0.0003*sin(4*pi*t/0.01)\"", "\"" + x + "\""));
    };
    const std::string place = "case.toml: body[0].motion.x (line 10): ";
    EXPECT_EQ(motion("1+*t"), place + "\"1+*t\": \"*\" at character 3 is out of place");
    EXPECT_EQ(motion("2*x"),
              place +
                  "\"2*x\": \"x\" at character 3 is not known; known are t, pi and functions such "
                  "as sin, exp, sqrt");
    EXPECT_EQ(motion("sqrt(t-1)"), place + "must be finite, but \"sqrt(t-1)\" is not a number at t = 0");
    EXPECT_EQ(motion("1/t"), place + "must be finite, but \"1/t\" is infinite at t = 0");
    EXPECT_EQ(motion(""), place + "\"\": an expression is missing");
    EXPECT_EQ(refusal(replaced(full_case, "1e4*sin(t)", "1e4*sin(t")),
              "case.toml: heat.face.y_max.flux (line 46): \"1e4*sin(t\": \")\" is missing at the end");
    EXPECT_EQ(refusal(replaced(full_case, "1e6*x*t", "1e6*u*t")),
              "case.toml: heat.region.droplet.source (line 38): \"1e6*u*t + y - z\": \"u\" at character 5 is "
              "not known; "
              "known are t, x, y, z, pi and functions such as sin, exp, sqrt");
}

TEST(CaseErrors, NotToml) {
    const std::string said = refusal(replaced(full_case, "radius = 0.001", "radius = "));
    EXPECT_EQ(said.substr(0, said.find("TOML: ")), "case.toml: (line 8): is not ");
    EXPECT_EQ(said.find('\n'), std::string::npos);
}

TEST(CaseErrors, LengthsThatNumbersCannotHold) {
    expect_refusals({
        {"max = [ 0.004,  0.004, 0.016]", "max = [ 0.004,  0.004, 1e30]",
         "domain.max (line 3): must be within 1e+15 m of the origin, got [0.004, 0.004, 1e+30]"},
        {"radius = 0.001", "radius = 5e97", "body[0].radius (line 8): must be from 1e-18 to 1e+15 m, got 5e+97"},
        {"radius = 0.001", "radius = 1e-103", "body[0].radius (line 8): must be from 1e-18 to 1e+15 m, got 1e-103"},
        {"axes = [1e-3, 0.8e-3, 0.7e-3]", "axes = [1e-3, 1e-30, 0.7e-3]",
         "body[1].axes (line 17): must all be from 1e-18 to 1e+15 m, got [0.001, 1e-30, 0.0007]"},
        {"surface = 3e-4", "surface = 1e-300", "size.surface (line 20): must be from 1e-18 to 1e+15 m, got 1e-300"},
        {"max = [ 0.004,  0.004, 0.016]", "max = [ 0.004,  0.004, 1e6]",
         "size.surface (line 20): must be at least 1.0e-03 m where coordinates go up to 1e+06 m, for the sake of "
         "rounding (a box nearer to the origin allows less), got 0.0003"},
    });
}

TEST(CaseErrors, FilesThatAreNotThere) {
    EXPECT_THROW((void)read_case("no/such/case.toml"), FileError);
    EXPECT_THROW((void)read_case("/"), FileError);
}

}  // namespace
}  // namespace kropla
