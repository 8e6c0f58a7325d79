#include "app/run_output.h"

#include "app/body_sizes.h"
#include "app/ending.h"
#include "app/run_folder.h"
#include "base/error.h"
#include "io/file.h"
#include "io/vtk.h"
#include "mesh/prisms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

std::string frame_name(std::int64_t step) { return fmt::format("frames/{:05}.vtu", step); }

std::vector<FieldBalance> conserved(const Case& it) {
    if (!it.heat) return {};
    return {{.field = "energy",
             .unit = "J",
             .value_unit = "K",
             .from_bodies = std::vector<double>(it.domain.bodies.size())}};
}

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

RunOutput::RunOutput(const RunOptions& options, const Case& it, bool speak, std::int64_t step,
                     const State& state, Progress& progress)
    : overwrite_(options.force), folder_(options.out), it_(it), speak_(speak), progress_(progress) {
    if (!speak_) return;
    forget_end(folder_);
    if (options.resume) go_on(step, state);
    else start(state.moving.reference());
}

void RunOutput::start(const Mesh& mesh) {
    if (overwrite_) clear_run_folder(folder_);
    std::error_code trouble;
    std::filesystem::create_directories(folder_ / "frames", trouble);
    if (trouble) throw FileError(fmt::format("{}: cannot be made: {}", folder_.string(), trouble.message()));
    write_file(folder_ / "case.toml", to_toml(it_));
    write_body_sizes(folder_ / "bodies.csv", body_sizes(it_.domain, mesh));
    table_.emplace(folder_ / "steps.csv", conserved(it_));
    write_pvd(folder_ / "frames.pvd", series_);
}

void RunOutput::go_on(std::int64_t step, const State& state) {
    table_.emplace(folder_ / "steps.csv", conserved(it_), static_cast<int>(step));
    series_ = read_pvd(folder_ / "frames.pvd");
    std::erase_if(series_, [&](const SeriesEntry& frame) { return frame.time > state.moving.time(); });
    write_pvd(folder_ / "frames.pvd", series_);
    write_file(folder_ / "case.toml", to_toml(it_));  // its end, or how often frames are written, may be another
}

void RunOutput::write_step(std::int64_t step, const StepReport& report, const State& state) {
    if (!speak_) return;
    const Changes& c = report.changes;
    quality_ = summarise_quality(state.moving.reference());
    StepRow row;
    row.step = static_cast<int>(step);
    row.time = report.time;
    row.dt = report.dt;
    row.attempts = report.attempts;
    row.vertices = quality_->vertices;
    row.tets = quality_->tets;
    row.prisms = count_prisms(state.moving.reference());
    row.max_aspect_ratio = quality_->max_aspect_ratio;
    row.p999_aspect_ratio = quality_->p999_aspect_ratio;
    row.min_dihedral = quality_->min_dihedral;
    row.max_dihedral = quality_->max_dihedral;
    row.smoothing_sweeps = c.smoothing_sweeps;
    row.swaps = c.swaps;
    row.splits = c.splits;
    row.collapses = c.collapses;
    row.local_remeshes = c.local_remeshes;
    row.largest_ring = c.largest_ring;
    row.global_remeshes = c.global_remeshes;
    row.touched_fraction = report.touched_fraction;
    row.kept_vertices = report.kept_vertices;
    row.kept_tets = report.kept_tets;
    row.mesh_seconds = report.mesh_seconds;
    row.mesh_cpu_seconds = report.mesh_cpu_seconds;
    row.simulate_seconds = report.simulate_seconds;
    row.transfer_seconds = report.transfer_seconds;
    row.transferred_fraction = report.transferred_fraction;
    row.fields = conserved(it_);
    for (FieldBalance& field : row.fields) {
        field.integral = report.energy;
        field.transfer_error = report.energy != 0 ? report.energy_by_transfer / std::abs(report.energy) : 0;
        field.from_bodies = report.heat_from_bodies;
        field.before_transfer = report.energy_before_transfer;
        field.limited = report.transfer.limited;
        field.beyond = report.transfer.beyond;
    }
    table_->append(row);
}

void RunOutput::write_frame(std::int64_t step, const State& state, const Watch* watch) {
    if (!speak_) return;
    write_vtu(folder_ / frame_name(step), state.moving.reference(), state.fields, watch);
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
    const double wanted = it_.time.end / it_.time.steps;
    const double left = it_.time.end - report.time;
    const auto steps_left = static_cast<std::int64_t>(std::ceil(left / wanted - 1e-6));
    ProgressRow row;
    row.step = static_cast<int>(step);
    row.steps = static_cast<int>(step + steps_left);
    row.time = report.time;
    row.worst_aspect_ratio = quality_->max_aspect_ratio;
    row.rung = rung(report.changes);
    row.touched_fraction = report.touched_fraction;
    row.mesh_seconds = report.mesh_seconds;
    if (it_.heat) row.heat_seconds = report.simulate_seconds;
    row.seconds_left = seconds_left;
    progress_.show(row);
}

}  // namespace kropla
