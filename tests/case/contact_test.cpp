// [contact] in a case file.
#include "case_text.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

const std::string text = R"([domain]
min = [0, 0, 0]
max = [1, 1, 1.5]
[size]
surface = 0.12
far = 0.3
[time]
end = 1
steps = 10
[[body]]
name = "ball"
shape = "sphere"
centre = [0.5, 0.5, 0.9]
radius = 0.15
[body.motion]
kind = "free"
density = 3
[flow]
gravity = [0, 0, -1]
[flow.region.surroundings]
density = 1
viscosity = 0.05
[contact]
)";

TEST(CaseContact, HasDefaults) {
    const Case given = parse_case(text, "case.toml");
    ASSERT_TRUE(given.contact);
    EXPECT_TRUE(given.contact->lubrication);
    EXPECT_EQ(given.contact->restitution, 0);
    EXPECT_EQ(given.contact->reach, 0.06);
    // A quarter more than the limit, and what the triangles of so coarse a sphere stand out.
    EXPECT_NEAR(given.contact->gap, 1.25 * doubtful_gap(10) * 0.12 + 0.15 * 0.12 * 0.12 / 0.15, 1e-15);
    EXPECT_FALSE(parse_case(replaced(text, "[contact]\n", ""), "case.toml").contact);
}

TEST(CaseContact, IsWrittenAsItReads) {
    const std::string given = text + "lubrication = false\nrestitution = 0.5\ngap = \"0.25*s\"\n[parameters]\ns = 0.12\n";
    const std::string written = to_toml(parse_case(given, "case.toml"));
    EXPECT_NE(written.find("\n[contact]\nlubrication = false\nrestitution = 0.5\ngap = \"0.25*s\"  # = 0.03\n"),
              std::string::npos)
        << written;
    EXPECT_EQ(to_toml(parse_case(written, "case.toml")), written);
    const std::string by_default = to_toml(parse_case(text, "case.toml"));
    EXPECT_EQ(to_toml(parse_case(by_default, "case.toml")), by_default);
}

TEST(CaseContact, WhatIsWrongIsNamed) {
    EXPECT_EQ(refusal(replaced(text, "kind = \"free\"\ndensity = 3\n", "z = 0\n")),
              "case.toml: contact (line 22): needs a body with motion.kind = \"free\": contacts act on no other");
    EXPECT_EQ(refusal(text + "restitution = 1.5\n"), "case.toml: contact.restitution (line 24): must be from 0 to 1, got 1.5");
    EXPECT_EQ(refusal(text + "gap = 0\n"), "case.toml: contact.gap (line 24): must be positive, got 0");
    EXPECT_EQ(refusal(text + "gap = 0.07\n"),
              "case.toml: contact.gap (line 24): must be at most half of size.surface, 0.06 m, got 0.07");
    EXPECT_EQ(refusal(text + "friction = 1\n"),
              "case.toml: contact.friction (line 24): unknown key; known here: lubrication, restitution, gap");
    const std::string floor = "[[body]]\nname = \"floor\"\nshape = \"slab\"\nmin = [0, 0, 0]\nmax = [1, 1, 0.2]\n[flow]\n";
    EXPECT_EQ(refusal(replaced(text, "[flow]\n", floor)),
              "case.toml: contact (line 28): is known between spheres and ellipsoids, and with faces of the box; body \"floor\" is bounded "
              "by triangles, or reaches through a face");
    EXPECT_TRUE(refusal(text + "lubrication = 1\n").starts_with("case.toml: contact.lubrication (line 24): must be true"));
    EXPECT_EQ(refusal(replaced(text, "density = 3\n", "density = 3\n[body.layer]\nmin_gap = 0.05\n") + "gap = 0.04\n"),
              "case.toml: contact.gap (line 26): 0.04 m is less than layer.min_gap = 0.05 m leaves; a smaller min_gap does, as gap "
              "may be half of size.surface, 0.06 m");
    const std::string warm = replaced(text, "viscosity = 0.05", "viscosity = \"0.05*T/300\"") +
                             "lubrication = true\n[heat.region.surroundings]\nconductivity = 1\ndensity = 1\nspecific_heat = 1\n"
                             "initial = 300\n[heat.region.ball]\nconductivity = 1\ndensity = 3\nspecific_heat = 1\ninitial = 300\n";
    EXPECT_EQ(refusal(warm), "case.toml: contact.lubrication (line 24): needs flow.region.surroundings.viscosity to be a number; it "
                             "depends on T, so it must be false");
    EXPECT_EQ(refusal(replaced(warm, "lubrication = true", "lubrication = false")), "");
}

}  // namespace
}  // namespace kropla
