// With which case a run may go on.
#include "case/same_case.h"
#include <kropla/base/error.h>
#include "case_text.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

const std::string text = replaced(replaced(full_case, "radius = 0.001", "radius = \"0.5*d\""), "steps = 40",
                                  "steps = \"n\"") + "[parameters]\nd = 2e-3\nn = 40\n";

std::string refusal(const std::string& changed) {
    Case given = parse_case(changed, "case.toml");
    try {
        go_on_with(given, {to_toml(parse_case(text, "case.toml")), 40, 0}, "case.toml", "d");
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(SameCase, ParametersAreCompared) {
    EXPECT_EQ(refusal(text), "");
    EXPECT_EQ(refusal(replaced(text, "d = 2e-3", "d = 1.9e-3")),
              "case.toml: parameters.d: is 0.0019 here, but 0.002 in the run that d holds; only time.end and output.every may "
              "change");
}

TEST(SameCase, ExpressionsOfParametersAreComparedByValue) {
    EXPECT_EQ(refusal(replaced(text, "\"0.5*d\"", "1e-3")), "");
    EXPECT_EQ(refusal(replaced(text, "d = 2e-3", "d = \"2*1e-3\"")), "");
    EXPECT_EQ(refusal(replaced(text, "\"0.5*d\"", "\"0.6*d\"")),
              "case.toml: body[0].radius: is 0.6*d here, but 0.5*d in the run that d holds; only time.end and output.every may "
              "change");
}

TEST(SameCase, StepsFollowALaterEnd) {
    Case given = parse_case(replaced(text, "end = 0.01", "end = 0.02"), "case.toml");
    go_on_with(given, {to_toml(parse_case(text, "case.toml")), 40, 0}, "case.toml", "d");
    EXPECT_EQ(given.time.steps, 80);
    EXPECT_NE(to_toml(given).find("\nsteps = 80\n"), std::string::npos) << to_toml(given);
}

}  // namespace
}  // namespace kropla
