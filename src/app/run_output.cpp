#include "app/run_output.h"

#include "app/body_sizes.h"
#include "app/ending.h"
#include "app/flow_fields.h"
#include "app/run_folder.h"
#include "app/species_fields.h"
#include "app/step_row.h"
#include <kropla/base/error.h>
#include "io/file.h"
#include <kropla/io/vtk.h>
#include "report/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <cmath>

namespace kropla {
namespace {

constexpr std::size_t most_bodies = 2;  // of which the progress line speaks: the first

/// The mean temperature of each body.
std::string temperatures(const StepReport& report, const Case& given) {
    std::string text;
    for (std::size_t body = 0; body < std::min(most_bodies, report.bodies.size()); ++body)
        text += fmt::format("{}{} {} K", body == 0 ? "" : ", ", given.domain.bodies[body].name,
                            spoken_count(std::round(report.bodies[body].mean)));
    return text;
}

/// The speed of each body that moves, as a mean over the step.
std::string speeds(const StepReport& report, const Case& given) {
    std::string text;
    for (std::size_t body = 0; body < std::min(most_bodies, report.velocities.size()); ++body) {
        const double speed = norm(report.velocities[body]);
        if (is_rounding(speed * report.mesh.dt, norm(given.domain.box.max - given.domain.box.min))) continue;
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", given.domain.bodies[body].name,
                            spoken_quantity(speed, "m/s"));
    }
    return text;
}

std::string frame_name(std::int64_t step) { return fmt::format("frames/{:05}.vtu", step); }

/// The columns of a run's table.
StepRow columns(const Case& given, const Mesh& mesh) { return step_row(0, {}, mesh, {}, given); }

/// The highest rung of the repair ladder that was climbed.
const char* rung(const Changes& c) {
    if (c.global_remeshes > 0) return "region";
    if (c.local_remeshes > 0) return "cluster";
    if (c.splits + c.collapses > 0) return "refine";
    if (c.swaps > 0) return "swap";
    if (c.smoothing_sweeps > 0) return "smooth";
    return "-";
}

}  // namespace

bool has_frame(const std::filesystem::path& folder, std::int64_t step) {
    const std::vector<SeriesEntry> series = read_pvd(folder / "frames.pvd");
    return std::ranges::any_of(series, [&](const SeriesEntry& frame) { return frame.file == frame_name(step); });
}

RunOutput::RunOutput(const RunOptions& options, const Case& given, bool speak, std::int64_t step,
                     const State& state, Progress& progress)
    : overwrite_(options.force), folder_(options.out), given_(given), speak_(speak), progress_(progress) {
    if (!speak_) return;
    forget_end(folder_);
    if (options.resume) go_on(step, state);
    else start(state);
}

void RunOutput::start(const State& state) {
    const Mesh& mesh = state.moving.reference();
    const auto* temperature = given_.heat ? &state.fields.front().values : nullptr;
    if (overwrite_) clear_run_folder(folder_);
    std::error_code trouble;
    std::filesystem::create_directories(folder_ / "frames", trouble);
    if (trouble) throw FileError(fmt::format("{}: cannot be made: {}", folder_.string(), trouble.message()));
    write_file(folder_ / "case.toml", to_toml(given_));
    write_bodies(folder_ / "bodies.csv", body_sizes(given_.domain, mesh), body_states(given_.domain, mesh, temperature),
                 given_.heat.has_value());
    table_.emplace(folder_ / "steps.csv", columns(given_, mesh));
    write_pvd(folder_ / "frames.pvd", series_);
}

void RunOutput::go_on(std::int64_t step, const State& state) {
    table_.emplace(folder_ / "steps.csv", columns(given_, state.moving.reference()), static_cast<int>(step));
    series_ = read_pvd(folder_ / "frames.pvd");
    std::erase_if(series_, [&](const SeriesEntry& frame) { return frame.time > state.moving.time(); });
    write_pvd(folder_ / "frames.pvd", series_);
    write_file(folder_ / "case.toml", to_toml(given_));  // its end, or how often frames are written, may be another
}

void RunOutput::write_step(std::int64_t step, const StepReport& report, const State& state) {
    if (!speak_) return;
    const Mesh& mesh = state.moving.reference();
    quality_ = summarise_quality(mesh);
    table_->append(step_row(step, report, mesh, *quality_, given_));
}

void RunOutput::write_frame(std::int64_t step, const State& state, const Watch* watch) {
    if (!speak_) return;
    const Mesh& mesh = state.moving.reference();
    std::vector<NodalField> fields = shown_fields(mesh, given_, state.fields);
    std::vector<NodalVectorField> vectors;
    std::vector<CellField> of_cells;
    if (given_.flow) {
        if (!liquids_of(given_).empty()) of_cells.push_back(mean_pressure(mesh, given_, state.fields));
        FlowState flow = flow_state(given_, state.fields);
        std::ranges::move(shown_pressures(mesh, given_, state.fields), std::back_inserter(fields));
        if (expands(given_)) fields.push_back({"density", "kg/m^3", std::move(flow.density)});
        vectors.push_back({"velocity", "m/s", std::move(flow.velocity)});
    }
    write_vtu(folder_ / frame_name(step), mesh, fields, watch, vectors, of_cells);
    series_.push_back({state.moving.time(), frame_name(step)});
    write_pvd(folder_ / "frames.pvd", series_);
}

void RunOutput::write_checkpoint(const Checkpoint& checkpoint) {
    if (speak_) kropla::write_checkpoint(folder_ / checkpoint_name, checkpoint);
}

void RunOutput::write_end(const std::exception& why, const Mesh& mesh) {
    if (speak_) report_end(folder_, why, &mesh);
}

void RunOutput::show_progress(std::int64_t step, const StepReport& report, double seconds_left) {
    if (!speak_) return;
    const double wanted = given_.time.end / given_.time.steps;
    const double left = given_.time.end - report.mesh.time;
    const auto steps_left = static_cast<std::int64_t>(std::ceil(left / wanted - 1e-6));
    ProgressRow row;
    row.step = static_cast<int>(step);
    row.steps = static_cast<int>(step + steps_left);
    row.time = report.mesh.time;
    row.worst_aspect_ratio = quality_->max_aspect_ratio;
    row.rung = rung(report.mesh.changes);
    row.touched_fraction = report.mesh.touched_fraction;
    row.mesh_seconds = report.mesh.mesh_seconds;
    if (given_.heat) row.heat_seconds = report.mesh.solve_seconds;
    if (given_.flow && !given_.heat) row.flow_seconds = report.mesh.solve_seconds;
    row.bodies = given_.heat ? temperatures(report, given_) : given_.flow ? speeds(report, given_) : "";
    row.seconds_left = seconds_left;
    progress_.show(row);
}

}  // namespace kropla
