#pragma once

#include "case/case_text.h"
#include "program.h"
#include "report/table.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace kropla {

/// The quick case, its first steps alone.
inline std::string short_case(int steps = 4, int every = 1) {
    std::string text = contents(std::filesystem::path(KROPLA_CASES) / "quick.toml");
    text = replaced(text, "end   = 0.002\n", "end   = " + std::to_string(2 * steps) + "e-4\n");
    text = replaced(text, "steps = 10\n", "steps = " + std::to_string(steps) + "\n");
    return text + "[output]\nevery = " + std::to_string(every) + "\n";
}

/// A droplet that falls five times its radius, wanted in one step: far more than its mesh can take at once.
inline std::string leaping_case() {
    std::string text = replaced(short_case(1), "0.0025, -0.0025", "0.002, -0.002");
    text = replaced(text, "0.0025,  0.0025, 0.006", "0.002,  0.002, 0.009");
    text = replaced(text, "end   = 2e-4", "end   = 1e-3");
    text = replaced(text, "centre = [0.0, 0.0, 0.0038]", "centre = [0.0, 0.0, 0.0072]");
    text = replaced(text, "\"0.0002*sin(2*pi*t/0.002)\"", "0");
    text = replaced(text, "-0.8*t", "-5*t");
    text = replaced(text, "surface = 4e-4", "surface = 6e-4");
    return replaced(text, "far     = 8e-4", "far     = 1e-3");
}

/// A droplet that falls until 0.18 of an edge are left above the bottom, where edges may not become shorter: for the least
/// of all floors too narrow.
inline std::string landing_case() {
    const std::string text = replaced(leaping_case(), "0.002,  0.002, 0.009", "0.002,  0.002, 0.004");
    return replaced(replaced(replaced(text, "0.0072", "0.002"), "-5*t", "-0.838*t"), "surface = 6e-4",
                    "surface = 6e-4\nleast = 6e-4") + "[quality]\nmax_aspect_ratio = 5\n";
}

/// The frames of a run's folder, by name.
inline std::map<std::string, std::string> frames(const std::filesystem::path& run) {
    std::map<std::string, std::string> found;
    for (const auto& file : std::filesystem::directory_iterator(run / "frames"))
        found[file.path().filename().string()] = contents(file.path());
    return found;
}

/// The columns of steps.csv that are the same on every machine and in every run: all but the times it took.
inline std::map<std::string, std::vector<std::string>> lasting_columns(const std::filesystem::path& run) {
    std::map<std::string, std::vector<std::string>> found;
    for (const Column& column : read_table(run / "steps.csv").columns)
        if (!column.name.ends_with("_seconds")) found[column.name] = column.cells;
    return found;
}

/// How much a run said before its first step.
inline std::size_t opening_of(const std::string& out) { return out.find("\nstep ") + 1; }

/// The same case went the same way: the frames byte for byte, the table but for the times it took.
inline void expect_same_run(const std::filesystem::path& a, const std::filesystem::path& b) {
    EXPECT_EQ(lasting_columns(a), lasting_columns(b));
    EXPECT_EQ(contents(a / "frames.pvd"), contents(b / "frames.pvd"));
    EXPECT_EQ(contents(a / "case.toml"), contents(b / "case.toml"));
    EXPECT_TRUE(frames(a) == frames(b));  // not to print them
}

/// One line that starts as all of ours do, and has `part` in it.
inline void expect_one_line(const std::string& err, const std::string& part) {
    EXPECT_TRUE(err.starts_with("kropla: ")) << err;
    EXPECT_EQ(err.find('\n'), err.size() - 1) << err;
    EXPECT_NE(err.find(part), std::string::npos) << err;
}

}  // namespace kropla
