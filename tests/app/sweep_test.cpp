// Sweeps as users meet them: their folder, their table, and how they go on.
#include "held_program.h"
#include "run_results.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

/// The quick case coarser, without heat, its speed a parameter.
std::string case_of_speed(int steps) {
    const std::string text = replaced(short_case(steps), "surface = 4e-4", "surface = 6e-4");
    return "[parameters]\nspeed = 0.8\n" + replaced(text.substr(0, text.find("[heat")), "-0.8*t", "-speed*t") +
           text.substr(text.find("[output]"));
}

std::vector<std::string> column(const Table& table, const std::string& name) {
    return std::ranges::find(table.columns, name, &Column::name)->cells;
}

using Cells = std::vector<std::string>;

TEST(Sweep, RunsAllAndComparesThem) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", case_of_speed(2));
    const Outcome ended = kropla_program(folder, "sweep a.toml --set speed=0.5,0.8 --out s");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    EXPECT_TRUE(ended.out.starts_with("a.toml: 2 runs into s\nrun 1/2  speed=0.5  done in 0:0")) << ended.out;
    EXPECT_NE(ended.out.find("\ndone: 2 runs in 0:0"), std::string::npos) << ended.out;
    EXPECT_TRUE(ended.out.ends_with("; see s/sweep.html\n")) << ended.out;

    const Table table = read_table(folder.path / "s/sweep.csv");
    EXPECT_EQ(column(table, "run"), (Cells{"speed=0.5", "speed=0.8"}));
    EXPECT_EQ(column(table, "speed"), (Cells{"0.5", "0.8"}));
    EXPECT_EQ(column(table, "exit_code"), (Cells{"0", "0"}));
    const Table steps = read_table(folder.path / "s/speed=0.8/steps.csv");
    for (const Column& of_run : steps.columns)
        EXPECT_EQ(column(table, of_run.name)[1], of_run.cells.back()) << of_run.name;
    EXPECT_TRUE(fs::exists(folder.path / "s/sweep.html"));
    EXPECT_NE(contents(folder.path / "s/speed=0.5/case.toml").find("\nspeed = 0.5\n"), std::string::npos);
    const std::string page = contents(folder.path / "s/sweep.html");
    fs::remove(folder.path / "s/sweep.html");
    EXPECT_EQ(kropla_program(folder, "report s").out, "s/sweep.html: written\n");
    EXPECT_EQ(contents(folder.path / "s/sweep.html"), page);
    EXPECT_EQ(kropla_program(folder, "run a.toml --out alone --set speed=0.5").code, 0);
    expect_same_run(folder.path / "s/speed=0.5", folder.path / "alone");
}

TEST(Sweep, DoesNotRunAgainWhatIsComplete) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", case_of_speed(2));
    ASSERT_EQ(kropla_program(folder, "sweep a.toml --set speed=0.5,0.8 --out s").code, 0);
    const std::string steps = contents(folder.path / "s/speed=0.8/steps.csv");
    const std::string log = contents(folder.path / "s/speed=0.8/run.log");
    const Cells seconds = column(read_table(folder.path / "s/sweep.csv"), "wall_seconds");
    const Outcome ended = kropla_program(folder, "sweep a.toml --set speed=0.8,0.7 --out s");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_NE(ended.out.find("\nrun 1/2  speed=0.8  done before\nrun 2/2  speed=0.7  done in"), std::string::npos) << ended.out;
    EXPECT_EQ(contents(folder.path / "s/speed=0.8/steps.csv"), steps);
    EXPECT_EQ(contents(folder.path / "s/speed=0.8/run.log"), log);
    const Table table = read_table(folder.path / "s/sweep.csv");
    EXPECT_EQ(column(table, "run"), (Cells{"speed=0.8", "speed=0.7", "speed=0.5"}));
    EXPECT_EQ(column(table, "wall_seconds")[0], seconds[1]);
}

TEST(Sweep, TellsOfAFailedRunAndGoesOn) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", case_of_speed(2));
    const Outcome ended = kropla_program(folder, "sweep a.toml --set speed=50,0.8 --out s");
    EXPECT_EQ(ended.code, 2);
    expect_one_line(ended.err, "s/speed=50: a.toml: body \"droplet\": motion takes it out of the box");
    EXPECT_NE(ended.out.find("run 1/2  speed=50   failed in 0:0"), std::string::npos) << ended.out;
    EXPECT_NE(ended.out.find("\n1 of 2 runs are done, in 0:0"), std::string::npos) << ended.out;
    const Table table = read_table(folder.path / "s/sweep.csv");
    EXPECT_EQ(column(table, "exit_code"), (Cells{"2", "0"}));
    EXPECT_EQ(column(table, "step"), (Cells{"", "2"}));
}

TEST(Sweep, GoesOnWhereItWasInterrupted) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", case_of_speed(40));
    const Outcome stopped = [&] {
        HeldProgram program(folder, {"sweep", "a.toml", "--set", "speed=0.2,0.1", "--out", "s"}, 20, 0);
        EXPECT_TRUE(program.reaches("s/speed=0.2", 2));
        program.signal(SIGINT);
        return program.finish();
    }();
    EXPECT_EQ(stopped.code, 130);
    EXPECT_NE(stopped.out.find("\nrun 1/2  speed=0.2  interrupted in 0:"), std::string::npos) << stopped.out;
    EXPECT_TRUE(stopped.out.ends_with("interrupted: 0 of 2 runs are done; the same command goes on\n")) << stopped.out;
    EXPECT_EQ(column(read_table(folder.path / "s/sweep.csv"), "exit_code"), Cells{"130"});
    EXPECT_FALSE(fs::exists(folder.path / "s/speed=0.1"));

    const Outcome ended = kropla_program(folder, "sweep a.toml --set speed=0.2,0.1 --out s");
    EXPECT_EQ(ended.code, 0) << ended.out << ended.err;
    EXPECT_NE(contents(folder.path / "s/speed=0.2/run.log").find("goes on after step "), std::string::npos);
    EXPECT_EQ(column(read_table(folder.path / "s/sweep.csv"), "exit_code"), (Cells{"0", "0"}));
    EXPECT_EQ(kropla_program(folder, "run a.toml --out alone --set speed=0.2").code, 0);
    expect_same_run(folder.path / "s/speed=0.2", folder.path / "alone");
}

TEST(Sweep, IsRefusedBeforeAnythingIsRun) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", case_of_speed(2));
    const auto refused = [&](const std::string& words) {
        const Outcome ended = kropla_program(folder, "sweep a.toml " + words);
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(ended.out, "");
        return ended.err;
    };
    EXPECT_EQ(refused("--set sped=1,2 --out s"),
              "kropla: --set sped=1: the case has no such parameter or key; did you mean \"speed\"? (in the run sped=1)\n");
    EXPECT_EQ(refused("--set body[0].radius=1e-3,-1 --out s"),
              "kropla: --set body[0].radius=-1: must be positive, got -1 (in the run body[0].radius=-1)\n");
    expect_one_line(refused("--set speed=1 --out s"), "a sweep needs a list of values");
    expect_one_line(refused("--out s"), "--set is missing");
    EXPECT_FALSE(fs::exists(folder.path / "s"));
    fs::create_directory(folder.path / "s");
    write(folder.path / "s/sweep.csv", "run,n,exit_code,wall_seconds [s]\nn=1,1,0,2.5\n");
    EXPECT_EQ(refused("--set speed=1,2 --out s"),
              "kropla: s: holds a sweep over n, this one is over speed; name another folder with --out\n");
    write(folder.path / "s/checkpoint.h5", "");
    EXPECT_EQ(refused("--set speed=1,2 --out s"), "kropla: s: holds a run; name another folder with --out\n");
}

}  // namespace
}  // namespace kropla
