#include "report/summary.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

RunFiles tiny(const TinyRun& run) {
    const auto dir = test_folder("summary");
    write_tiny_run(dir, run);
    RunFiles files = read_run_files(dir);
    std::filesystem::remove_all(dir);
    return files;
}

TEST(Summary, CountsTheRun) {
    const RunSummary s = summarise_run(tiny({}));
    EXPECT_EQ(s.steps, 5);
    EXPECT_EQ(s.refused, 2);
    EXPECT_DOUBLE_EQ(s.worst_aspect_ratio, 8.5);
    EXPECT_EQ(s.worst_step, 3);
    EXPECT_DOUBLE_EQ(s.mesh_seconds, 1.25);
    EXPECT_EQ(s.floor, 10);
    EXPECT_EQ(s.end, 0.5);
}

TEST(Summary, CallsRoundingWhatIsOne) {
    RunFiles run = tiny({});
    const auto figure = [&](const std::string& name) {
        const Figures all = figures(run, summarise_run(run));
        return std::ranges::find(all, name, &Figures::value_type::first)->second;
    };
    EXPECT_EQ(figure("Largest error of a transfer of energy"), "rounding, 1e-15 of it");
    EXPECT_EQ(figure("Stored energy"), "105 J at the last step; change since the first: 0.04 of it");
    EXPECT_EQ(figure("Time step"), "100 ms");
    for (Column& column : run.steps.columns)
        if (column.name == "energy_transfer_error") column.cells[2] = "-0.001";
    EXPECT_EQ(figure("Largest error of a transfer of energy"), "0.001 of it");
}

TEST(Summary, JudgesTheRun) {
    EXPECT_EQ(verdict(summarise_run(tiny({}))).kind, Verdict::Kind::good);
    EXPECT_EQ(verdict(summarise_run(tiny({.rows = 3}))).text, "Not finished: at 300 ms of 500 ms");
    EXPECT_EQ(verdict(summarise_run(tiny({.rows = 0}))).kind, Verdict::Kind::unfinished);
    EXPECT_EQ(verdict(summarise_run(tiny({.worst = 10.5}))).kind, Verdict::Kind::bad);
}

TEST(Summary, ReadsNumbersOfTheCase) {
    const std::string text = "[a]\nmax_x = 1\n[b]\nmax_x = 2.5  # [m]\nother = \"3\"\n[b.c]\nlast = 1e-3\nend = \"n*dt\"  # = 2e-3";
    EXPECT_EQ(number_of_case(text, "b", "max_x"), 2.5);
    EXPECT_EQ(number_of_case(text, "b.c", "last"), 1e-3);
    EXPECT_EQ(number_of_case(text, "b.c", "end"), 2e-3);
    EXPECT_FALSE(number_of_case(text, "b", "other"));
    EXPECT_FALSE(number_of_case(text, "b", "last"));
    EXPECT_FALSE(number_of_case("", "b", "last"));
    const std::string flow = "[flow]\ngravity = [0, 0.5, -9.81]\nsize = [1, 2]\n";
    EXPECT_EQ(vector_of_case(flow, "flow", "gravity"), (Vec3{0, 0.5, -9.81}));
    EXPECT_FALSE(vector_of_case(flow, "flow", "size"));
    EXPECT_FALSE(vector_of_case(flow, "flow", "force"));
}

}  // namespace
}  // namespace kropla
