// `--set`: values of the command line in place of those of the case file.
#include "case/case.h"
#include "case/setting.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

const std::string text = replaced(full_case, "\"-1.0*t\"", "\"-speed*t\"") + "[parameters]\nspeed = 1.0\nwide = 2\n";

Case with(std::vector<std::string> settings) { return parse_case(text, "case.toml", settings); }

std::string refusal(std::vector<std::string> settings) {
    try {
        (void)with(std::move(settings));
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(Settings, ReplaceValues) {
    const Case given = with({"speed=2", "size.surface=1e-4", "time.steps=10", "heat.region.droplet.conductivity=40",
                          "body[0].radius=0.0009", "body[1].centre[2]=0.004", "heat.face.z_min={ value = 500 }"});
    EXPECT_EQ(given.domain.bodies[0].motion(1).displacement.z, -2);
    EXPECT_EQ(given.domain.size.surface, 1e-4);
    EXPECT_EQ(given.time.steps, 10);
    EXPECT_EQ(given.heat->regions[1].material.conductivity, 40);
    EXPECT_EQ(given.domain.bodies[0].shape.semi_axes.x, 0.0009);
    EXPECT_EQ(given.domain.bodies[1].shape.centre.z, 0.004);
    EXPECT_EQ(given.heat->faces[4].kind, HeatFace::Kind::value);
}

TEST(Settings, FindBodiesByName) {
    EXPECT_EQ(with({"body.droplet.radius=0.0009"}).domain.bodies[0].shape.semi_axes.x, 0.0009);
    EXPECT_EQ(refusal({"body.dropet.radius=0.0009"}),
              "--set body.dropet.radius=0.0009: body has none called \"dropet\"; did you mean \"droplet\"?");
}

TEST(Settings, AreKeptInTheCaseAsRun) {
    const std::string written = to_toml(with({"speed=2", "parameters.wide=\"2*speed\"", "body[0].motion.x=wide*t"}));
    for (const char* line : {"\nspeed = 2\nwide = \"2*speed\"  # = 4\n", "\nx = \"wide*t\"\n", "\nz = \"-speed*t\"\n"})
        EXPECT_NE(written.find(line), std::string::npos) << line << written;
    EXPECT_EQ(parse_case(written, "written.toml").domain.bodies[0].motion(1).displacement.x, 4);
}

TEST(Settings, SetWhatTheFileLeavesOut) {
    const std::string bare = replaced(full_case, "[random]\nseed = 9223372036854775807\n", "");
    const std::vector<std::string> settings = {"random.seed=5", "quality.method=paper"};
    const Case given = parse_case(bare, "case.toml", settings);
    EXPECT_EQ(given.random.seed, 5u);
    EXPECT_TRUE(given.quality.paper);
}

// A word in place of a text is that text; in place of a number it is refused, as 1O would be an expression of O.
TEST(Settings, TakeAWordForATextOnlyWhereThereIsOne) {
    EXPECT_EQ(with({"heat.face.z_min=insulated", "body[0].name=droplet"}).domain.bodies[0].name, "droplet");
    EXPECT_EQ(refusal({"size.surface=1O"}),
              "--set size.surface=1O: 1O is no TOML value: a number, a text in quotes, a list in brackets, true or false");
    EXPECT_EQ(refusal({"body[0].name=5"}), "--set body[0].name=5: must be a text in quotes, got 5");
}

TEST(Settings, AreRefusedInOneLine) {
    EXPECT_EQ(refusal({"sped=2"}), "--set sped=2: the case has no such parameter or key; did you mean \"speed\"?");
    EXPECT_EQ(refusal({"parameters.sped=2"}),
              "--set parameters.sped=2: the case has no such parameter; did you mean \"speed\"?");
    EXPECT_EQ(refusal({"size.surfac=2"}), "--set size.surfac=2: unknown key; did you mean \"surface\"?");
    EXPECT_EQ(refusal({"sise.surface=2"}), "--set sise.surface=2: unknown key; did you mean \"size\"?");
    EXPECT_EQ(refusal({"size.surface.x=2"}), "--set size.surface.x=2: size.surface holds one value, and nothing below it");
    EXPECT_EQ(refusal({"body[2].radius=2"}), "--set body[2].radius=2: body has 2, counted from [0]");
    EXPECT_EQ(refusal({"nobody[2].radius=2"}), "--set nobody[2].radius=2: the case has nothing that is counted there");
    EXPECT_EQ(refusal({"size.surface=-1"}), "--set size.surface=-1: must be positive, got -1");
    EXPECT_EQ(refusal({"size.surface=true"}), "--set size.surface=true: must be a finite number, got true");
    EXPECT_EQ(refusal({"speed=1,2,[3,4]"}),
              "--set speed=1,2,[3,4]: must be one value, not 3; kropla sweep runs a case for each");
    EXPECT_EQ(refusal({"speed=[1, 2]"}), "--set speed=[1, 2]: must be a finite number, got [1, 2]");
    EXPECT_EQ(refusal({"speed"}), "--set speed: must be KEY=VALUE, such as size.surface=1e-4");
    EXPECT_EQ(refusal({"speed="}), "--set speed=: has no value");
    EXPECT_EQ(refusal({"=3"}), "--set =3: must be KEY=VALUE, such as size.surface=1e-4");
    EXPECT_EQ(refusal({"speed=1", "speed=2"}), "--set speed=2: speed is set twice");
    EXPECT_EQ(refusal({"a..b=1"}), "--set a..b=1: has no key; keys are such as size.surface and body[0].radius");
    EXPECT_EQ(refusal({"body[0.radius=1"}),
              "--set body[0.radius=1: is no key; body[0].radius might be meant, as keys are such as size.surface and body[0].radius");
    for (const char* odd : {"quality.method=\xff", "random.\xff=1", "speed=\xff", "parameters={}", "body=[]", "body[0]=3", "speed=\"",
                            "body[9999999999999999999999].radius=1", "body[-1].radius=1", "a]=1", "domain.max[3]=1"})
        EXPECT_NE(refusal({odd}), "") << odd;
    EXPECT_EQ(refusal({"speed=1\nwide=3"}).substr(0, 23), "--set speed=1\nwide=3: 1");
}

TEST(Settings, ListsArePartedAtTheirCommas) {
    using List = std::vector<std::string>;
    EXPECT_EQ(values_of_list("100,150,200"), (List{"100", "150", "200"}));
    EXPECT_EQ(values_of_list("[1,2],[3,4]"), (List{"[1,2]", "[3,4]"}));
    EXPECT_EQ(values_of_list("\"a,b\",max(t,1)"), (List{"\"a,b\"", "max(t,1)"}));
    EXPECT_EQ(values_of_list("7"), List{"7"});
    EXPECT_EQ(values_of_list("1,"), (List{"1", ""}));
}

}  // namespace
}  // namespace kropla
