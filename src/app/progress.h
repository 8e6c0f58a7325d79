#pragma once

#include <cstdio>
#include <optional>
#include <string>

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
    double seconds_left = 0;             // of the run, estimated
};

/// One line without its end: `step 12/50  t 2.40 ms  worst R/r 5.8  swap  touched 7.3 %  mesh 0.08 s ...`.
/// Columns stand under each other from step to step.
[[nodiscard]] std::string progress_line(const ProgressRow& row);

/// A duration in the unit that suits it, three digits: "2.40 ms".
[[nodiscard]] std::string spoken_time(double seconds);
/// What is left, as "0:08", "12:30" or "3:05:00".
[[nodiscard]] std::string clock_time(double seconds);

/// Writes progress lines: on a terminal one that is written over, else one under the other.
class Progress {
public:
    explicit Progress(std::FILE* out = stdout);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const ProgressRow& row);
    /// Leaves the line that stands, so that something else may be printed.
    void finish();

private:
    std::FILE* out_;
    bool terminal_;
    std::size_t standing_ = 0;  // characters of the line that the next one will be written over
};

}  // namespace kropla
