// What is said of a case before it is run.
#include "case/foresight.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

/// What is said of a text; empty if the case may be run.
std::string refusal(const std::string& text) {
    try {
        (void)foresee(parse_case(text, "case.toml"));
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}
std::vector<std::string> warnings(const std::string& text) { return foresee(parse_case(text, "case.toml")); }

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
}

/// A ball of 1 mm that comes down to `gap` [m] above the floor in 20 steps.
std::string landing(double gap, const std::string& size = "surface = 0.0004\ngrowth = 0.2\nfar = 0.0008\n") {
    return "[domain]\nmin = [-0.0025, -0.0025, 0.0]\nmax = [0.0025, 0.0025, 0.006]\n"
           "[[body]]\nname = \"drop\"\nshape = \"sphere\"\ncentre = [0, 0, 0.0038]\nradius = 0.001\n"
           "[body.motion]\nz = \"-(0.0028 - " + number(gap) + ")*t/0.002\"\n[size]\n" + size +
           "[time]\nend = 0.002\nsteps = 20\n";
}

/// As in the case file: the number that stands before or after a word.
double number_after(const std::string& text, const std::string& word) {
    return std::stod(text.substr(text.find(word) + word.size()));
}

/// The full case, but that the droplet stops before it meets the egg.
std::string stopping_case() { return replaced(full_case, "-1.0*t", "-0.5*t"); }

TEST(Foresight, ACaseThatIsRightMayBeRun) {
    EXPECT_TRUE(warnings(stopping_case()).empty());
    EXPECT_TRUE(
        refusal(std::string(full_case))
            .starts_with(
                "body \"droplet\" and body \"egg \"2\"\": motion takes them into each other at t = 8."));
}

TEST(Foresight, ANarrowGapOnTheWayIsSaidWithTheSizeThatWouldDo) {
    EXPECT_EQ(refusal(landing(2e-5)), "");  // edges become as short as it takes
    const std::string said = refusal(landing(2e-5, "surface = 0.0004\ngrowth = 0.2\nfar = 0.0008\nleast = 0.0004\n"));
    EXPECT_TRUE(said.starts_with("at t = 2 ms body \"drop\" is 2e-05 m from the wall z min, too close for "
                                 "size.surface = 0.0004 m; at most 9.1e-05 m would do"))
        << said;
    // The polyhedron stands out by 3e-6, the rest of 1.5e-4 are 0.11 sizes: it may be run, but a doubt is left.
    const auto doubts = warnings(landing(2e-5, "surface = 0.00015\ngrowth = 0.2\nfar = 0.0008\nleast = 0.00015\n"));
    ASSERT_EQ(doubts.size(), 1U);
    EXPECT_TRUE(doubts[0].starts_with(
        "at t = 2 ms body \"drop\" is 2e-05 m from the wall z min, 0.13 of size.surface"))
        << doubts[0];
    const double surely = number_after(doubts[0], "at most ");
    EXPECT_TRUE(
        warnings(landing(2e-5, "surface = " + number(surely) + "\nleast = " + number(surely) + "\ngrowth = 0.2\nfar = 0.0008\n")).empty());
    EXPECT_TRUE(warnings(landing(1.2e-4)).empty());
    EXPECT_TRUE(warnings(landing(2e-5)).empty());
}

TEST(Foresight, AFlatTetInTheDoubtfulGapIsAtTheLimit) {
    for (double limit : {5.0, 7.5, 10.0, 30.0}) {
        const double h = doubtful_gap(limit), side = std::sqrt(h * h + 1.0 / 12) / 2,
                     base = std::sqrt(3.0) / 4;
        const double inradius = base * h / (base + 3 * side), circumradius = (1.0 / 3 + h * h) / (2 * h);
        EXPECT_NEAR(circumradius / inradius, limit, 1e-9);
    }
    EXPECT_NEAR(doubtful_gap(3), std::sqrt(2.0 / 3), 1e-3);  // of the regular tet
}

TEST(Foresight, ALayersLeastGapHoldsOnTheWay) {
    const auto layered = [](double gap, const std::string& min_gap) {
        return replaced(landing(gap), "[size]",
                        "[body.layer]\ncount = 3\nfirst_height = 1e-5\nmin_gap = " + min_gap + "\n[size]");
    };
    EXPECT_EQ(refusal(layered(1e-4, "1.5e-4")),
              "at t = 2 ms body \"drop\" is 0.0001 m from the wall z min, less than layer.min_gap = 0.00015 "
              "m; at most "
              "0.0001 m would do");
    EXPECT_EQ(refusal(layered(2e-4, "1.5e-4")), "");
    EXPECT_EQ(refusal(layered(0, "1.5e-4")),
              "at t = 2 ms body \"drop\" touches the wall z min, less than layer.min_gap = 0.00015 m");
}

TEST(Foresight, AJumpIsFoundBeforeTheRun) {
    const std::string jumps = replaced(landing(1e-3), "-(0.0028 - 0.001)*t/0.002",
                                       "t < 0.001 ? -1.2*t : -1.2*(t - 0.001)");
    EXPECT_EQ(refusal(jumps),
              "body \"drop\": motion makes it jump by 0.0012 m at t = 1 ms; a path must not leap");
    const auto pulse = [](const std::string& to) {
        return refusal(replaced(landing(1e-3), "-(0.0028 - 0.001)*t/0.002",
                                "t > 0.00123 ? (t < " + to + " ? 0.0005 : 0) : 0"));
    };
    for (const char* to : {"0.00124", "0.0012300001"})
        EXPECT_EQ(pulse(to),
                  "body \"drop\": motion makes it jump by 0.0005 m at t = 1.23 ms; a path must not leap");
}

TEST(Foresight, KnowsTheNumbersOfAFormula) {
    EXPECT_EQ(numbers_in("\"t > 1.5e-3 ? x2*atan2(3, .5) : -7*log10(t)\""), (std::vector<double>{1.5e-3, 3, .5, 7}));
    EXPECT_TRUE(numbers_in("t").empty());
}

// Advice is taken, and nothing is left to advise.
TEST(Foresight, MoreTetsThanAMachineHolds) {
    const std::string fine = refusal(replaced(stopping_case(), "surface = 3e-4", "surface = 4e-6"));
    EXPECT_TRUE(fine.starts_with("size asks for about ")) << fine;
    const auto surface = fine.find("surface = "), far = fine.find(" and far"), end = fine.find(" would");
    std::string advised = replaced(stopping_case(), "surface = 3e-4", fine.substr(surface, far - surface));
    advised = replaced(advised, "far = 7e-4", fine.substr(far + 5, end - far - 5));
    SCOPED_TRACE(fine);
    EXPECT_EQ(refusal(advised), "");
    EXPECT_GT(estimate_tets(parse_case(advised, "").domain),
              0.5 * most_tets);  // and is not coarser than it must
}

/// Balls of 1.5 mm and of `dust` [m] in a box of 8 mm.
std::string electrode_and_dust(double dust, const std::string& size) {
    return "[domain]\nmin = [-0.004, -0.004, 0.0]\nmax = [0.004, 0.004, 0.008]\n"
           "[[body]]\nname = \"electrode\"\nshape = \"sphere\"\ncentre = [0, 0, 0.006]\nradius = 0.0015\n"
           "[[body]]\nname = \"dust\"\nshape = \"sphere\"\ncentre = [0, 0, 0.002]\nradius = " + number(dust) +
           "\n[size]\n" + size + "[time]\nend = 0.01\nsteps = 10\n";
}

TEST(Foresight, AdviceOnTheCountKeepsToTheCurvature) {
    const std::string said = refusal(electrode_and_dust(1e-5, "surface = 9e-6\nfar = 8e-4\n"));
    SCOPED_TRACE(said);
    EXPECT_TRUE(said.starts_with("size asks for about ")) << said;
    EXPECT_NE(said.find("is one of them in millimetres?"), std::string::npos);
    const double surface = number_after(said, "surface = "), growth = number_after(said, "growth = "),
                 far = number_after(said, "far = ");
    EXPECT_LE(surface, 1e-5);
    EXPECT_EQ(refusal(electrode_and_dust(1e-5, "surface = " + number(surface) + "\ngrowth = " +
                                                   number(growth) + "\nfar = " + number(far) + "\n")),
              "");
}

TEST(Foresight, AdviceOnTheCurvatureKeepsToTheCount) {
    const std::string said = refusal(electrode_and_dust(1e-5, "surface = 2e-5\nfar = 8e-4\n"));
    SCOPED_TRACE(said);
    EXPECT_TRUE(
        said.starts_with("body \"dust\" is curved with a radius of 1e-05 m, too little for size.surface = "
                         "2e-05 m; at most 1e-05 m would do, which asks for about "))
        << said;
    const double surface = number_after(said, "; surface = "), growth = number_after(said, "growth = "),
                 far = number_after(said, "far = ");
    EXPECT_EQ(refusal(electrode_and_dust(1e-5, "surface = " + number(surface) + "\ngrowth = " +
                                                   number(growth) + "\nfar = " + number(far) + "\n")),
              "");
}

TEST(Foresight, SaysThatNoOneSizeDoes) {
    for (const char* surface : {"surface = 9e-7\n", "surface = 2e-5\n"}) {
        const std::string said = refusal(electrode_and_dust(1e-6, surface + std::string("far = 8e-4\n")));
        EXPECT_NE(said.find("no one size does"), std::string::npos) << said;
        EXPECT_NE(said.find("body \"dust\" is curved with a radius of 1e-06 m"), std::string::npos) << said;
    }
}

TEST(Foresight, ALayerTooThinForAnySizeIsNamed) {
    const std::string said = refusal(replaced(landing(1e-3), "[size]", "[body.layer]\ncount = 3\nfirst_height = 1e-15\n[size]"));
    EXPECT_NE(said.find("the layer of body \"drop\" ends in such thin prisms that triangles there are at most 2.54e-14 m large"),
              std::string::npos) << said;
}

TEST(Foresight, AsksForMixedUnits) {
    const auto hint = [](const std::string& from, const std::string& to) {
        return refusal(replaced(landing(1e-3), from, to));
    };
    EXPECT_NE(hint("radius = 0.001", "radius = 1")
                  .find("body \"drop\" is far larger than the box, about 333 times"),
              std::string::npos);
    EXPECT_NE(hint("surface = 0.0004\ngrowth = 0.2\nfar = 0.0008", "surface = 0.4\nfar = 0.8")
                  .find("size.surface is far larger than body \"drop\", about 200 times"), std::string::npos);
    EXPECT_EQ(hint("radius = 0.001", "radius = 0.0039").find("millimetres"), std::string::npos);
}

TEST(Foresight, NoEstimateIsInfinite) {
    for (double scale : {1e-15, 1e-9, 1.0, 1e6, 1e12})
        for (double share : {1.0, 1e-4, 1e-9}) {
            Case given = parse_case(std::string(full_case), "case.toml");
            given.domain.box.min *= scale;
            given.domain.box.max *= scale;
            given.domain.bodies.clear();
            given.domain.size = {3e-4 * scale * share, 0.1, 7e-4 * scale};
            EXPECT_TRUE(std::isfinite(estimate_tets(given.domain)));
            EXPECT_GT(estimate_tets(given.domain), 0);
        }
}

}  // namespace
}  // namespace kropla
