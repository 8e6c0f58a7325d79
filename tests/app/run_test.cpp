// A run as users meet it: what it leaves in its folder, and how it ends when it cannot go on.
#include "app/check.h"
#include "held_program.h"
#include <kropla/io/checkpoint.h>
#include <kropla/io/pvd.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/quality.h>
#include "run_results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <numeric>
#include <regex>
#include <unistd.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

void expect_floors_kept(const Table& steps, double limit) {
    for (const double worst : numbers(steps, "max_aspect_ratio")) EXPECT_LE(worst, limit);
    EXPECT_EQ(sum(numbers(steps, "global_remeshes")), 0);
}

/// Whatever the end was, what was done is there and valid: the frames of the series, each with its file, and
/// no others; a table of whole rows; a checkpoint of the last step; nothing half-written.
void expect_valid_so_far(const fs::path& run) {
    const Table steps = read_table(run / "steps.csv");
    const std::string text = contents(run / "steps.csv");
    EXPECT_EQ(static_cast<std::size_t>(std::ranges::count(text, '\n')), steps.rows + 1);
    EXPECT_TRUE(text.ends_with('\n'));
    EXPECT_EQ(read_checkpoint(run / "checkpoint.h5").step, static_cast<std::int64_t>(steps.rows));
    const auto series = read_pvd(run / "frames.pvd");
    EXPECT_EQ(series.size(), frames(run).size());
    for (const SeriesEntry& frame : series) EXPECT_TRUE(check_file(run / frame.file).valid) << frame.file;
    for (const auto& file : fs::recursive_directory_iterator(run))
        EXPECT_NE(file.path().extension(), ".part") << file.path();
}

TEST(Run, LeavesFramesTableCheckpointAndReport) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(4));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    EXPECT_TRUE(ended.out.starts_with("a.toml: about ")) << ended.out;
    EXPECT_NE(ended.out.find(" tets, 4 steps to 800 us, "), std::string::npos) << ended.out;
    const std::string steps_said = ended.out.substr(opening_of(ended.out));
    EXPECT_EQ(std::ranges::count(steps_said, '\n'), 8) << ended.out;  // a plain line per step, and the last four
    EXPECT_TRUE(std::regex_search(
        ended.out, std::regex("\ndone: 4 steps to 800 us in 0:\\d\\d, worst R/r [3-9]\\.\\d\n"
                           "droplet: 2,399\\.\\d+ K in the mean \\(2,400\\.0+ K at the start\\), gave off [\\d.]+ mJ, "
                           "now at \\(0\\.12, 0\\.00, 3\\.16\\) mm\n"
                           "energy: 56\\.3 J stored, kept to \\de-1\\d\n"
                           "see d/report\\.html, or paraview d/frames\\.pvd\n$")))
        << ended.out;
    EXPECT_EQ(ended.out.find('\r'), std::string::npos);

    const fs::path run = folder.path / "d";
    for (const char* file : {"bodies.csv", "case.toml", "report.html"}) EXPECT_GT(fs::file_size(run / file), 0u) << file;
    expect_valid_so_far(run);
    EXPECT_EQ(frames(run).size(), 5u);
    const Table steps = read_table(run / "steps.csv");
    EXPECT_EQ(numbers(steps, "step"), (std::vector<double>{1, 2, 3, 4}));
    for (const char* column : {"time",
                               "dt",
                               "attempts",
                               "vertices",
                               "tets",
                               "prisms",
                               "max_aspect_ratio",
                               "p999_aspect_ratio",
                               "min_dihedral",
                               "max_dihedral",
                               "smoothing_sweeps",
                               "swaps",
                               "splits",
                               "collapses",
                               "local_remeshes",
                               "largest_ring",
                               "global_remeshes",
                               "touched_fraction",
                               "kept_vertices",
                               "kept_tets",
                               "mesh_cpu_seconds",
                               "mesh_seconds",
                               "simulate_seconds",
                               "transfer_seconds",
                               "energy_integral",
                               "transferred_fraction",
                               "energy_transfer_error",
                               "energy_before_transfer",
                               "energy_limited",
                               "energy_beyond_bounds",
                               "heat_from_droplet"})
        EXPECT_EQ(numbers(steps, column).size(), 4u) << column;
    expect_floors_kept(steps, 10);
}

TEST(Run, KeepsTheVolumesOfBodyAndBox) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(4));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    const Mesh first = read_vtu(folder.path / "d/frames/00000.vtu").mesh;
    const Mesh last = read_vtu(folder.path / "d/frames/00004.vtu").mesh;
    const double body = 4 * std::numbers::pi / 3 * 1e-9;  // a droplet of 1 mm, coarse
    EXPECT_NEAR(region_volume(first, Region(1)), body, 1e-12 * body);
    EXPECT_NEAR(region_volume(last, Region(1)), body, 1e-12 * body);
    const double box = 0.005 * 0.005 * 0.006;
    EXPECT_NEAR(body + region_volume(first, Region(0)), box, 1e-12 * box);
    EXPECT_NEAR(region_volume(last, Region(1)) + region_volume(last, Region(0)), box, 1e-12 * box);
}

// The box is insulated: neither the solution of a step nor the transfer to the remeshed mesh changes the
// energy.
TEST(Run, KeepsTheEnergyOfAnInsulatedBox) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(6));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    const Table steps = read_table(folder.path / "d/steps.csv");
    const auto energy = numbers(steps, "energy_integral"), error = numbers(steps, "energy_transfer_error"),
               before = numbers(steps, "energy_before_transfer"),
               share = numbers(steps, "transferred_fraction");
    for (std::size_t i = 0; i < energy.size(); ++i) {
        EXPECT_NEAR(energy[i] / energy[0], 1, 1e-10) << "step " << i + 1;
        EXPECT_NEAR(energy[i] / before[i], 1, 1e-12) << "step " << i + 1;
        EXPECT_LT(std::abs(error[i]), 1e-12) << "step " << i + 1;
        EXPECT_GT(share[i], 0) << "step " << i + 1;  // something was transferred
        EXPECT_LT(share[i], 1) << "step " << i + 1;
    }
}

TEST(Run, GivesTheSameBitsIfEveryStepIsRefusedOnceAndRedone) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(4));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out once").code, 0);
    const Outcome ended = kropla_program(folder, "run a.toml --out redone --test-rollback");
    ASSERT_EQ(ended.code, 0) << ended.err;
    expect_same_run(folder.path / "once", folder.path / "redone");
}

TEST(Run, GivesTheSameBitsWithAnyNumberOfThreadsButNotWithAnotherSeed) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    write(folder.path / "b.toml", short_case(3) + "[random]\nseed = 2\n");
    ASSERT_EQ(kropla_program(folder, "run a.toml --out first --threads 1").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out again --threads 1").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out two --threads 2").code, 0);
    ASSERT_EQ(kropla_program(folder, "run b.toml --out other").code, 0);
    expect_same_run(folder.path / "first", folder.path / "again");
    expect_same_run(folder.path / "first", folder.path / "two");
    EXPECT_NE(contents(folder.path / "first/frames/00000.vtu"),
              contents(folder.path / "other/frames/00000.vtu"));
    EXPECT_NE(contents(folder.path / "first/frames/00003.vtu"),
              contents(folder.path / "other/frames/00003.vtu"));
}

TEST(Run, WritesFramesAsOftenAsAskedAndTheLast) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(4, 3));
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d").code, 0);
    EXPECT_EQ(read_pvd(folder.path / "d/frames.pvd").size(), 3u);
    for (const char* frame : {"00000.vtu", "00003.vtu", "00004.vtu"})
        EXPECT_TRUE(fs::exists(folder.path / "d/frames" / frame)) << frame;
    expect_valid_so_far(folder.path / "d");
}

TEST(Run, CutsAStepThatTheMeshCannotTakeAndKeepsTheSum) {
    const TemporaryFolder folder;
    write(folder.path / "leap.toml", leaping_case());
    const Outcome ended = kropla_program(folder, "run leap.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    const auto time = numbers(steps, "time"), dt = numbers(steps, "dt"),
               attempts = numbers(steps, "attempts");
    EXPECT_GT(std::ranges::max(attempts), 1);
    EXPECT_GT(steps.rows, 1u);
    EXPECT_NEAR(sum(dt), 1e-3, 1e-15);
    EXPECT_NEAR(time.back(), 1e-3, 1e-15);
    for (std::size_t i = 0; i < time.size(); ++i)
        EXPECT_NEAR(std::accumulate(dt.begin(), dt.begin() + static_cast<long>(i) + 1, 0.0), time[i], 1e-15);
    expect_floors_kept(steps, 10);
    expect_valid_so_far(folder.path / "d");
}

TEST(Run, EndsWithThreeWhereTheFloorsCannotBeKept) {
    const TemporaryFolder folder;
    write(folder.path / "land.toml", landing_case());
    const Outcome ended = kropla_program(folder, "run land.toml --out d");
    EXPECT_EQ(ended.code, 3) << ended.err;
    const std::size_t line = ended.err.find('\n') + 1;
    EXPECT_TRUE(ended.err.starts_with(
        "kropla: warning: at t = 1 ms body \"droplet\" is 0.000162 m from the wall z min, 0.27 "
        "of size.surface = 0.0006 m"))
        << ended.err;
    const std::string said = ended.err.substr(line);
    expect_one_line(said, "the mesh cannot go on from t = 9");
    expect_one_line(said, " us body \"droplet\" is ");
    expect_one_line(said, " m from the wall z min, ");
    expect_one_line(said, " would do (cell ");
    expect_one_line(said, ", limit 5)\n");
    const Table steps = read_table(folder.path / "d/steps.csv");
    EXPECT_GT(steps.rows, 2u);
    expect_floors_kept(steps, 5);
    expect_valid_so_far(folder.path / "d");

    const std::string page = contents(folder.path / "d/report.html");
    EXPECT_NE(page.find("Ended early at 9"), std::string::npos);
    EXPECT_NE(page.find(" µs of 1 ms: the mesh cannot go on from t = 9"), std::string::npos);
    EXPECT_NE(page.find("Where it ended"), std::string::npos);
    EXPECT_EQ(kropla_program(folder, "check d/ended.vtu").code, 0);
    EXPECT_EQ(kropla_program(folder, "report d").code, 0);
    EXPECT_EQ(contents(folder.path / "d/report.html"), page);
}

// In a gap of 0.26 of an edge flat cells have R/r 7.
TEST(Run, LeavesAReportIfTheInitialMeshCannotBeMade) {
    const TemporaryFolder folder;
    // A plate 0.3 times as thick as an edge, where edges may not become shorter, and cells have to be better than that.
    std::string text = replaced(landing_case(), "-0.838*t", "0");
    text = replaced(replaced(text, "\"sphere\"", "\"slab\""), "centre = [0.0, 0.0, 0.002]", "min = [-1e-3, -1e-3, 0.002]");
    write(folder.path / "plate.toml", replaced(text, "radius = 0.001", "max = [1e-3, 1e-3, 0.00218]"));
    const Outcome ended = kropla_program(folder, "run plate.toml --out d");
    EXPECT_EQ(ended.code, 3) << ended.err;
    expect_one_line(ended.err, "the initial mesh cannot be made: at t = 0 s ");
    EXPECT_NE(ended.err.find("0.00018 m thick at "), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("0.3 of size.least = 0.0006 m: too thin for the mesh; at most 0.00027 m would do"), std::string::npos) << ended.err;
    const std::string page = contents(folder.path / "d/report.html");
    EXPECT_NE(page.find("Ended early: the initial mesh cannot be made: at t = 0 s "), std::string::npos);
    EXPECT_NE(page.find("Where it ended"), std::string::npos);

    write(folder.path / "high.toml", short_case(1));  // the folder takes another run
    EXPECT_EQ(kropla_program(folder, "run high.toml --out d").code, 0);
    EXPECT_FALSE(std::filesystem::exists(folder.path / "d/ended.toml"));
    EXPECT_NE(contents(folder.path / "d/report.html").find("Finished at"), std::string::npos);
}

// Open MPI has one folder for all processes of a user, that may come and go while one begins. Here it cannot be.
TEST(Run, SharesNoFolderForTemporaryFilesWithOtherRuns) {
    const TemporaryFolder folder;
    write(folder.path / "case.toml", short_case(1));
    std::array<char, 256> host{};
    ASSERT_EQ(gethostname(host.data(), host.size() - 1), 0);
    const std::string name = std::string(host.data());
    std::filesystem::create_directory(folder.path / "tmp");
    write(folder.path / "tmp" / ("ompi." + name.substr(0, name.find('.')) + '.' + std::to_string(getuid())), "");
    const char* before = std::getenv("TMPDIR");
    const std::string kept = before == nullptr ? "" : before;
    setenv("TMPDIR", (folder.path / "tmp").c_str(), 1);
    const Outcome ended = kropla_program(folder, "run case.toml --out d");
    if (before == nullptr) unsetenv("TMPDIR");
    else setenv("TMPDIR", kept.c_str(), 1);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path / "tmp"), {}), 1);
}

// A floor so high that the size of cells is to give way to it.
TEST(Run, KeepsAFloorThatIsHardToKeep) {
    const TemporaryFolder folder;
    write(folder.path / "hard.toml", leaping_case() + "[quality]\nmax_aspect_ratio = 5.3\n");
    const Outcome ended = kropla_program(folder, "run hard.toml --out d");
    EXPECT_EQ(ended.code, 0) << ended.err;
    const Table steps = read_table(folder.path / "d/steps.csv");
    EXPECT_GT(steps.rows, 1u);
    expect_floors_kept(steps, 5.3);
}

TEST(Run, EndsWithFourWhenTheSolverFails) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    const Outcome ended = kropla_program(folder, "run a.toml --out d -ksp_max_it 1");
    EXPECT_EQ(ended.code, 4);
    expect_one_line(ended.err, "did not converge");
    expect_valid_so_far(folder.path / "d");
    EXPECT_NE(contents(folder.path / "d/report.html").find("Ended early at 0 s of "), std::string::npos);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);  // with the usual options
    ASSERT_EQ(kropla_program(folder, "run a.toml --out whole").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

// Found only on the way, as sources are not looked at before.
TEST(Run, EndsWithTwoIfASourceStopsBeingANumber) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(short_case(3), "initial       = 2400.0",
                                           "initial = 2400.0\nsource = \"1e6*sqrt(5e-4 - t)\""));
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 2);
    expect_one_line(ended.err, "source");
    EXPECT_EQ(read_table(folder.path / "d/steps.csv").rows, 2u);
    expect_valid_so_far(folder.path / "d");
}

TEST(Run, EndsWithFiveIfTheFolderCannotBeWritten) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    write(folder.path / "file", "");
    for (const char* out : {"file/below", "/proc/nowhere"}) {
        SCOPED_TRACE(out);
        const Outcome ended = kropla_program(folder, std::string("run a.toml --out ") + out);
        EXPECT_EQ(ended.code, 5);
        expect_one_line(ended.err, out);
    }
}

TEST(Run, EndsWithFiveIfAFrameCannotBeWritten) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    fs::create_directories(folder.path / "d/frames/00002.vtu");  // in the frame's place
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    EXPECT_EQ(ended.code, 5);
    expect_one_line(ended.err, "d/frames/00002.vtu: cannot be written");
    fs::remove(folder.path / "d/frames/00002.vtu");
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    ASSERT_EQ(kropla_program(folder, "run a.toml --out whole").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

TEST(Run, EndsWithFiveIfTheDiskIsFull) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", short_case(3));
    const Outcome before = kropla_program(folder, "run a.toml --out whole");
    ASSERT_EQ(before.code, 0);
    HeldProgram program(folder, {"run", "a.toml", "--out", "d"}, 1, opening_of(before.out));
    ASSERT_TRUE(program.reaches("d", 1));
    program.let_files_grow_to(25000);  // [bytes] enough for the table and not for a frame
    const Outcome ended = program.finish();
    EXPECT_EQ(ended.code, 5);
    expect_one_line(ended.err, "cannot be written");
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

// Twenty times nearer to the floor than a surface size: edges become shorter in the gap.
TEST(Run, ABodyComesDownToAHairAboveTheFloor) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml",
          "[domain]\nmin = [-0.0025, -0.0025, 0.0]\nmax = [0.0025, 0.0025, 0.006]\n"
          "[[body]]\nname = \"drop\"\nshape = \"sphere\"\ncentre = [0, 0, 0.0013]\nradius = 0.001\n"
          "[body.motion]\nz = \"-0.14*t\"\n[size]\nsurface = 0.0004\ngrowth = 0.2\nfar = 0.0008\n"
          "[time]\nend = 0.002\nsteps = 3\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    const auto columns = lasting_columns(folder.path / "d");
    for (const std::string& ratio : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(ratio), 6);
    for (const std::string& volume : columns.at("volume_drop"))
        EXPECT_NEAR(std::stod(volume), 4e-9 / 3 * std::numbers::pi, 1e-12 * 4.19e-9);
}

// At a fifth of a surface size between the spheres, and half of that between the polyhedra, which stand out of them.
TEST(Run, TwoBodiesPassAtAFifthOfASurfaceSize) {
    const TemporaryFolder folder;
    const auto body = [](const std::string& name, const std::string& x, const std::string& z, const std::string& goes) {
        return "[[body]]\nname = \"" + name + "\"\nshape = \"sphere\"\nradius = 0.001\ncentre = [" + x + ", 0, " + z + "]\n" +
               "[body.motion]\nz = \"" + goes + "\"\n[heat.region." + name +
               "]\nconductivity = 35\ndensity = 7000\nspecific_heat = 800\ninitial = 2400\n";
    };
    write(folder.path / "a.toml",
          "[domain]\nmin = [-0.003, -0.003, 0.0]\nmax = [0.003, 0.003, 0.008]\n" +
              body("a", "-0.001", "0.0044", "-t") + body("b", "0.00106", "0.0036", "t") +
              "[heat.region.surroundings]\nconductivity = 0.02\ndensity = 1.6\nspecific_heat = 520\ninitial = 300\n"
              "[size]\nsurface = 3e-4\ngrowth = 0.3\nfar = 1e-3\n[time]\nend = 5e-4\nsteps = 4\n");
    const Outcome ended = kropla_program(folder, "run a.toml --out d");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    const auto columns = lasting_columns(folder.path / "d");
    for (const std::string& ratio : columns.at("max_aspect_ratio")) EXPECT_LE(std::stod(ratio), 6.6);
    for (const std::string& error : columns.at("energy_transfer_error")) EXPECT_LE(std::abs(std::stod(error)), 1e-12);
}

}  // namespace
}  // namespace kropla
