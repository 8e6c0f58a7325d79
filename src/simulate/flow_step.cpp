// One step of a flow: the stages of flow.h, each solved by Newton's method.
//   [Dembo, Eisenstat, Steihaug 1982] Inexact Newton methods. SIAM J. Numer. Anal. 19: linear systems are
//     solved no better than the pass deserves.
// The derivative is kept from pass to pass, and from the first stage to the second, while it serves.
#include <kropla/base/error.h>
#include "simulate/assembly.h"
#include "simulate/flow_cell.h"
#include "simulate/flow_conditions.h"
#include "simulate/flow_energy.h"
#include "simulate/flow_mass.h"
#include "simulate/flow_scales.h"
#include "simulate/flow_surfaces.h"
#include "simulate/stop.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <sstream>

namespace kropla {
namespace {

constexpr double gamma = 1 - 1 / std::numbers::sqrt2;
constexpr double margin = 0.3;       // [-] of what is wanted of the residual: systems are solved so well, and
constexpr double forcing = 1e-2;     // [-] of the residual, at the best: a derivative that is kept brings no more
constexpr double stagnation = 0.5;   // [-] of the residual: a pass that leaves more got nowhere, and
constexpr double rounding = 1e-12;   // [-] of the terms of the residual is where that is no failure

Array<Vertex, Vec3> between(const Mesh& before, const Mesh& current, double share) {
    if (share == 1) return current.position;
    Array<Vertex, Vec3> position = current.position;
    for (Vertex v : position.indices())
        position[v] = (1 - share) * before.position[v] + share * current.position[v];
    return position;
}

Array<Vertex, Vec3> mesh_velocities(const Mesh& before, const Mesh& current, double dt) {
    Array<Vertex, Vec3> velocity(current.position.size());
    for (Vertex v : velocity.indices())
        velocity[v] = alive(current, v) ? (current.position[v] - before.position[v]) / dt : Vec3{};
    return velocity;
}

/// A step while it is solved.
class FlowSolution {
public:
    FlowSolution(const Ranks& ranks, const Mesh& before, const Mesh& current, const FlowOptions& options,
                 const FlowState& start, double t, double dt, const Array<Vertex, double>& temperature)
        : ranks_(ranks), before_(before), current_(current), options_(options), start_(start), t_(t), dt_(dt),
          cells_(flow_cells(current, options)),
          blocks_(make_block_pattern(current, cells_, ranks, upper_sides(current, cells_))),
          boundary_(flow_boundary(current, options, t + dt, temperature)),
          surfaces_(blocks_.pattern, boundary_.liquids),
          conditions_(flow_conditions(before, current, options, boundary_, start.velocity, t, dt)),
          material_(flow_materials(current, options, temperature)), guess_(start),
          solver_(ranks, blocks_, unknowns()) {
        system_.value = solver_.values();
        find_pressures();
        find_masses();
        if (!steady()) mesh_velocity_ = mesh_velocities(before, current, dt);
    }

    void solve_all() {
        if (options_.scheme != FlowScheme::second_order) {
            prescribe(conditions_.end);
            solve_stage({1, 1}, start_.velocity, steady() ? 0 : 1 / dt_);
            return;
        }
        constexpr double onward = (1 - gamma) / gamma;
        Array<Vertex, Vec3> given = conditions_.end;  // of the first stage
        for (Vertex v : given.indices()) {
            const Vec3 last = conditions_.end[v] - gamma * dt_ * conditions_.rate[v];
            given[v] = start_.velocity[v] + (1 / onward) * (last - start_.velocity[v]);
        }
        prescribe(given);
        solve_stage({gamma, 1 - gamma}, start_.velocity, 1 / (gamma * dt_));
        Array<Vertex, Vec3> old = start_.velocity;
        for_each_unknown([&](std::size_t, Vertex v, bool further) {
            if (further) return;
            const Vec3 gained = guess_.velocity[v] - start_.velocity[v];
            old[v] += onward * gained;
            guess_.velocity[v] = start_.velocity[v] + (1 / gamma) * gained;
        });
        prescribe(conditions_.end);
        solve_stage({1, gamma}, old, 1 / (gamma * dt_));
    }

    /// What is left of the last stage's residual goes into forces.
    [[nodiscard]] FlowReport report() const {
        FlowReport report;
        report.iterations = solver_.iterations();
        report.passes = passes_;
        report.error = error_;
        const Array<Vertex, Vec3> reaction = reactions();
        for (const SolidSurface& solid : boundary_.solids) {
            BodyForce of{solid.body, solid.centre};
            for (Vertex v : solid.vertices) {
                of.force -= reaction[v];
                of.torque -= cross(current_.position[v] - solid.centre, reaction[v]);
            }
            of.flux = flux_through(solid.facets, current_.position, guess_.velocity);
            report.net_flux += of.flux;
            report.bodies.push_back(of);
        }
        for (std::size_t face = 0; face < 6; ++face) {
            report.face_flux[face] = flux_through(boundary_.faces[face], current_.position, guess_.velocity);
            report.net_flux += report.face_flux[face];
        }
        report.surfaces = surfaces_.courses();
        report.energy = flow_energy(current_, cells_, material_, guess_.velocity, options_.gravity);
        report.energy.surface = surfaces_.energy();
        report.dissipated = dissipated_;
        report_mass(report);
        report.face_force = face_forces(reaction);
        report.largest_courant = largest_courant();
        return report;
    }

    /// The state at the step's end: zero where nothing flows.
    [[nodiscard]] FlowState state() const {
        FlowState end = still_flow(current_);
        for (Vertex v : numbering().vertex) {
            end.velocity[v] = guess_.velocity[v];
            end.pressure[v] = guess_.pressure[v];
        }
        if (masses_) end.density = masses_->densities(1);
        if (conditions_.closed) {
            double sum = 0, volume = 0;
            for_each_share(current_, cells_, [&](const auto& cell, Vertex v, double share) {
                sum += share * pressure_at(v, cell_region(current_, cell));
                volume += share;
            });
            for_each_unknown([&](std::size_t, Vertex v, bool further) {
                if (!further) end.pressure[v] -= sum / volume;
            });
            set_within(end, sum / volume);
        } else {
            set_within(end, 0);
        }
        return end;
    }

private:
    [[nodiscard]] const SparseRows& rows() const { return blocks_.pattern.rows; }
    [[nodiscard]] const UpperSides& upper() const { return blocks_.pattern.numbering.upper; }
    /// Calls `visit(global row, vertex, whether the row is the vertex's further one)`.
    template <class Visit>
    void for_each_unknown(const Visit& visit) const {
        for (std::size_t r = 0; r < numbering().vertex.size(); ++r)
            visit(r, numbering().vertex[r], numbering().is_further(r));
    }
    /// In cells of the region.
    [[nodiscard]] double pressure_at(Vertex v, Region region) const {
        return numbering().is_upper(v, region) ? guess_.within[as_size(region.value - 1)][v] : guess_.pressure[v];
    }
    [[nodiscard]] double& pressure_of(Vertex v, bool further) {
        return further ? guess_.within[as_size(upper()[v].value - 1)][v] : guess_.pressure[v];
    }
    [[nodiscard]] double pressure_of(Vertex v, bool further) const {
        return further ? guess_.within[as_size(upper()[v].value - 1)][v] : guess_.pressure[v];
    }

    /// Of the state at the begin: the pressure at inner vertices of the higher regions is the one within.
    void find_pressures() {
        if (upper().empty()) return;
        if (guess_.within.empty()) guess_.within.assign(options_.regions.size() - 1, guess_.pressure);
        for_each_cell(cells_, [&](const auto& cell) {
            const Region region = cell_region(current_, cell);
            if (region.value == 0) return;
            for (Vertex v : cell_vertices(current_, cell))
                if (!upper()[v].exists()) guess_.pressure[v] = guess_.within[as_size(region.value - 1)][v];
        });
    }
    /// At the end, less the mean.
    void set_within(FlowState& end, double mean) const {
        if (upper().empty()) return;
        end.within.assign(options_.regions.size() - 1, Array<Vertex, double>(current_.position.size(), 0.0));
        for_each_cell(cells_, [&](const auto& cell) {
            const Region region = cell_region(current_, cell);
            for (Vertex v : cell_vertices(current_, cell))
                if (region.value > 0) end.within[as_size(region.value - 1)][v] = pressure_at(v, region) - mean;
        });
    }
    [[nodiscard]] const Numbering& numbering() const { return blocks_.pattern.numbering; }
    [[nodiscard]] bool steady() const { return options_.scheme == FlowScheme::steady; }
    [[nodiscard]] Vertex vertex_of(std::size_t owned_row) const {
        return numbering().vertex[static_cast<std::size_t>(rows().first_row) + owned_row];
    }

    void report_mass(FlowReport& report) const {
        if (!masses_) {
            const auto flowing = std::ranges::find_if(options_.regions, [](const auto& region) { return region.has_value(); });
            report.mass_error = dt_ * report.net_flux * (*flowing)->density(0);
            return;
        }
        double out = 0;
        for (std::size_t face = 0; face < 6; ++face)
            for (Vertex v : numbering().vertex)
                if (const double rate = passed_[face].empty() ? 0 : passed_[face][v]; rate != 0) {
                    report.through.push_back({v, face, rate});
                    out += rate;
                }
        report.mass_error = dt_ * out + std::accumulate(gained_.begin(), gained_.end(), 0.0);
    }

    [[nodiscard]] FlowUnknowns unknowns() const {
        FlowUnknowns unknowns{{}, conditions_.closed};
        for_each_unknown([&](std::size_t, Vertex v, bool further) {
            for (bool fixed : conditions_.fixed[v]) unknowns.fixed.push_back(fixed || further ? 1 : 0);
            unknowns.fixed.push_back(0);
        });
        return unknowns;
    }

    void prescribe(const Array<Vertex, Vec3>& velocity) {
        for (Vertex v : numbering().vertex)
            for (int m = 0; m < 3; ++m)
                if (conditions_.fixed[v][static_cast<std::size_t>(m)]) guess_.velocity[v][m] = velocity[v][m];
    }

    /// When a stage is, as a share of the step, and its weight in the means over the step.
    struct StageTime {
        double share, weight;
    };

    void solve_stage(const StageTime& at, const Array<Vertex, Vec3>& old, double per_time) {
        const Array<Vertex, Vec3> position = between(before_, current_, at.share);
        const double time = t_ + at.share * dt_;
        if (masses_) let_expand(at, position);
        set_forces(current_, position, options_, time, material_);
        const auto open_pressure = open_pressures(position, options_, boundary_, time);
        const FlowStage stage{current_,         position,  mesh_velocity_,     old,
                              guess_,           material_, conditions_.open,   open_pressure,
                              options_.gravity, per_time,  options_.convection, upper()};
        find_shares(position);
        surfaces_.begin(position, mesh_velocity_, at.share * dt_);
        const bool fresh = !solver_.has_matrix();
        assemble(stage, fresh);
        if (fresh) {
            triangular_ = is_viscous(ranks_, blocks_.pattern, stage);
            take_matrix(stage);
        }
        double left = solver_.size(system_.residual);
        largest_left_ = std::max(largest_left_, left);
        const double wanted = options_.tolerance * largest_left_;
        const bool is_solution = left <= rounding * solver_.size_of_terms(unknown());  // as it is
        for (int pass = 1; left > wanted && !is_solution; ++pass) {
            if (pass > options_.most_passes || !std::isfinite(left)) give_up(pass, left / largest_left_);
            add(correction(stage, std::max(margin * wanted / left, forcing)));
            ++passes_;
            assemble(stage, false);
            const double before = left;
            left = solver_.size(system_.residual);
            const double reduction = left / before;
            if (left <= wanted || reduction * reduction * left <= wanted)
                continue;  // two more passes as this one
            if (left > stagnation * before && left <= rounding * solver_.size_of_terms(unknown())) break;
            assemble(stage, true);
            take_matrix(stage);
            left = solver_.size(system_.residual);
        }
        if (left > 0) error_ = left / largest_left_;
        if (!conditions_.closed) let_rest_out(position);
        if (masses_) note_passed(at.weight, position);
        dissipated_ += at.weight * dt_ * dissipation(current_, cells_, position, material_, guess_.velocity);
        surfaces_.end(guess_.velocity, at.weight * dt_);
    }

    /// Where the density depends on the temperature.
    void find_masses() {
        for (Region r : material_.indices()) {
            if (material_[r].densities.empty()) continue;
            expanding_ = r;
            const Array<Vertex, double>& end = material_[r].densities;
            masses_.emplace(before_, current_, cells_, start_.density.empty() ? end : start_.density,
                            end, dt_);
            if (!steady()) material_[r].density_rate = masses_->density_rate();
            gained_ = Array<Vertex, double>(end.size(), 0.0);
        }
    }

    /// Sets the densities of a stage, and what its vertices gain, by the volume that this takes: as it is then, but for the
    /// last one, that in the step all is gained that there is to gain. Where the mesh goes otherwise than the velocity of a
    /// solid body has it, for a moment, mass would pass its surface: that is the same in all.
    void let_expand(const StageTime& at, const Array<Vertex, Vec3>& position) {
        Array<Vertex, double>& density = material_[expanding_].densities;
        density = masses_->densities(at.share);
        expansion_ = Array<Vertex, double>(density.size(), 0.0);
        if (steady()) return;
        const Array<Vertex, double> mass = masses_->masses(at.share);
        Array<Vertex, double> rate = masses_->rates(at.share);
        if (at.share == 1) {
            const Array<Vertex, double> begin = masses_->masses(0);
            for (Vertex v : rate.indices()) rate[v] = (mass[v] - begin[v] - gained_[v]) / (at.weight * dt_);
        }
        for (Vertex v : rate.indices()) gained_[v] += at.weight * dt_ * rate[v];
        Array<Vertex, Vec3> passing = guess_.velocity;
        for (Vertex v : passing.indices()) passing[v] -= mesh_velocity_[v];
        double leak = 0;
        for (const SolidSurface& solid : boundary_.solids)
            for_each_flux(solid.facets, position, passing, [&](Vertex v, double flux) {
                rate[v] += density[v] * flux;
                leak += density[v] * flux;
            });
        const double all = std::accumulate(mass.begin(), mass.end(), 0.0);
        for (Vertex v : numbering().vertex) expansion_[v] = (rate[v] - leak * mass[v] / all) / density[v];
    }

    /// Adds what passed the faces in a stage to the means over the step.
    void note_passed(double weight, const Array<Vertex, Vec3>& position) {
        const Array<Vertex, double>& density = material_[expanding_].densities;
        for (std::size_t face = 0; face < 6; ++face) {
            Array<Vertex, double>& passed = passed_[face];
            passed.resize(position.size(), 0.0);
            for_each_flux(boundary_.faces[face], position, guess_.velocity,
                          [&](Vertex v, double flux) { passed[v] += weight * density[v] * flux; });
        }
    }

    [[noreturn]] void give_up(int pass, double left) const {
        std::ostringstream message;
        message << "the flow did not converge: after " << pass - 1 << " passes of Newton's method " << left
                << " of the residual is left, t = " << t_ + dt_ << " s: smaller steps may help";
        throw SolverError(message.str());
    }

    void assemble(const FlowStage& stage, bool derivative) {
        heed(ranks_);
        assemble_blocks(
            current_, blocks_,
            [&](const auto& cell, auto& blocks) { flow_cell(stage, cell, derivative, blocks); }, derivative,
            system_, ranks_.watch);
        surfaces_.add(guess_.velocity, stage.per_time > 0 ? 1 / stage.per_time : 0, derivative, system_);
        for (std::size_t r = 0; r < rows().count() && masses_; ++r)
            system_.residual[block_size * r + 3] += expansion_[vertex_of(r)];
        reaction_ = system_.residual;
        if (conditions_.closed) spread_net_flux();
    }

    /// What the given velocities let in more than out, as rounding and facets have it, is spread over the
    /// volume.
    void spread_net_flux() {
        double mine = 0, net = 0;
        for (std::size_t r = 0; r < rows().count(); ++r) mine += system_.residual[block_size * r + 3];
        MPI_Allreduce(&mine, &net, 1, MPI_DOUBLE, MPI_SUM, ranks_.communicator);
        for (std::size_t r = 0; r < rows().count(); ++r)
            system_.residual[block_size * r + 3] -= net * share_of_volume_[static_cast<std::size_t>(rows().first_row) + r];
    }

    /// What is left of the residual of the whole volume, goes out through open faces, at one velocity along their normals:
    /// what passes the boundary is balanced to rounding however well the stage is solved. As OpenFOAM's adjustPhi.
    void let_rest_out(const Array<Vertex, Vec3>& position) {
        const auto density = [&](Vertex v) { return masses_ ? material_[expanding_].densities[v] : 1.0; };
        double mine = 0, rest = 0;
        for (std::size_t r = 0; r < rows().count(); ++r) mine += density(vertex_of(r)) * system_.residual[block_size * r + 3];
        MPI_Allreduce(&mine, &rest, 1, MPI_DOUBLE, MPI_SUM, ranks_.communicator);
        Array<Vertex, Vec3> outward(position.size());
        for (std::size_t face = 0; face < 6; ++face) {
            const auto axis = static_cast<int>(face / 2);
            for (const auto& facet : boundary_.faces[face])
                for (Vertex v : facet)
                    if (conditions_.open[face] && !conditions_.fixed[v][face / 2]) outward[v][axis] = face % 2 == 0 ? -1 : 1;
        }
        double passing = 0;
        for (const auto& facets : boundary_.faces)
            for_each_flux(facets, position, outward, [&](Vertex v, double flux) { passing += density(v) * flux; });
        if (!(passing > 0)) return;
        for (Vertex v : numbering().vertex) guess_.velocity[v] -= rest / passing * outward[v];
    }

    void find_shares(const Array<Vertex, Vec3>& position) {
        if (!conditions_.closed) return;
        share_of_volume_.assign(numbering().vertex.size(), 0.0);
        double total = 0;
        for_each_cell(cells_, [&](const auto& cell) {
            const auto vertices = cell_vertices(current_, cell);
            const double part = total_volume(cell_points(corners(position, current_, cell)));
            total += part;
            for (Vertex v : vertices)
                share_of_volume_[as_size(numbering().row_at(v, cell_region(current_, cell)))] +=
                    part / static_cast<double>(vertices.size());
        });
        for (double& share : share_of_volume_) share /= total;
    }

    void add(const std::vector<double>& correction) {
        for_each_unknown([&](std::size_t r, Vertex v, bool further) {
            const double* const gained = correction.data() + block_size * r;
            if (!further) guess_.velocity[v] += Vec3{gained[0], gained[1], gained[2]};
            pressure_of(v, further) += gained[3];
        });
    }

    void take_matrix(const FlowStage& stage) {
        if (!triangular_) return solver_.take(nullptr);
        const PressureScales scales = pressure_scales(ranks_, blocks_.pattern, stage);
        solver_.take(&scales);
    }

    /// Where incomplete factors do not lead to it, the other preconditioner is tried.
    [[nodiscard]] std::vector<double> correction(const FlowStage& stage, double tolerance) {
        try {
            return solver_.solve(system_.residual, tolerance);
        } catch (const SolverError&) {
            if (triangular_ || !upper().empty()) throw;
        }
        triangular_ = true;
        assemble(stage, true);
        take_matrix(stage);
        return solver_.solve(system_.residual, tolerance);
    }

    /// block_size per global row.
    [[nodiscard]] std::vector<double> unknown() const {
        std::vector<double> all;
        all.reserve(block_size * numbering().vertex.size());
        for_each_unknown([&](std::size_t, Vertex v, bool further) {
            const Vec3 u = further ? Vec3{} : guess_.velocity[v];
            all.insert(all.end(), {u.x, u.y, u.z, pressure_of(v, further)});
        });
        return all;
    }

    /// Where faces meet, each direction is of the one across it, else of all alike that hold it.
    [[nodiscard]] std::array<Vec3, 6> face_forces(const Array<Vertex, Vec3>& reaction) const {
        Array<Vertex, unsigned> faces(reaction.size(), 0);  // that a vertex stands on, a bit each
        for (std::size_t face = 0; face < 6; ++face)
            for (const auto& facet : boundary_.faces[face])
                for (Vertex v : facet) faces[v] |= 1u << face;
        for (const SolidSurface& solid : boundary_.solids)
            for (Vertex v : solid.vertices) faces[v] = 0;
        for (Vertex v : boundary_.fixed_walls) faces[v] = 0;
        std::array<Vec3, 6> forces = {};
        for (int m = 0; m < 3; ++m) {
            const unsigned across = 3u << (2 * m);
            unsigned hold = 0;  // this direction of the velocity
            for (std::size_t face = 0; face < 6; ++face) {
                const FlowFace::Kind kind = options_.faces[face].kind;
                const bool along = kind == FlowFace::Kind::wall || kind == FlowFace::Kind::velocity;
                const bool slips = kind == FlowFace::Kind::slip && (across >> face & 1u) != 0;
                if (along || slips) hold |= 1u << face;
            }
            for (Vertex v : numbering().vertex) {
                const unsigned all = faces[v] & hold, those = (all & across) != 0 ? all & across : all;
                for (std::size_t face = 0; face < 6; ++face)
                    if ((those >> face & 1u) != 0)
                        forces[face][m] -= reaction[v][m] / std::popcount(those);
            }
        }
        return forces;
    }

    /// The residuals of momentum at all vertices, on all ranks.
    [[nodiscard]] Array<Vertex, Vec3> reactions() const {
        std::vector<double> all(3 * numbering().vertex.size(), 0.0);
        for (std::size_t r = 0; r < rows().count(); ++r)
            for (std::size_t m = 0; m < 3; ++m)
                all[3 * (static_cast<std::size_t>(rows().first_row) + r) + m] = reaction_[block_size * r + m];
        MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()), MPI_DOUBLE, MPI_SUM,
                      ranks_.communicator);
        Array<Vertex, Vec3> reaction(current_.position.size());
        for_each_unknown([&](std::size_t r, Vertex v, bool further) {
            if (!further) reaction[v] = {all[3 * r], all[3 * r + 1], all[3 * r + 2]};
        });
        return reaction;
    }

    [[nodiscard]] double largest_courant() const {
        if (steady()) return 0;
        const std::array<Array<Vertex, double>, 6> none;
        const FlowStage stage{current_, current_.position, mesh_velocity_, guess_.velocity, guess_, material_,
                              conditions_.open, none, {}, 0, true, upper()};
        double most = 0, all = 0;
        for (const Cells* cells : {&blocks_.pattern.cells, &blocks_.pattern.upper})
            for_each_cell(*cells, [&](const auto& cell) { most = std::max(most, crossing_rate(stage, cell)); });
        MPI_Allreduce(&most, &all, 1, MPI_DOUBLE, MPI_MAX, ranks_.communicator);
        return dt_ * all;
    }

    const Ranks& ranks_;
    const Mesh &before_, &current_;
    const FlowOptions& options_;
    const FlowState& start_;
    double t_, dt_;
    Cells cells_;
    BlockPattern blocks_;
    FlowBoundary boundary_;
    FlowSurfaces surfaces_;
    FlowConditions conditions_;
    Array<Region, FlowMaterial> material_;
    Region expanding_;                     // whose density depends on the temperature; only then:
    std::optional<VertexMasses> masses_;
    Array<Vertex, double> gained_;         // [kg] in the stages so far
    Array<Vertex, double> expansion_;      // [m^3/s] what it takes in this one
    std::array<Array<Vertex, double>, 6> passed_;  // [kg/s] out through faces, in the mean over the step
    FlowState guess_;
    BlockSystem system_;
    std::vector<double> reaction_;  // the residual of the last assembly, as it is
    std::vector<double> share_of_volume_;  // per row
    Array<Vertex, Vec3> mesh_velocity_;
    FlowSolver solver_;
    bool triangular_ = false;  // the preconditioner
    double dissipated_ = 0;  // [J] in the stages so far
    int passes_ = 0;
    double largest_left_ = 0;  // the first residual of a stage, the larger of both
    double error_ = 0;
};

}  // namespace

FlowReport step_flow(const Ranks& ranks, const Mesh& before, const Mesh& current, const FlowOptions& options,
                     FlowState& state, double t, double dt, const Array<Vertex, double>& temperature) {
    check_flow(options, current);
    if (!(dt > 0 && std::isfinite(dt)))
        throw CaseError(options.key + ": dt must be positive, got " + std::to_string(dt));
    FlowSolution solution(ranks, before, current, options, state, t, dt, temperature);
    solution.solve_all();
    FlowReport report = solution.report();
    state = solution.state();
    return report;
}

}  // namespace kropla
