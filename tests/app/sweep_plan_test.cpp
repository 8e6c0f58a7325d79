// Which runs a sweep has, and how their folders are called.
#include "app/sweep_plan.h"
#include <kropla/base/error.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

using Words = std::vector<std::string>;

Words names(const Words& settings) {
    Words names;
    for (const SweepRun& run : plan_sweep(settings).runs) names.push_back(run.name);
    return names;
}

std::string refusal(const Words& settings) {
    try {
        (void)plan_sweep(settings);
    } catch (const CaseError& error) {
        return error.what();
    }
    return "";
}

TEST(SweepPlan, HasAllCombinations) {
    const SweepPlan plan = plan_sweep(Words{"current=100,150", "time.steps=10", "d=1e-3,2e-3,3e-3"});
    EXPECT_EQ(plan.keys, (Words{"current", "time.steps", "d"}));
    ASSERT_EQ(plan.runs.size(), 6u);
    EXPECT_EQ(plan.runs[0].name, "current=100,d=1e-3");
    EXPECT_EQ(plan.runs[1], (SweepRun{"current=100,d=2e-3", {"100", "10", "2e-3"}}));
    EXPECT_EQ(plan.runs[5].name, "current=150,d=3e-3");
    EXPECT_EQ(settings_of(plan, plan.runs[1]), (Words{"current=100", "time.steps=10", "d=2e-3"}));
}

TEST(SweepPlan, NamesFoldersSoThatTheyDifferAndCanBeOpened) {
    EXPECT_EQ(names({"body[0].centre=[0, 0, 1],[0,0,2]"}), (Words{"body[0].centre=[0,0,1]", "body[0].centre=[0,0,2]"}));
    EXPECT_EQ(names({"quality.method=paper,\"kropla\""}), (Words{"quality.method=paper", "quality.method=kropla"}));
    const Words odd = names({"x=a/b,a*b,a%b,../b"});
    EXPECT_EQ(odd, (Words{"x=a%2Fb", "x=a%2Ab", "x=a%25b", "x=..%2Fb"}));
    EXPECT_EQ(std::set<std::string>(odd.begin(), odd.end()).size(), 4u);
}

TEST(SweepPlan, IsRefusedInOneLine) {
    EXPECT_EQ(refusal({"d=1"}),
              "--set: a sweep needs a list of values, such as --set size.surface=1e-4,2e-4; kropla run takes one");
    EXPECT_EQ(refusal({"d=1,2,1"}), "--set d=1,2,1: 1 stands there twice");
    EXPECT_EQ(refusal({"d=1,,2"}), "--set d=1,,2: a value of the list is empty");
    EXPECT_EQ(refusal({"d=1,2", "d=3"}), "--set d: is set twice");
    EXPECT_EQ(refusal({"d"}), "--set d: must be KEY=VALUE, such as size.surface=1e-4");
    std::string many = "=0";
    for (int i = 1; i < 40; ++i) many += "," + std::to_string(i);
    EXPECT_EQ(refusal({"a" + many, "b" + many}),
              "--set: 40 of a by 40 of b values are too many combinations; at most 1000 runs are made");
    EXPECT_EQ(refusal({"a" + many, "b=" + many.substr(1, 49)}), "");  // 40 by 25
}

}  // namespace
}  // namespace kropla
