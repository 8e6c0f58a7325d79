#include "app/step_row.h"

#include "case/body.h"
#include "case/heat.h"
#include <kropla/mesh/prisms.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

/// What the flow does to a body.
void add_forces(const StepReport& report, std::size_t body, const std::string& name, StepRow& row) {
    const auto known = std::ranges::find(report.flow.bodies, region_of_body(body), &BodyForce::body);
    const BodyForce acting = known != report.flow.bodies.end() ? *known : BodyForce{};
    const auto add = [&](std::string_view quantity, const Vec3& value, std::string_view unit) {
        for (int axis = 0; axis < 3; ++axis)
            row.push_back({fmt::format("{}_{}_{} [{}]", quantity, "xyz"[axis], name, unit), value[axis]});
    };
    add("spin", body < report.spins.size() ? report.spins[body] : Vec3{}, "rad/s");
    add("force", acting.force, "N");
    add("torque", acting.torque, "N m");
}

/// How near a free body is to what it may touch, and what that does to it.
void add_contact(const StepReport& report, std::size_t body, const std::string& name, StepRow& row) {
    const bool known = body < report.contact.forces.size();
    row.push_back({fmt::format("gap_{} [m]", name), known ? report.contact.gaps[body] : 0});
    for (int axis = 0; axis < 3; ++axis)
        row.push_back({fmt::format("contact_force_{}_{} [N]", "xyz"[axis], name), known ? report.contact.forces[body][axis] : 0});
}

/// Is it of a liquid, and reaches through faces of the box?
bool wets_faces(const Case& given, std::size_t body) {
    return body < given.liquid.size() && given.liquid[body] != 0 && reached_faces(given.domain.bodies[body].shape) != 0;
}

/// Where each body is, how it goes, and how large and warm it is.
void add_bodies(const StepReport& report, const Case& given, StepRow& row) {
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body) {
        const std::string name = column_name(given.domain.bodies[body].name);
        const BodyState state = body < report.bodies.size() ? report.bodies[body] : BodyState{};
        const Vec3 velocity = body < report.velocities.size() ? report.velocities[body] : Vec3{};
        row.insert(row.end(), {{fmt::format("x_{} [m]", name), state.place.x},
                               {fmt::format("y_{} [m]", name), state.place.y},
                               {fmt::format("z_{} [m]", name), state.place.z},
                               {fmt::format("u_{} [m/s]", name), velocity.x},
                               {fmt::format("v_{} [m/s]", name), velocity.y},
                               {fmt::format("w_{} [m/s]", name), velocity.z},
                               {fmt::format("volume_{} [m^3]", name), state.volume},
                               {fmt::format("area_{} [m^2]", name), state.area}});
        if (wets_faces(given, body)) row.push_back({fmt::format("wetted_{} [m^2]", name), state.on_faces});
        if (given.flow) add_forces(report, body, name, row);
        if (given.contact && given.free[body]) add_contact(report, body, name, row);
        if (!given.heat) continue;
        const double leaves = body < report.heat.surfaces.size() ? report.heat.surfaces[body].total : 0;
        row.insert(row.end(), {{fmt::format("temperature_min_{} [K]", name), state.coldest},
                               {fmt::format("temperature_mean_{} [K]", name), state.mean},
                               {fmt::format("temperature_max_{} [K]", name), state.hottest},
                               {fmt::format("heat_from_{} [W]", name), leaves}});
    }
}

double sum(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

/// What the temperature conserves, where it comes from, how far step and transfer missed it, and what became of values.
void add_energy(const StepReport& report, const HeatOptions& heat, StepRow& row) {
    const ContentReport energy = report.mesh.contents.empty() ? ContentReport{} : report.mesh.contents.front();
    const std::size_t temperature = proportional(heat) ? 0 : heat.regions.size();  // after the enthalpies, if these are carried
    const TransferReport transfer =
        temperature < report.mesh.transfer.size() ? report.mesh.transfer[temperature] : TransferReport{};
    const double error = energy.after != 0 ? energy.by_transfer / std::abs(energy.after) : 0;
    row.insert(row.end(), {{"energy_integral [J]", energy.after},
                           {"energy_transfer_error", error},
                           {"energy_before_transfer [J]", energy.before_transfer},
                           {"energy_limited [K]", transfer.limited},
                           {"energy_beyond_bounds [K]", transfer.beyond}});
    const HeatBalance& balance = report.heat.balance;
    const double dt = report.mesh.dt > 0 ? report.mesh.dt : 1;
    for (std::size_t face = 0; face < face_keys.size(); ++face)
        row.push_back({fmt::format("heat_out_{} [W]", face_keys[face]), (0 - balance.faces[face]) / dt});
    row.insert(row.end(), {{"heat_sources [W]", sum(balance.sources) / dt},
                           {"heat_at_surfaces [W]", sum(balance.surfaces) / dt},
                           {"heat_held [W]", sum(balance.held) / dt},
                           {"heat_by_volume [W]", sum(balance.expansion) / dt},
                           {"energy_error [J]", balance.error()}});
}

/// What passes the faces, and how the flow was solved for.
void add_flow(const StepReport& report, const Case& given, StepRow& row) {
    const FlowReport& flow = report.flow;
    for (std::size_t face = 0; face < face_keys.size(); ++face)
        row.push_back({fmt::format("volume_out_{} [m^3/s]", face_keys[face]), flow.face_flux[face]});
    row.insert(row.end(), {{"kinetic_energy [J]", flow.energy.kinetic},
                           {"surface_energy [J]", flow.energy.surface},
                           {"gravity_energy [J]", flow.energy.gravity},
                           {"dissipated [J]", flow.dissipated}});
    for (int axis = 0; axis < 3; ++axis) row.push_back({fmt::format("momentum_{} [kg m/s]", "xyz"[axis]), flow.momentum[axis]});
    for (int axis = 0; axis < 3; ++axis)
        row.push_back({fmt::format("momentum_error_{} [kg m/s]", "xyz"[axis]), flow.momentum_error[axis]});
    row.push_back({"mass_error_surroundings [kg]", flow.mass_error});
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body)
        if (given.liquid[body] != 0)
            row.push_back({fmt::format("mass_error_{} [kg]", column_name(given.domain.bodies[body].name)),
                           body < report.gains.size() ? given.flow->options.regions[body + 1]->density(0) * report.gains[body] : 0});
    row.insert(row.end(), {{"courant", flow.largest_courant},
                           {"flow_passes", static_cast<double>(flow.passes)},
                           {"flow_iterations", static_cast<double>(flow.iterations)},
                           {"flow_rounds", static_cast<double>(report.rounds)}});
}

/// What there is of each species, and how far step and transfer missed it.
void add_species(const StepReport& report, const Case& given, StepRow& row) {
    for (std::size_t s = 0; s < given.species.size(); ++s) {
        const std::string& name = given.species[s].name;
        const std::size_t place = s + (given.heat ? 1 : 0);
        const ContentReport amount = place < report.mesh.contents.size() ? report.mesh.contents[place] : ContentReport{};
        double error = 0, by_volume = 0;
        if (s < report.species.size()) {
            for (const HeatBalance& balance : report.species[s].balance) {
                error += balance.error();
                by_volume += sum(balance.expansion);
            }
        }
        row.insert(row.end(), {{fmt::format("{}_integral [kg]", name), amount.after},
                               {fmt::format("{}_transfer_error", name),
                                amount.after != 0 ? amount.by_transfer / std::abs(amount.after) : 0},
                               {fmt::format("{}_by_volume [kg]", name), by_volume},
                               {fmt::format("{}_error [kg]", name), error}});
    }
}

}  // namespace

StepRow step_row(std::int64_t step, const StepReport& report, const Mesh& mesh, const QualitySummary& quality,
                 const Case& given) {
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
    add_bodies(report, given, row);
    if (given.heat) add_energy(report, *given.heat, row);
    add_species(report, given, row);
    if (given.flow) add_flow(report, given, row);
    if (given.contact) row.push_back({"contacts", count(std::ranges::count_if(report.contact.contacts, &ContactForce::touches))});
    return row;
}

}  // namespace kropla
