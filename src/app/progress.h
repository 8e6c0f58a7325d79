#pragma once

#include <chrono>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

namespace kropla {

/// What the progress line says of a step.
struct ProgressRow {
    int step = 0, steps = 0;        // this one, and how many there will be
    double time = 0;                // reached [s]
    double worst_aspect_ratio = 0;  // [-] R/r
    std::string rung;  // the highest rung of the repair ladder that was needed: "smooth", "swap", ...
    double touched_fraction = 0;         // [-] of the cells
    double mesh_seconds = 0;             // of this step
    std::optional<double> heat_seconds;  // of this step; nothing: no heat in the case
    std::optional<double> flow_seconds = {};  // of this step; nothing: no flow, or in the seconds of the heat
    std::string bodies;  // "droplet 2,391 K" or "sphere 101 mm/s"; empty: nothing to tell
    double seconds_left = 0;             // of the run, estimated
};

/// One line without its end: `step 12/50  t 2.40 ms  worst R/r 5.8  swap  touched 7.3 %  mesh 0.08 s ...`.
/// Columns stand under each other from step to step.
[[nodiscard]] std::string progress_line(const ProgressRow& row);

/// A duration in the unit that suits it, from fs to years, three digits: "2.40 ms". Where none does, in seconds with an
/// exponent.
[[nodiscard]] std::string spoken_time(double seconds);
/// What is left, as "0:08", "12:30" or "3:05:00".
[[nodiscard]] std::string clock_time(double seconds);

/// A count with its thousands apart: "74,364".
[[nodiscard]] std::string spoken_count(double count);
/// A quantity [SI] in the unit that suits it, three digits, in letters that any terminal knows: "3 um/s".
[[nodiscard]] std::string spoken_quantity(double value, const char* si);
/// A text in such letters.
[[nodiscard]] std::string plain(std::string text);

/// Writes progress lines: on a terminal one that is written over, else one under the other. That they cannot be
/// written, as the disk is full, ends nothing: the stream knows it (`std::ferror`).
class Progress {
public:
    explicit Progress(std::FILE* out = stdout);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    [[nodiscard]] bool on_terminal() const { return terminal_; }
    void show(const ProgressRow& row);
    /// How far the initial mesh is: "initial mesh: relaxing points  40 %"; not on a terminal, a line per stage.
    void show_stage(std::string_view stage, double share);
    /// A line that stays.
    void say(std::string_view line);
    /// Leaves the line that stands, so that something else may be printed.
    void finish();

private:
    void write_over(std::string line);
    void print(std::string_view text);

    std::FILE* out_;
    bool terminal_;
    std::size_t standing_ = 0;  // characters of the line that the next one will be written over
    std::string stage_;         // shown last, and when
    std::chrono::steady_clock::time_point stage_shown_ = {};
};

}  // namespace kropla
