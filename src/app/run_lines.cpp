#include "app/run_lines.h"

#include "app/progress.h"
#include <kropla/mesh/quality.h>
#include "report/results.h"
#include "report/summary.h"
#include "report/units.h"

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr std::size_t most_bodies = 2;  // as the progress line has

int threads() {
    using oneapi::tbb::global_control;
    const auto allowed = global_control::active_value(global_control::max_allowed_parallelism);
    return std::min(static_cast<int>(allowed), oneapi::tbb::info::default_concurrency());
}

/// "1 step", "1,000 steps".
std::string counted(std::int64_t count, const char* what) {
    return fmt::format("{} {}{}", spoken_count(static_cast<double>(count)), what, count == 1 ? "" : "s");
}

std::string counted_bodies(std::size_t count) { return fmt::format("{} {}", count, count == 1 ? "body" : "bodies"); }

/// "2,391 K", with as many digits behind the point as asked for.
std::string spoken_temperature(double kelvin, int decimals) {
    const std::string text = fixed(kelvin, decimals);
    const std::size_t point = std::min(text.find('.'), text.size());
    return spoken_count(std::stod(text.substr(0, point))) + text.substr(point) + " K";
}

/// How warm a body has become, and what it gave off.
std::string heat_of(const BodyResult& body, const RunResults& results) {
    const double before = *body.start_mean, after = body.mean.back();
    const int decimals = decimals_to_tell(before, after);
    std::string text = fmt::format("{} in the mean ({} at the {})", spoken_temperature(after, decimals),
                                   spoken_temperature(before, decimals), results.start_known ? "start" : "first step");
    if (results.energy && is_rounding(body.given_off, results.energy->size)) return text;
    const bool conducts_only = !results.energy || is_rounding(results.energy->surfaces, results.energy->size);
    return text + fmt::format(", {} {}{}", body.given_off > 0 ? "gave off" : "took up",
                              spoken_quantity(std::abs(body.given_off), "J"),
                              conducts_only ? "" : " by conduction");
}

std::string body_line(const BodyResult& body, const RunResults& results) {
    const std::string heat = body.mean.empty() ? "" : heat_of(body, results) + ", ";
    const bool goes = moves(body);
    const bool in_a_flow = !body.force.empty();
    const std::string speed =
        goes && in_a_flow ? ", going at " + spoken_quantity(norm(body.velocity.back()), "m/s") : "";
    return fmt::format("{}: {}{} {}{}", body.name, heat, goes ? "now at" : "still at",
                       plain(place_with_unit(body.place.back(), length_scale(body))), speed);
}

/// ", 1.3 J in through faces"; nothing if it is none.
std::string brought(double joules, const char* how, const EnergyBalance& energy) {
    if (is_rounding(joules, energy.size)) return "";
    return fmt::format(", {} {} {}", spoken_quantity(std::abs(joules), "J"), joules > 0 ? "in" : "out", how);
}

std::string energy_line(const EnergyBalance& energy) {
    const std::string flows =
        brought(energy.faces, "through faces", energy) + brought(energy.sources, "by sources", energy) +
        brought(energy.surfaces, "at surfaces of bodies", energy) + brought(energy.held, "by what is held", energy) +
        brought(energy.expansion, "as volumes change", energy);
    const double error = std::abs(energy.relative_error());
    const std::string to = error > 0 ? fmt::format("to {:.0e}", error) : "to the last digit";
    return fmt::format("energy: {} stored{}, {} {}", spoken_quantity(energy.end, "J"), flows,
                       flows.empty() ? "kept" : "balanced", to);
}

/// To two digits, as it is an estimate.
std::string spoken_estimate(double count) { return spoken_count(std::stod(fmt::format("{:.1e}", count))); }

}  // namespace

std::string opening_line(const RunOptions& options, const Case& given) {
    return fmt::format("{}: about {} tets, {} to {}, {}", options.case_file.string(),
                       spoken_estimate(given.mesh ? count_tets(*given.mesh->mesh) : estimate_tets(given.domain)), counted(given.time.steps, "step"),
                       spoken_time(given.time.end), counted(threads(), "thread"));
}

std::string mesh_line(const Mesh& mesh, double seconds) {
    const QualitySummary quality = summarise_quality(mesh);
    return fmt::format("initial mesh: {} tets, {} vertices, worst R/r {:.2f}, in {:.2f} s", spoken_count(quality.tets),
                       spoken_count(quality.vertices), quality.max_aspect_ratio, seconds);
}

std::vector<std::string> closing_lines(const std::filesystem::path& folder, double seconds) {
    const RunFiles run = read_run_files(folder);
    const RunSummary summary = summarise_run(run);
    const RunResults results = results_of(run);
    std::vector<std::string> lines;
    lines.push_back(fmt::format("done: {} to {} in {}, worst R/r {:.1f}", counted(summary.steps, "step"),
                                spoken_time(summary.reached), clock_time(seconds), summary.worst_aspect_ratio));
    const std::size_t count = results.bodies.size();
    for (std::size_t body = 0; body < std::min(most_bodies, count); ++body)
        lines.push_back(body_line(results.bodies[body], results));
    if (count > most_bodies) lines.push_back(fmt::format("and {} more", counted_bodies(count - most_bodies)));
    if (results.energy) lines.push_back(energy_line(*results.energy));
    lines.push_back(fmt::format("see {}, or paraview {}", (folder / "report.html").string(),
                                (folder / "frames.pvd").string()));
    return lines;
}

}  // namespace kropla
