#pragma once

#include "report/run_files.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kropla {

/// A run in a few figures, from its steps and its case.
struct RunSummary {
    int steps = 0;
    double reached = 0;             // [s]
    std::optional<double> end;      // [s] wanted; nothing: the case does not say
    std::optional<double> floor;    // [-] the largest R/r allowed
    double worst_aspect_ratio = 0;  // [-] of all steps; 0 without steps
    int worst_step = 0;             // where it was
    int refused = 0;                // attempts
    std::string ended;              // why the run ended early; empty if it did not
    double mesh_seconds = 0, simulate_seconds = 0, transfer_seconds = 0;  // [s] of the whole run
};
/// Without steps.csv the times and counts are 0. Throws FileError if steps.csv lacks a column or holds what is no number.
[[nodiscard]] RunSummary summarise_run(const RunFiles& run);

struct Verdict {
    enum class Kind { good, unfinished, bad } kind;
    std::string text;
};
[[nodiscard]] Verdict verdict(const RunSummary& summary);

/// The run's figures, by name, as text.
using Figures = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] Figures figures(const RunFiles& run, const RunSummary& summary);

}  // namespace kropla
