// Runs that were stopped in the middle and went on: the end is the same as without.
#include "held_program.h"
#include <kropla/io/pvd.h>
#include "run_results.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

std::size_t opening = 0;  // what the whole run said before its first step
std::string results;      // and at its end, of what came out

/// What a run said at its end, but for how long it took and where it is.
std::string results_said(const std::string& out) {
    const std::size_t begin = out.find("\ndroplet: ");
    return begin == std::string::npos ? "" : out.substr(begin, out.find("\nsee ") - begin);
}

/// The case, run without a stop: the folder "whole".
void run_whole(const TemporaryFolder& folder, const std::string& text) {
    write(folder.path / "a.toml", text);
    const Outcome ended = kropla_program(folder, "run a.toml --out whole");
    ASSERT_EQ(ended.code, 0);
    opening = opening_of(ended.out);
    results = results_said(ended.out);
    ASSERT_NE(results, "");
}

/// Begins the case in the folder "d" and sends the signal in the step `at`, after its frame, if it has one.
Outcome stopped(const TemporaryFolder& folder, int at, int signal) {
    HeldProgram program(folder, {"run", "a.toml", "--out", "d"}, at - 1, opening);
    EXPECT_TRUE(program.reaches("d", at));
    const std::string frame = "frames/0000" + std::to_string(at) + ".vtu";
    if (fs::exists(folder.path / "whole" / frame)) {
        EXPECT_TRUE(program.writes("d/" + frame));
    }
    program.signal(signal);
    return program.finish();
}

std::size_t rows(const TemporaryFolder& folder) { return read_table(folder.path / "d/steps.csv").rows; }

TEST(Resume, EqualsTheWholeRunAfterAnInterrupt) {
    for (const int every : {1, 3}) {
        SCOPED_TRACE(every);
        const TemporaryFolder folder;
        run_whole(folder, short_case(5, every));
        for (const int signal : {SIGINT, SIGTERM}) {
            const Outcome ended = stopped(folder, 2, signal);
            EXPECT_EQ(ended.code, 130);
            EXPECT_EQ(ended.err, "");
            EXPECT_TRUE(ended.out.ends_with("\ninterrupted: a checkpoint is written; go on with --resume\n"))
                << ended.out;
            EXPECT_EQ(rows(folder), 2u);
            EXPECT_EQ(read_pvd(folder.path / "d/frames.pvd").size(), every == 1 ? 3u : 1u);
            const Outcome rest = kropla_program(folder, "run a.toml --out d --resume");
            EXPECT_EQ(rest.code, 0);
            EXPECT_EQ(results_said(rest.out), results);
            expect_same_run(folder.path / "d", folder.path / "whole");
            fs::remove_all(folder.path / "d");
        }
    }
}

TEST(Resume, EqualsTheWholeRunAfterSuddenDeath) {
    for (const int every : {1, 3}) {
        SCOPED_TRACE(every);
        const TemporaryFolder folder;
        run_whole(folder, short_case(5, every));
        const Outcome ended = stopped(folder, 4, SIGKILL);
        EXPECT_EQ(ended.code, -1);
        EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
        expect_same_run(folder.path / "d", folder.path / "whole");
    }
}

TEST(Resume, GoesOnWithStepsThatWereCut) {
    const TemporaryFolder folder;
    run_whole(folder, leaping_case());
    ASSERT_EQ(stopped(folder, 1, SIGINT).code, 130);
    EXPECT_EQ(rows(folder), 1u);
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

// The program died when rows and frames were written and the checkpoint was not.
TEST(Resume, DropsWhatIsBeyondTheCheckpoint) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(4));
    ASSERT_EQ(stopped(folder, 2, SIGINT).code, 130);
    for (const char* name : {"steps.csv", "frames.pvd", "frames/00003.vtu", "frames/00004.vtu"})
        fs::copy_file(folder.path / "whole" / name, folder.path / "d" / name,
                      fs::copy_options::overwrite_existing);
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume -ksp_max_it 1").code,
              4);  // not a step further
    EXPECT_EQ(rows(folder), 2u);
    EXPECT_EQ(read_pvd(folder.path / "d/frames.pvd").size(), 3u);
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

/// As a run leaves it that was interrupted while it wrote its last frame.
void take_last_frame(const fs::path& run) {
    std::vector<SeriesEntry> series = read_pvd(run / "frames.pvd");
    fs::remove(run / series.back().file);
    series.pop_back();
    write_pvd(run / "frames.pvd", series);
}

TEST(Resume, WritesTheFrameThatIsOwed) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(4, 2));
    for (const int at : {1, 2}) {
        SCOPED_TRACE(at);
        ASSERT_EQ(stopped(folder, at, SIGINT).code, 130);
        if (at == 2) take_last_frame(folder.path / "d");
        EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
        expect_same_run(folder.path / "d", folder.path / "whole");
        fs::remove_all(folder.path / "d");
    }
    fs::copy(folder.path / "whole", folder.path / "d", fs::copy_options::recursive);
    take_last_frame(folder.path / "d");
    EXPECT_EQ(kropla_program(folder, "run a.toml --out d --resume").code, 0);
    expect_same_run(folder.path / "d", folder.path / "whole");
}

// A source that no quadrature comes to an end with: the signal meets the step in the middle of it.
TEST(Resume, FindsAStepDroppedThatWasInterruptedInItsSources) {
    const TemporaryFolder folder;
    write(folder.path / "a.toml", replaced(short_case(2), "[output]", "source = \"sin(1e13*t)\"\n[output]"));
    HeldProgram program(folder, {"run", "a.toml", "--out", "d"}, 10, 0);
    ASSERT_TRUE(program.writes("d/frames/00000.vtu"));
    ASSERT_FALSE(program.ends_within(1));
    program.signal(SIGTERM);
    ASSERT_TRUE(program.ends_within(20));
    EXPECT_EQ(program.finish().code, 130);
    EXPECT_EQ(rows(folder), 0u);
    EXPECT_EQ(read_pvd(folder.path / "d/frames.pvd").size(), 1u);
    EXPECT_TRUE(fs::exists(folder.path / "d/checkpoint.h5"));
    EXPECT_NE(contents(folder.path / "d/report.html").find("as the run was interrupted"), std::string::npos);
}

TEST(Resume, OfAFinishedRunChangesNothing) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(2));
    fs::copy(folder.path / "whole", folder.path / "d", fs::copy_options::recursive);
    const Outcome ended = kropla_program(folder, "run a.toml --out d --resume");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.out, "d: the run is finished: step 2 at 400 us; nothing was done. With a later time.end it goes on\n");
    expect_same_run(folder.path / "d", folder.path / "whole");
    for (const char* name : {"steps.csv", "checkpoint.h5"})
        EXPECT_EQ(contents(folder.path / "d" / name), contents(folder.path / "whole" / name)) << name;
}

TEST(Resume, RefusesAnotherCase) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(2));
    const std::pair<std::string, std::string> others[] = {
        {replaced(short_case(2), "surface = 4e-4", "surface = 3e-4"),
         "b.toml: size.surface: is 0.0003 here, but 0.0004 in the run that whole holds"},
        {replaced(short_case(2), "-0.8*t", "-0.9*t"), "b.toml: body[0].motion.z: is -0.9*t here, but -0.8*t in the run"},
        {short_case(2) + "[random]\nseed = 3\n", "b.toml: random.seed: is 3 here, but 1 in the run"},
        {replaced(short_case(2), "steps = 2", "steps = 4"),
         "b.toml: time.steps: 4 make steps of 0.0001 s, those of the run so far are of 0.0002 s; 2 does"},
        {replaced(short_case(2), "end   = 4e-4", "end   = 2e-4"),
         "b.toml: time.end: 0.0002 is past already: the run has reached 0.0004; a later one does"}};
    for (const auto& [text, complaint] : others) {
        write(folder.path / "b.toml", text);
        const Outcome ended = kropla_program(folder, "run b.toml --out whole --resume");
        EXPECT_EQ(ended.code, 2);
        expect_one_line(ended.err, complaint);
        EXPECT_EQ(read_table(folder.path / "whole/steps.csv").rows, 2u);
    }
}

// A longer run of steps of the same length is the same as one that was longer from the beginning: with the count of
// steps given anew, and with the count left as it was; twice, as the case given then is remembered.
TEST(Resume, GoesOnToALaterEnd) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(4));
    write(folder.path / "b.toml", short_case(2));
    const std::string longer = replaced(short_case(2), "end   = 4e-4", "end   = 8e-4");
    for (const std::string& text : {short_case(4), longer}) {
        ASSERT_EQ(kropla_program(folder, "run b.toml --out d").code, 0);
        write(folder.path / "c.toml", text);
        const Outcome ended = kropla_program(folder, "run c.toml --out d --resume");
        EXPECT_EQ(ended.code, 0) << ended.err;
        expect_same_run(folder.path / "d", folder.path / "whole");
        EXPECT_EQ(kropla_program(folder, "run c.toml --out d --resume").code, 0);
        fs::remove_all(folder.path / "d");
    }
}

TEST(Resume, TakesTheSameCaseInOtherWords) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(4));
    write(folder.path / "b.toml", short_case(2));
    ASSERT_EQ(kropla_program(folder, "run b.toml --out d").code, 0);
    write(folder.path / "c.toml", replaced(replaced(replaced(short_case(4, 3), "\"-0.8*t\"", "\" -0.8 * t\""),
                                                    "surface = 4e-4", "surface = 0.0004"),
                                           "far     = 8e-4", "far = 8.0e-04"));
    EXPECT_EQ(kropla_program(folder, "run c.toml --out d --resume").code, 0);
    EXPECT_EQ(lasting_columns(folder.path / "d"), lasting_columns(folder.path / "whole"));
    EXPECT_EQ(frames(folder.path / "d").size(), 5u);  // 0, 1, 2; from here on each third, and the last
}

TEST(Resume, RefusesADamagedCheckpoint) {
    const TemporaryFolder folder;
    run_whole(folder, short_case(2));
    const fs::path checkpoint = folder.path / "whole/checkpoint.h5";
    fs::resize_file(checkpoint, fs::file_size(checkpoint) / 2);
    const Outcome ended = kropla_program(folder, "run a.toml --out whole --resume");
    EXPECT_EQ(ended.code, 5);
    expect_one_line(ended.err, "checkpoint.h5: is truncated");
}

}  // namespace
}  // namespace kropla
