// With which case a run may go on.
#include "../io/examples.h"
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

TEST(SameCase, FilesAreThoseOfTheMeshAndOfSurfaces) {
    EXPECT_TRUE(contents_of_files("[parameters]\nmesh = 2e-4\nfile = 1\n").empty());
    const Folder folder;
    put(folder / "a", "something");
    const std::string file = "\"" + (folder / "a").string() + "\"\n";
    const FileContents contents =
        contents_of_files("[domain]\nmesh = " + file + "[[body]]\nname = \"a\"\n[[body]]\nfile = " + file);
    ASSERT_EQ(contents.size(), 2u);
    EXPECT_EQ(contents.begin()->first, "body[1].file");
    EXPECT_EQ(contents.rbegin()->first, "domain.mesh");
    EXPECT_EQ(contents.begin()->second, contents.rbegin()->second);
    EXPECT_GT(contents.begin()->second, 0);
}

TEST(SameCase, AFileThatHoldsSomethingElseIsNamedAndAnUnknownOneIsTaken) {
    const Folder folder;
    const std::string file = (folder / "a.stl").string();
    const auto facet = [](const char* a, const char* b, const char* c) {
        return std::string("facet normal 0 0 0\nouter loop\nvertex ") + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
    };
    const auto write = [&](const char* top) {
        put(folder / "a.stl", "solid s\n" + facet("0 0 0", "0 1 0", "1 0 0") + facet("0 0 0", "1 0 0", top) + facet("1 0 0", "0 1 0", top) +
                                  facet("0 1 0", "0 0 0", top) + "endsolid s\n");
    };
    const std::string of_file = "[domain]\nmin = [-3, -3, -3]\nmax = [3, 3, 3]\n[[body]]\nname = \"a\"\nshape = \"surface\"\n"
                                "centre = [0, 0, 0]\nfile = \"" + file + "\"\n[size]\nsurface = 0.3\nfar = 1\n[time]\nend = 1\nsteps = 1\n";
    write("0 0 1");
    Case given = parse_case(of_file, "case.toml");
    RunSoFar run{to_toml(given), 1, 0, contents_of_files(to_toml(given))};
    EXPECT_NO_THROW(go_on_with(given, run, "case.toml", "d"));
    write("0 0 1.5");
    EXPECT_EQ(message_of<CaseError>([&] { go_on_with(given, run, "case.toml", "d"); }),
              "case.toml: body[0].file: " + file + " is not the file that the run in d was begun with; with that it goes on, or begins "
              "anew with --force");
    run.files.clear();  // a checkpoint of before
    EXPECT_NO_THROW(go_on_with(given, run, "case.toml", "d"));
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
