// The program as users meet it: what it says, and with which code it ends.
#include "app/commands.h"
#include "case/new_case.h"
#include "case/case_text.h"
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include "program.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

using Words = std::vector<std::string>;

void expect_complaint(const Outcome& ended, int code, const std::string& line) {
    EXPECT_EQ(ended.code, code);
    EXPECT_EQ(ended.err, "kropla: " + line + "\n");
    EXPECT_EQ(ended.out, "");
}

TEST(Arguments, ArePartedIntoThoseOfTheSolverAndTheRest) {
    const PartedArguments parted =
        part_arguments({"run", "a.toml", "-ksp_type", "cg", "--out", "d", "-ksp_monitor", "-ksp_rtol",
                        "-1e-3", "-log_view", "--resume"});
    EXPECT_EQ(parted.solver, (Words{"-ksp_type", "cg", "-ksp_monitor", "-ksp_rtol", "-1e-3", "-log_view"}));
    EXPECT_EQ(parted.others, (Words{"run", "a.toml", "--out", "d", "--resume"}));
}

TEST(Program, HelpsAndTellsItsVersion) {
    const TemporaryFolder folder;
    for (const char* arguments :
         {"--help", "run --help", "sweep --help", "mesh --help", "check --help", "report --help", "new --help",
          "convert --help", "improve --help"}) {
        SCOPED_TRACE(arguments);
        const Outcome ended = kropla_program(folder, arguments);
        EXPECT_EQ(ended.code, 0);
        EXPECT_NE(ended.out.find("kropla "), std::string::npos) << ended.out;
        EXPECT_GT(ended.out.size(), 200u);
        EXPECT_EQ(ended.err, "");
    }
    EXPECT_EQ(kropla_program(folder, "--version").out, "kropla " KROPLA_VERSION "\n");
}

TEST(Program, BadArgumentsEndWithTwo) {
    const TemporaryFolder folder;
    for (const char* arguments :
         {"", "fly", "run", "run a.toml", "run a.toml --out d --threads 0",
          "run a.toml --out d --threads many", "run a.toml --out d --fast", "mesh a.toml",
          "run a.toml --out d -kps_type cg", "check a.vtu -ksp_type cg"}) {
        SCOPED_TRACE(arguments);
        const Outcome ended = kropla_program(folder, arguments);
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(ended.err.substr(0, 8), "kropla: ");
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_EQ(ended.out, "");
    }
}

TEST(Program, BadCasesEndWithTwo) {
    const TemporaryFolder folder;
    write(folder.path / "negative.toml", replaced(full_case, "radius = 0.001", "radius = -0.001"));
    expect_complaint(kropla_program(folder, "run negative.toml --out d"), 2,
                     "negative.toml: body[0].radius (line 8): must be positive, got -0.001");
    expect_complaint(kropla_program(folder, "mesh negative.toml -o m.vtu"), 2,
                     "negative.toml: body[0].radius (line 8): must be positive, got -0.001");
    expect_complaint(kropla_program(folder, "mesh negative.toml -o m.stl"), 2,
                     "m.stl: is of no format that is known; name a file that ends in .vtu (VTK), .msh (Gmsh) or .mesh (Medit)");
    EXPECT_FALSE(std::filesystem::exists(folder.path / "d"));
}

TEST(Program, BodiesThatLeaveTheBoxEndWithTwo) {
    const TemporaryFolder folder;
    const std::string leaving = replaced(starting_case(), "\"-1.0*t\"", "\"-2.0*t\"");
    const std::string lost = replaced(starting_case(), "\"-1.0*t\"", "\"-sqrt(0.005-t)/10\"");
    write(folder.path / "leaving.toml", leaving);
    write(folder.path / "lost.toml", lost);
    for (const char* command :
         {"run leaving.toml --out d", "mesh leaving.toml -o m.vtu", "run lost.toml --out d"}) {
        SCOPED_TRACE(command);
        const Outcome ended = kropla_program(folder, command);
        EXPECT_EQ(ended.code, 2);
        EXPECT_NE(ended.err.find(".toml: body \"droplet\": motion "), std::string::npos) << ended.err;
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    }
}

TEST(Program, FileTroubleEndsWithFive) {
    const TemporaryFolder folder;
    EXPECT_EQ(kropla_program(folder, "run none.toml --out d").code, 5);
    EXPECT_EQ(kropla_program(folder, "mesh none.toml -o m.vtu").code, 5);
    EXPECT_EQ(kropla_program(folder, "check none.vtu").code, 5);
    EXPECT_EQ(kropla_program(folder, "report none").code, 5);
    EXPECT_EQ(kropla_program(folder, "new none/such").code, 5);
    write(folder.path / "file", "");
    write(folder.path / "a.toml", std::string(starting_case()));
    expect_complaint(kropla_program(folder, "run a.toml --out file"), 5,
                     "file: is a file; --out must name a folder");
}

TEST(Program, KeepsAnotherRunsFolder) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(starting_case()));
    std::filesystem::create_directory(folder.path / "d");
    expect_complaint(kropla_program(folder, "run a.toml --out d --resume"), 2,
                     "d: has no checkpoint.h5 to resume from; leave --resume out to start the run");
    write(folder.path / "d" / "steps.csv", "step\n");
    expect_complaint(kropla_program(folder, "run a.toml --out d"), 2,
                     "d: holds steps.csv, but no checkpoint.h5 to go on from; add --force to overwrite it, or name another "
                     "folder with --out");
    write(folder.path / "d" / "checkpoint.h5", "");
    expect_complaint(
        kropla_program(folder, "run a.toml --out d"), 2,
        "d: holds a run already; add --resume to go on with it or --force to overwrite it, or name another folder with "
        "--out");
    EXPECT_EQ(contents(folder.path / "d" / "steps.csv"), "step\n");
}

TEST(Program, SaysWhatWasPerhapsMeant) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(starting_case()));
    expect_complaint(kropla_program(folder, "rum a.toml --out d"), 2, "rum: unknown command; did you mean \"run\"?");
    expect_complaint(kropla_program(folder, "foo"), 2,
                     "foo: unknown command; known here: run, sweep, mesh, check, report, new, convert, improve");
    expect_complaint(kropla_program(folder, "run a.toml --out d --theads 2"), 2,
                     "--theads: unknown option of kropla run; did you mean \"--threads\"?");
    expect_complaint(kropla_program(folder, "run a.toml --theads=2"), 2,
                     "--theads: unknown option of kropla run; did you mean \"--threads\"?");
    expect_complaint(kropla_program(folder, "run a.toml"), 2,
                     "--out is missing: the folder that the run fills (see kropla run --help)");
    expect_complaint(kropla_program(folder, "run --out d"), 2,
                     "CASE is missing: the case file (TOML; see `kropla new`) (see kropla run --help)");
    expect_complaint(kropla_program(folder, "run a.toml --out ''"), 2,
                     "--out: names no folder; \".\" is the one you are in");
    expect_complaint(kropla_program(folder, "run a.toml --out d --resume --force"), 2,
                     "--resume goes on with a run and --force overwrites it: choose one");
    EXPECT_FALSE(std::filesystem::exists(folder.path / "d"));
}

TEST(Program, SeesThatItsOutputIsLost) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", std::string(starting_case()));
    for (const char* command : {"--help", "--version", "run --help", "new drop"}) {
        SCOPED_TRACE(command);
        const std::string line = "cd '" + folder.path.string() + "' && '" KROPLA_PROGRAM "' " + command +
                                 " >/dev/full 2>err.txt";
        const int status = std::system(line.c_str());
        EXPECT_EQ(WEXITSTATUS(status), 5);
        EXPECT_EQ(contents(folder.path / "err.txt"),
                  "kropla: the output cannot be written: No space left on device\n");
    }
}

// A mesh of some million cells in 300 MB: the first large array is more than there is.
TEST(Program, EndsWithSixIfThereIsNotEnoughMemory) {
    const TemporaryFolder folder;
    write(folder.path / "fine.toml", replaced(replaced(starting_case(), "surface = 2e-4", "surface = 4e-5"),
                                              "far     = 8e-4", "far     = 8e-5"));
    const std::string line = "cd '" + folder.path.string() + "' && ulimit -v 250000 && '" KROPLA_PROGRAM
                             "' mesh fine.toml -o m.vtu >out.txt 2>err.txt";
    const int status = std::system(line.c_str());
    EXPECT_EQ(WEXITSTATUS(status), 6);
    const std::string err = contents(folder.path / "err.txt");
    EXPECT_TRUE(err.starts_with("kropla: fine.toml: not enough memory for about ")) << err;
    EXPECT_EQ(std::ranges::count(err, '\n'), 1) << err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "m.vtu"));
}

TEST(Program, WritesACaseToStartFrom) {
    const TemporaryFolder folder;
    const Outcome ended = kropla_program(folder, "new drop");
    EXPECT_EQ(ended.code, 0);
    EXPECT_NE(ended.out.find("kropla run drop.toml --out drop"), std::string::npos) << ended.out;
    EXPECT_EQ(contents(folder.path / "drop.toml"),
              contents(std::filesystem::path(KROPLA_CASES) / "droplet.toml"));
    expect_complaint(kropla_program(folder, "new drop.toml"), 2,
                     "drop.toml: is there already; choose another name");
}

TEST(Program, MeshesACaseAndChecksIt) {
    const TemporaryFolder folder;
    const std::string quick = std::string("'") + KROPLA_CASES + "/quick.toml'";
    const Outcome mesh = kropla_program(folder, "mesh " + quick + " -o m.vtu");
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_NE(mesh.out.find("m.vtu: "), std::string::npos) << mesh.out;
    const Outcome check = kropla_program(folder, "check m.vtu");
    EXPECT_EQ(check.code, 0) << check.out << check.err;

    const std::string bytes = contents(folder.path / "m.vtu");
    write(folder.path / "half.vtu", bytes.substr(0, bytes.size() / 2));
    EXPECT_EQ(kropla_program(folder, "check half.vtu").code, 5);
}

// With the highest floor there may be: a body a third of an edge above the bottom, for which a mesh is found; and a plate half as
// thick as an edge, where edges may not become shorter, for which none is.
TEST(Program, AFloorThatNoMeshReachesEndsWithThree) {
    const TemporaryFolder folder;
    const auto with_body = [](const std::string& body) {
        return "domain = {min = [0, 0, 0], max = [1, 1, 1]}\nsize = {surface = 0.2, least = 0.2, far = 0.5}\n"
               "quality = {max_aspect_ratio = 5}\ntime = {end = 1, steps = 1}\n[[body]]\nname = \"body\"\n" + body;
    };
    write(folder.path / "near.toml", with_body("shape = \"sphere\"\ncentre = [0.5, 0.5, 0.37]\nradius = 0.3\n"));
    ASSERT_EQ(kropla_program(folder, "mesh near.toml -o near.vtu").code, 0);
    EXPECT_LE(summarise_quality(read_vtu(folder.path / "near.vtu").mesh).max_aspect_ratio, 5);

    write(folder.path / "plate.toml", with_body("shape = \"slab\"\nmin = [0.2, 0.2, 0.45]\nmax = [0.8, 0.8, 0.55]\n"));
    const Outcome ended = kropla_program(folder, "mesh plate.toml -o plate.vtu");
    EXPECT_EQ(ended.code, 3);
    EXPECT_TRUE(ended.err.starts_with("kropla: the initial mesh cannot be made: ")) << ended.err;
    EXPECT_NE(ended.err.find(", limit 5)"), std::string::npos) << ended.err;
    EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "plate.vtu"));
}

}  // namespace
}  // namespace kropla
