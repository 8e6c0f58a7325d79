#include "app/progress.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

namespace kropla {
namespace {

const ProgressRow row{.step = 12,
                      .steps = 50,
                      .time = 2.4e-3,
                      .worst_aspect_ratio = 5.8,
                      .rung = "swap",
                      .touched_fraction = 0.073,
                      .mesh_seconds = 0.08,
                      .heat_seconds = 0.12,
                      .bodies = {},
                      .seconds_left = 7.6};

TEST(Progress, SaysWhatAStepDid) {
    EXPECT_EQ(progress_line(row),
              "step 12/50  t 2.40 ms  worst R/r  5.8  swap      touched  7.3 %  mesh  0.08 s  "
              "heat  0.12 s  left 0:08");
    ProgressRow without = row;
    without.heat_seconds = {};
    EXPECT_EQ(progress_line(without),
              "step 12/50  t 2.40 ms  worst R/r  5.8  swap      touched  7.3 %  mesh  0.08 s  "
              "left 0:08");
}

TEST(Progress, SaysOfAFlowItsSecondsAndWhatBodiesDo) {
    ProgressRow flowing = row;
    flowing.heat_seconds = {};
    flowing.flow_seconds = 0.3;
    flowing.bodies = "sphere 0.101 m/s";
    EXPECT_EQ(progress_line(flowing),
              "step 12/50  t 2.40 ms  worst R/r  5.8  swap      touched  7.3 %  mesh  0.08 s  "
              "flow  0.30 s  sphere 0.101 m/s  left 0:08");
    EXPECT_EQ(spoken_quantity(0.1014, "m/s"), "0.101 m/s");
    EXPECT_EQ(spoken_quantity(-2.5e-5, "m/s"), "-25 um/s");
}

TEST(Progress, ColumnsStandUnderEachOther) {
    ProgressRow other = row;
    other.step = 3;
    other.time = 12e-3;
    other.worst_aspect_ratio = 10;
    other.rung = "remesh";
    other.touched_fraction = 0.2;
    other.mesh_seconds = 12.5;
    EXPECT_EQ(progress_line(other).find("left"), progress_line(row).find("left"));
}

TEST(Progress, SpeaksOfTimeInUnitsThatSuit) {
    EXPECT_EQ(spoken_time(0), "0.00 s");
    EXPECT_EQ(spoken_time(2.4e-3), "2.40 ms");
    EXPECT_EQ(spoken_time(9.9996e-4), "1.00 ms");
    EXPECT_EQ(spoken_time(1.25e-5), "12.5 us");
    EXPECT_EQ(spoken_time(3), "3.00 s");
    EXPECT_EQ(spoken_time(250), "250 s");
    EXPECT_EQ(spoken_time(5e-10), "500 ps");
    EXPECT_EQ(spoken_time(9.996e-13), "1.00 ps");
    EXPECT_EQ(spoken_time(-2e-14), "-20.0 fs");
    EXPECT_EQ(spoken_time(3.2e-17), "3.20e-17 s");
    EXPECT_EQ(spoken_time(999), "999 s");
    EXPECT_EQ(spoken_time(1200), "20.0 min");
    EXPECT_EQ(spoken_time(86400), "24.0 h");
    EXPECT_EQ(spoken_time(4e6), "46.3 d");
    EXPECT_EQ(spoken_time(1e9), "31.7 yr");
    EXPECT_EQ(spoken_time(1e11), "1.00e+11 s");
    EXPECT_EQ(spoken_count(7), "7");
    EXPECT_EQ(spoken_count(74364), "74,364");
    EXPECT_EQ(spoken_count(2e7), "20,000,000");
    EXPECT_EQ(clock_time(7.6), "0:08");
    EXPECT_EQ(clock_time(750), "12:30");
    EXPECT_EQ(clock_time(11100), "3:05:00");
}

/// Everything that is to be read from a descriptor now.
std::string drained(int descriptor) {
    std::string text;
    std::array<char, 4096> part;
    for (ssize_t n; (n = read(descriptor, part.data(), part.size())) > 0;) {
        text.append(part.data(), static_cast<std::size_t>(n));
    }
    return text;
}

TEST(Progress, WritesPlainLinesIntoAFile) {
    std::FILE* file = std::tmpfile();
    ASSERT_NE(file, nullptr);
    {
        Progress progress(file);
        progress.show(row);
        progress.show(row);
    }
    std::rewind(file);
    EXPECT_EQ(drained(fileno(file)), progress_line(row) + "\n" + progress_line(row) + "\n");
    std::fclose(file);
}

TEST(Progress, WritesALinePerStageIntoAFile) {
    std::FILE* file = std::tmpfile();
    ASSERT_NE(file, nullptr);
    {
        Progress progress(file);
        for (const double share : {0.0, 0.5}) progress.show_stage("relaxing points", share);
        progress.show_stage("joining cells", 0);
        progress.say("initial mesh: made");
    }
    std::rewind(file);
    EXPECT_EQ(drained(fileno(file)), "initial mesh: relaxing points\ninitial mesh: joining cells\ninitial mesh: made\n");
    std::fclose(file);
}

TEST(Progress, WritesOverItsLineOnATerminal) {
    const int reader = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);  // a terminal of our own
    if (reader < 0 || grantpt(reader) != 0 || unlockpt(reader) != 0)
        GTEST_SKIP() << "no pseudo-terminals here";
    std::FILE* terminal = std::fopen(ptsname(reader), "w");
    ASSERT_NE(terminal, nullptr);
    const winsize wide{.ws_row = 24, .ws_col = 200, .ws_xpixel = 0, .ws_ypixel = 0};
    ASSERT_EQ(ioctl(reader, TIOCSWINSZ, &wide), 0);
    ProgressRow shorter = row;
    shorter.heat_seconds = {};
    {
        Progress progress(terminal);
        progress.show(row);
        progress.show(shorter);
    }
    std::string expected("\r");
    expected += progress_line(row) + "\r" + progress_line(shorter);
    expected.append(progress_line(row).size() - progress_line(shorter).size(), ' ');
    EXPECT_EQ(drained(reader), expected + "\r\n");
    std::fclose(terminal);
    close(reader);
}

}  // namespace
}  // namespace kropla
