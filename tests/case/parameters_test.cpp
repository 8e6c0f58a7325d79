// Parameters: names for the expressions of a case, and numbers that are expressions of them.
#include "case/case.h"
#include "case/foresight.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

/// The full case, some of its values by parameters.
std::string with_parameters(const std::string& parameters) {
    std::string text(full_case);
    for (const auto& [from, to] : {std::pair{"radius = 0.001", "radius = \"0.5*d\""},
                                   {"centre = [0.0, 0.0, 0.013]", "centre = [0, 0.0, \"10*r\"]"},
                                   {"\"-1.0*t\"", "\"-speed*t\""},
                                   {"steps = 40", "steps = \"2*n\""},
                                   {"\"1e6*x*t + y - z\"", "\"1e6*x*t + speed\""},
                                   {"conductivity = 0.02", "conductivity = \"0.02*speed\""}})
        text = replaced(text, from, to);
    return text + parameters;
}

const std::string parameters = "[parameters]\nspeed = 3\nd = \"2*r\"\nr = 1e-3\nn = 20\n";

/// Of a [parameters] whose first is in line 52.
std::string refused(const std::string& lines) { return refusal(std::string(full_case) + "[parameters]\n" + lines); }

TEST(Parameters, AreKnownToAllExpressions) {
    const Case given = parse_case(with_parameters(parameters), "case.toml");
    EXPECT_EQ(given.domain.bodies[0].shape.semi_axes.x, 1e-3);
    EXPECT_EQ(given.domain.bodies[0].shape.centre.z, 0.01);
    EXPECT_EQ(given.domain.bodies[0].motion(0.5).displacement.z, -1.5);
    EXPECT_EQ(given.time.steps, 40);
    EXPECT_EQ(given.heat->regions[0].material.conductivity, 0.06);
    EXPECT_EQ(given.heat->regions[1].source({2, 0, 0}, 0.5), 1e6 + 3);
    ASSERT_EQ(given.parameters.size(), 4u);
    EXPECT_EQ(given.parameters[1].name, "d");
    EXPECT_EQ(given.parameters[1].value, 2e-3);
}

TEST(Parameters, MayBeIntegersThatNoDoubleHolds) {
    const Case given = parse_case(std::string(full_case) + "[parameters]\na = 9223372036854775807\n", "case.toml");
    ASSERT_EQ(given.parameters.size(), 1u);
    EXPECT_EQ(given.parameters[0].value, 0x1p63);
}

// Vogel's law has a pole at 150 K, below which it is positive again.
TEST(Property, OfAnExpressionGoesAsFarAsThatIsPositiveAroundWhatIsUsual) {
    const Case given = parse_case(replaced(full_case, "conductivity = 0.02", "conductivity = \"1e-3*exp(500/(T-150))\""), "case.toml");
    const Property& conductivity = given.heat->regions[0].material.conductivity;
    for (const double t : {200.0, 300.0, 1000.0, 12345.0})
        EXPECT_NEAR(conductivity(t) / (1e-3 * std::exp(500 / (t - 150))), 1, 2.1e-5) << t;
    EXPECT_GT(conductivity.temperatures().front(), 150);
    for (const double value : conductivity.values()) EXPECT_TRUE(std::isfinite(value) && value > 0);
}

TEST(Parameters, AreKeptInTheCaseAsRunWithTheExpressionsAsWritten) {
    const Case given = parse_case(with_parameters(parameters), "case.toml");
    const std::string written = to_toml(given);
    for (const char* line : {"[parameters]\nspeed = 3\nd = \"2*r\"  # = 0.002\nr = 0.001\nn = 20\n",
                             "\nradius = \"0.5*d\"  # = 0.001\n", "\ncentre = [0, 0, \"10*r\"]  # = [0, 0, 0.01]\n",
                             "\nz = \"-speed*t\"\n", "\nsteps = \"2*n\"  # = 40\n"})
        EXPECT_NE(written.find(line), std::string::npos) << line << written;
    const Case again = parse_case(written, "written.toml");
    EXPECT_EQ(to_toml(again), written);
    EXPECT_EQ(again.domain.bodies[0].shape.semi_axes.x, 1e-3);
}

TEST(Parameters, AreRefusedWhereTheyMeanNothing) {
    EXPECT_EQ(refused("a = \"b + 1\"\nb = \"c\"\nc = \"2*b\"\n"),
              "case.toml: parameters.b (line 54): depends on itself: b -> c -> b");
    EXPECT_EQ(refused("a = \"a\"\n"), "case.toml: parameters.a (line 53): depends on itself: a -> a");
    EXPECT_EQ(refused("current = 1\nb = \"2*curent\"\n"),
              "case.toml: parameters.b (line 54): \"2*curent\": \"curent\" is no parameter; did you mean \"current\"?");
    EXPECT_EQ(refused("b = \"2*t\"\n"), "case.toml: parameters.b (line 53): \"2*t\": \"t\" is a variable; a parameter is "
                                       "a number, or an expression of other parameters");
    EXPECT_EQ(refused("b = \"1/0\"\n"),
              "case.toml: parameters.b (line 53): must be a finite number, got \"1/0\", which is infinite");
    EXPECT_EQ(refused("b = [1, 2]\n"), "case.toml: parameters.b (line 53): must be a finite number, got [1, 2]");
    EXPECT_EQ(refused("b = \"2*\"\n"), "case.toml: parameters.b (line 53): must be a finite number, got \"2*\": something "
                                      "is missing at the end");
    for (const char* name : {"t", "x", "y", "z", "T"})
        EXPECT_EQ(refused(std::string(name) + " = 1\n"), "case.toml: parameters." + std::string(name) +
                                                              " (line 53): is a variable of expressions; another name does");
    for (const char* name : {"pi", "sin", "max", "_e"})
        EXPECT_EQ(refused(std::string(name) + " = 1\n"),
                  "case.toml: parameters." + std::string(name) +
                      " (line 53): is a constant or function of expressions; another name does");
    for (const char* name : {"a-b", "2nd", "\"a b\""})
        EXPECT_NE(refused(std::string(name) + " = 1\n").find("is no name for a parameter"), std::string::npos) << name;
}

TEST(Parameters, NumbersThatAreExpressionsAreCheckedAsNumbers) {
    EXPECT_EQ(refusal(with_parameters(replaced(parameters, "r = 1e-3", "r = -1e-3"))),
              "case.toml: body[0].radius (line 8): must be positive, got \"0.5*d\" = -0.001");
    EXPECT_EQ(refusal(with_parameters(replaced(parameters, "n = 20", "n = 20.25"))),
              "case.toml: time.steps (line 27): must be a whole number from 1 to 1000000, got \"2*n\" = 40.5");
    EXPECT_EQ(refusal(with_parameters(replaced(parameters, "r = 1e-3", "r = 1e-3\nradius = 1")) + "q = \"radus\"\n"),
              "case.toml: parameters.q (line 58): \"radus\": \"radus\" is no parameter; did you mean \"radius\"?");
    EXPECT_EQ(refusal(replaced(full_case, "radius = 0.001", "radius = \"0.001 + t\"")),
              "case.toml: body[0].radius (line 8): must be a finite number, got \"0.001 + t\": \"t\" at character 9 is not "
              "known; known are pi and functions such as sin, exp, sqrt");
    EXPECT_EQ(refusal(replaced(full_case, "\"-1.0*t\"", "\"-u*t\"") + "[parameters]\nv = 1\n"),
              "case.toml: body[0].motion.z (line 12): \"-u*t\": \"u\" at character 2 is not known; known are t, v, pi and "
              "functions such as sin, exp, sqrt");
}

TEST(Parameters, ThatNothingUsesAreToldOf) {
    const Case given = parse_case(with_parameters(parameters + "spare = 1\n"), "case.toml");
    std::vector<std::string> unused;
    for (const Parameter& parameter : given.parameters)
        if (!parameter.used) unused.push_back(parameter.name);
    EXPECT_EQ(unused, std::vector<std::string>{"spare"});
    const std::string resting = replaced(full_case, "\"-1.0*t\"", "0") + "[parameters]\nspare = 1\n";
    const auto warnings = foresee(parse_case(resting, "case.toml"));
    ASSERT_FALSE(warnings.empty());
    EXPECT_EQ(warnings.front(), "parameters.spare is used by no expression");
}

}  // namespace
}  // namespace kropla
