#include "app/step_row.h"

#include <kropla/mesh/prisms.h>

#include <fmt/format.h>

#include <cmath>

namespace kropla {
namespace {

/// What the temperature conserves, how far the transfer missed it, and what became of its values.
void add_energy(const StepReport& report, std::size_t bodies, StepRow& row) {
    const ContentReport energy = report.mesh.contents.empty() ? ContentReport{} : report.mesh.contents.front();
    const TransferReport transfer = report.mesh.transfer.empty() ? TransferReport{} : report.mesh.transfer.front();
    const double error = energy.after != 0 ? energy.by_transfer / std::abs(energy.after) : 0;
    row.insert(row.end(), {{"energy_integral [J]", energy.after},
                           {"energy_transfer_error", error},
                           {"energy_before_transfer [J]", energy.before_transfer},
                           {"energy_limited [K]", transfer.limited},
                           {"energy_beyond_bounds [K]", transfer.beyond}});
    for (std::size_t body = 0; body < bodies; ++body)
        row.push_back({fmt::format("energy_from_body_{} [J/s]", body + 1),
                       body < report.heat_from_bodies.size() ? report.heat_from_bodies[body] : 0});
}

}  // namespace

StepRow step_row(std::int64_t step, const StepReport& report, const Mesh& mesh, const QualitySummary& quality,
                 const Case& it) {
    const Advanced& done = report.mesh;
    const auto count = [](auto number) { return static_cast<double>(number); };
    StepRow row = {{"step", count(step)},
                   {"time [s]", done.time},
                   {"dt [s]", done.dt},
                   {"attempts", count(done.attempts)},
                   {"vertices", count(quality.vertices)},
                   {"tets", count(quality.tets)},
                   {"prisms", count(count_prisms(mesh))},
                   {"max_aspect_ratio", quality.max_aspect_ratio},
                   {"p999_aspect_ratio", quality.p999_aspect_ratio},
                   {"min_dihedral [deg]", quality.min_dihedral},
                   {"max_dihedral [deg]", quality.max_dihedral},
                   {"smoothing_sweeps", count(done.changes.smoothing_sweeps)},
                   {"swaps", count(done.changes.swaps)},
                   {"splits", count(done.changes.splits)},
                   {"collapses", count(done.changes.collapses)},
                   {"local_remeshes", count(done.changes.local_remeshes)},
                   {"largest_ring", count(done.changes.largest_ring)},
                   {"global_remeshes", count(done.changes.global_remeshes)},
                   {"given_up", count(done.changes.given_up)},
                   {"touched_fraction", done.touched_fraction},
                   {"kept_vertices", done.kept_vertices},
                   {"kept_tets", done.kept_tets},
                   {"mesh_seconds [s]", done.mesh_seconds},
                   {"simulate_seconds [s]", done.solve_seconds},
                   {"transfer_seconds [s]", done.transfer_seconds},
                   {"mesh_cpu_seconds [s]", done.mesh_cpu_seconds},
                   {"transferred_fraction", done.transferred_fraction}};
    if (it.heat) add_energy(report, it.domain.bodies.size(), row);
    return row;
}

}  // namespace kropla
