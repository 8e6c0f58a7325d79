#include "report/summary.h"

#include "report/results.h"
#include "report/svg.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
double largest(const std::vector<double>& values) { return *std::ranges::max_element(values); }
double largest_size(const std::vector<double>& values) {
    return std::abs(*std::ranges::max_element(values, {}, [](double x) { return std::abs(x); }));
}
double least(const std::vector<double>& values) { return *std::ranges::min_element(values); }

double median(std::vector<double> values) {
    const auto middle = values.begin() + std::ssize(values) / 2;
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string per_step(const std::vector<double>& seconds) {
    return readable_time(sum(seconds)) + ", per step " + readable_time(median(seconds)) + " (median), " +
           readable_time(largest(seconds)) + " (longest)";
}

std::string percent(double fraction) { return readable(100 * fraction, 3) + " %"; }

std::string from_to(const std::vector<double>& counts) {
    return readable_count(counts.front()) + " at the first step, " + readable_count(counts.back()) +
           " at the last";
}

void add_work(const Table& steps, Figures& rows) {
    for (const auto& [name, column] : {std::pair{"Smoothing sweeps", "smoothing_sweeps"},
                                       {"Swaps", "swaps"},
                                       {"Splits", "splits"},
                                       {"Collapses", "collapses"},
                                       {"Local remeshes", "local_remeshes"},
                                       {"Global remeshes", "global_remeshes"}}) {
        rows.emplace_back(name, readable_count(sum(numbers(steps, column))));
    }
    rows.emplace_back("Largest ring of a local remesh",
                      readable_count(largest(numbers(steps, "largest_ring"))));
    const std::vector<double> touched = numbers(steps, "touched_fraction");
    rows.emplace_back("Cells touched per step",
                      percent(median(touched)) + " (median), " + percent(largest(touched)) + " (most)");
}

/// "rounding, 2e-15", or how much of it.
std::string missed(double share, const std::string& of) {
    return (is_rounding(share, 1) ? "rounding, " + readable(std::abs(share), 2) : readable(share, 2)) + of;
}

/// Conserved fields: their integral, its change over the run, the transfer's largest error.
void add_balances(const Table& steps, Figures& rows) {
    constexpr std::string_view ending = "_integral";
    for (const Column& column : steps.columns) {
        if (!column.name.ends_with(ending)) continue;
        const std::string field = column.name.substr(0, column.name.size() - ending.size());
        const std::vector<double> values = numbers(steps, column.name);
        const double first = values.front(),
                     drift = (values.back() - first) / (first != 0 ? std::abs(first) : 1);
        rows.emplace_back("Stored " + field, with_unit(values.back(), column.unit, 6) +
                                                 " at the last step; change since the first: " +
                                                 missed(drift, first != 0 ? " of it" : ""));
        if (const std::string error = field + "_transfer_error"; has_column(steps, error))
            rows.emplace_back("Largest error of a transfer of " + field,
                              missed(largest_size(numbers(steps, error)), " of it"));
    }
}

}  // namespace

RunSummary summarise_run(const RunFiles& run) {
    RunSummary s;
    if (run.ending) s.ended = run.ending->why;
    if (run.steps.columns.empty()) return s;
    s.end = number_of_case(run.case_text, "time", "end");
    s.floor = number_of_case(run.case_text, "quality", "max_aspect_ratio");
    s.steps = static_cast<int>(run.steps.rows);
    const std::vector<double> aspect = numbers(run.steps, "max_aspect_ratio");
    s.mesh_seconds = sum(numbers(run.steps, "mesh_seconds"));
    s.simulate_seconds = sum(numbers(run.steps, "simulate_seconds"));
    s.transfer_seconds = sum(numbers(run.steps, "transfer_seconds"));
    s.refused = static_cast<int>(sum(numbers(run.steps, "attempts"))) - s.steps;
    if (s.steps == 0) return s;
    s.reached = numbers(run.steps, "time").back();
    const auto worst = std::ranges::max_element(aspect);
    s.worst_aspect_ratio = *worst;
    s.worst_step =
        static_cast<int>(numbers(run.steps, "step")[static_cast<std::size_t>(worst - aspect.begin())]);
    return s;
}

Verdict verdict(const RunSummary& s) {
    const std::string at = readable_time(s.reached);
    if (!s.ended.empty()) {
        const std::string where = s.end ? " at " + at + " of " + readable_time(*s.end) : "";
        return {Verdict::Kind::bad, "Ended early" + where + ": " + s.ended};
    }
    if (s.floor && !(s.worst_aspect_ratio <= *s.floor)) {
        return {Verdict::Kind::bad, "Step " + std::to_string(s.worst_step) + " exceeds the limit of R/r"};
    }
    if (s.steps == 0) return {Verdict::Kind::unfinished, "No step done yet"};
    if (s.end && s.reached < *s.end * (1 - 1e-9)) {
        return {Verdict::Kind::unfinished, "Not finished: at " + at + " of " + readable_time(*s.end)};
    }
    return {Verdict::Kind::good,
            "Finished at " + at + (s.floor ? ", every step within the limit of R/r" : "")};
}

Figures figures(const RunFiles& run, const RunSummary& s) {
    const Table& steps = run.steps;
    Figures rows;
    rows.emplace_back("Steps", readable_count(s.steps) + ", to t = " + readable_time(s.reached));
    rows.emplace_back("Frames", readable_count(static_cast<double>(run.frames.size())));
    if (s.steps == 0) return rows;
    const std::string shortest = readable_time(least(numbers(steps, "dt"))),
                      longest = readable_time(largest(numbers(steps, "dt")));
    rows.emplace_back("Time step", shortest == longest ? longest : shortest + " to " + longest);
    rows.emplace_back("Attempts refused", readable_count(s.refused));
    rows.emplace_back("Vertices", from_to(numbers(steps, "vertices")));
    rows.emplace_back("Tets", from_to(numbers(steps, "tets")));
    if (const auto prisms = numbers(steps, "prisms"); largest(prisms) > 0)
        rows.emplace_back("Prisms", from_to(prisms));
    rows.emplace_back("Worst aspect ratio R/r", readable(s.worst_aspect_ratio, 4) + " (step " +
                                                    std::to_string(s.worst_step) + "); 3 is perfect");
    rows.emplace_back("99.9 % of cells below",
                      "R/r = " + readable(largest(numbers(steps, "p999_aspect_ratio")), 4));
    rows.emplace_back("Dihedral angles", readable(least(numbers(steps, "min_dihedral")), 3) + "° to " +
                                             readable(largest(numbers(steps, "max_dihedral")), 4) + "°");
    add_work(steps, rows);
    rows.emplace_back("Mesh", per_step(numbers(steps, "mesh_seconds")));
    rows.emplace_back("Simulation", per_step(numbers(steps, "simulate_seconds")));
    rows.emplace_back("Transfer", per_step(numbers(steps, "transfer_seconds")));
    add_balances(steps, rows);
    return rows;
}

}  // namespace kropla
