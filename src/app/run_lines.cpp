#include "app/run_lines.h"

#include "app/progress.h"
#include <kropla/mesh/quality.h>

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <algorithm>

namespace kropla {
namespace {

int threads() {
    using oneapi::tbb::global_control;
    const auto allowed = global_control::active_value(global_control::max_allowed_parallelism);
    return std::min(static_cast<int>(allowed), oneapi::tbb::info::default_concurrency());
}

/// "1 step", "1,000 steps".
std::string counted(std::int64_t count, const char* what) {
    return fmt::format("{} {}{}", spoken_count(static_cast<double>(count)), what, count == 1 ? "" : "s");
}

/// To two digits, as it is an estimate.
std::string spoken_estimate(double count) { return spoken_count(std::stod(fmt::format("{:.1e}", count))); }

}  // namespace

std::string opening_line(const RunOptions& options, const Case& it) {
    return fmt::format("{}: about {} tets, {} to {}, {}", options.case_file.string(),
                       spoken_estimate(estimate_tets(it.domain)), counted(it.time.steps, "step"),
                       spoken_time(it.time.end), counted(threads(), "thread"));
}

std::string mesh_line(const Mesh& mesh, double seconds) {
    const QualitySummary quality = summarise_quality(mesh);
    return fmt::format("initial mesh: {} tets, {} vertices, worst R/r {:.2f}, in {:.2f} s", spoken_count(quality.tets),
                       spoken_count(quality.vertices), quality.max_aspect_ratio, seconds);
}

std::string closing_line(const RunOptions& options, std::int64_t step, double time, double seconds) {
    return fmt::format("done: {} to {} in {}; see {}, or paraview {}", counted(step, "step"), spoken_time(time),
                       clock_time(seconds), (options.out / "report.html").string(),
                       (options.out / "frames.pvd").string());
}

}  // namespace kropla
