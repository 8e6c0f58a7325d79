// One step of a flow: the stages of flow.h, each solved by Newton's method.
//   [Dembo, Eisenstat, Steihaug 1982] Inexact Newton methods. SIAM J. Numer. Anal. 19: linear systems are
//     solved no better than the pass deserves.
// The derivative is kept from pass to pass, and from the first stage to the second, while it serves.
#include <kropla/base/error.h>
#include "simulate/expanding_gas.h"
#include "simulate/flow_balance.h"
#include "simulate/flow_cell.h"
#include "simulate/flow_conditions.h"
#include "simulate/flow_energy.h"
#include "simulate/flow_forces.h"
#include "simulate/flow_scales.h"
#include "simulate/flow_surfaces.h"
#include "simulate/stop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>

namespace kropla {
namespace {

constexpr double gamma = 1 - 1 / std::numbers::sqrt2;
constexpr double margin = 0.3;       // [-] of what is wanted of the residual: systems are solved so well, and
constexpr double forcing = 1e-2;     // [-] of the residual, at the best: a derivative that is kept brings no more;
constexpr double long_forcing = 1e-4;    // [-] of that in steps of first order, which may be long
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
          conditions_(flow_conditions(before, current, options, blocks_.pattern, boundary_, start.velocity, t, dt)),
          material_(flow_materials(current, options, temperature)), guess_(start),
          stood_(before.position), solver_(ranks, blocks_, fixed_unknowns()) {
        system_.value = solver_.values();
        find_level();
        find_pressures();
        find_expanding();
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
        Array<Vertex, Vec3> reaction = reactions(ranks_, blocks_.pattern, reaction_);
        take_off_pressure(blocks_.pattern, boundary_, conditions_, current_.position, surplus_pressures(), reaction);
        const auto shares = shares_of_faces(boundary_, conditions_, current_.position, state().pressure);
        for (const FaceShare& share : shares) reaction[share.vertex] -= share.reaction;
        report.bodies = body_forces(boundary_, current_.position, guess_.velocity, reaction);
        for (const BodyForce& body : report.bodies) report.net_flux += body.flux;
        for (std::size_t face = 0; face < 6; ++face) {
            report.face_flux[face] = flux_through(boundary_.faces[face], current_.position, guess_.velocity);
            report.net_flux += report.face_flux[face];
        }
        report.surfaces = surfaces_.courses();
        report.energy = flow_energy(current_, cells_, material_, guess_.velocity, options_.gravity);
        report.energy.surface = surfaces_.energy();
        report.dissipated = dissipated_;
        report_momentum(report);
        report_mass(report);
        report.face_force = face_forces(options_, boundary_, shares, reaction);
        report.largest_courant = largest_courant();
        return report;
    }

    /// The state at the step's end: zero where nothing flows.
    [[nodiscard]] FlowState state() const {
        FlowState end = still_flow(current_);
        const std::vector<double> surplus = surplus_pressures();
        for (Vertex v : numbering().vertex) {
            end.velocity[v] = guess_.velocity[v];
            end.pressure[v] = guess_.pressure[v] - surplus[blocks_.pattern.piece_of(v)];
        }
        set_within(end, surplus);
        if (gas_) end.density = gas_->densities();
        return end;
    }

private:
    [[nodiscard]] bool steady() const { return options_.scheme == FlowScheme::steady; }
    [[nodiscard]] const SparseRows& rows() const { return blocks_.pattern.rows; }
    [[nodiscard]] const Numbering& numbering() const { return blocks_.pattern.numbering; }
    [[nodiscard]] const UpperSides& upper() const { return numbering().upper; }
    [[nodiscard]] Vertex vertex_of(std::size_t owned_row) const {
        return numbering().vertex[static_cast<std::size_t>(rows().first_row) + owned_row];
    }
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

    /// Only what the pressure is beside a level counts, so it is solved for without that, as 1 Pa would be lost in 1 bar.
    void find_level() {
        const auto given = open_pressures(current_.position, options_, boundary_, t_ + dt_);
        double sum = 0, guessed = 0, count = 0;
        for (std::size_t face = 0; face < 6; ++face)
            for (const auto& facet : boundary_.faces[face])
                for (Vertex v : facet) {
                    if (!conditions_.open[face]) continue;
                    sum += given[face].empty() ? 0 : given[face][v];
                    guessed += guess_.pressure[v];
                    ++count;
                }
        if (sum == 0) return;
        level_ = sum / count;
        for (Vertex v : current_.position.indices()) {
            if (numbering().row[v] < 0 || conditions_.closed[blocks_.pattern.piece_of(v)] != 0) continue;
            guess_.pressure[v] -= guessed / count;
            for (Array<Vertex, double>& within : guess_.within) within[v] -= guessed / count;
        }
    }
    /// Less the level.
    [[nodiscard]] std::array<Array<Vertex, double>, 6> pressures_at_faces(const Array<Vertex, Vec3>& position, double time) const {
        auto pressures = open_pressures(position, options_, boundary_, time);
        for (std::size_t face = 0; face < 6 && level_ != 0; ++face) {
            if (!conditions_.open[face]) continue;
            pressures[face].resize(position.size(), 0.0);
            for (double& pressure : pressures[face]) pressure -= level_;
        }
        return pressures;
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
    /// What is to be taken off the pressures of each piece: of one that is closed the mean; of the others less than nothing,
    /// the level.
    [[nodiscard]] std::vector<double> surplus_pressures() const {
        std::vector<double> sum(conditions_.closed.size(), 0.0), volume(sum);
        for_each_share(current_, cells_, [&](const auto& cell, Vertex v, double share) {
            const std::size_t piece = blocks_.pattern.piece_of(v);
            sum[piece] += share * pressure_at(v, cell_region(current_, cell));
            volume[piece] += share;
        });
        for (std::size_t p = 0; p < sum.size(); ++p) sum[p] = conditions_.closed[p] != 0 ? sum[p] / volume[p] : -level_;
        return sum;
    }
    /// At the end, less the surplus of the piece.
    void set_within(FlowState& end, const std::vector<double>& surplus) const {
        if (upper().empty()) return;
        end.within.assign(options_.regions.size() - 1, Array<Vertex, double>(current_.position.size(), 0.0));
        for_each_cell(cells_, [&](const auto& cell) {
            const Region region = cell_region(current_, cell);
            for (Vertex v : cell_vertices(current_, cell))
                if (region.value > 0) end.within[as_size(region.value - 1)][v] = pressure_at(v, region) - surplus[blocks_.pattern.piece_of(v)];
        });
    }

    void report_mass(FlowReport& report) const {
        if (gas_) {
            report.through = gas_->through();
            report.mass_error = gas_->mass_error();
            return;
        }
        const auto flowing = std::ranges::find_if(options_.regions, [](const auto& region) { return region.has_value(); });
        report.mass_error = dt_ * report.net_flux * (*flowing)->density(0);
    }

    void report_momentum(FlowReport& report) const {
        report.momentum = momentum(current_, cells_, current_.position, material_, guess_.velocity);
        if (steady() || !options_.convection) return;
        Array<Region, FlowMaterial> begin = material_;
        for (FlowMaterial& material : begin)
            if (!material.densities.empty() && !start_.density.empty()) material.densities = start_.density;
        report.momentum_error = report.momentum - pushed_ - momentum(before_, cells_, before_.position, begin, start_.velocity);
    }
    /// What forces bring, less what goes out through faces, in the part of the step that a stage stands for.
    void note_momentum(const FlowStage& stage, double dt) {
        pushed_ += dt * (inertia(stage, cells_) - surfaces_.passing(guess_.velocity));
        for (const auto& facets : boundary_.faces)
            for_each_flux(facets, stage.position, guess_.velocity, [&](Vertex v, double flux) {
                const double density = gas_ ? gas_->densities()[v] : material_[Region(0)].density;
                pushed_ -= dt * density * flux * guess_.velocity[v];
            });
    }

    [[nodiscard]] std::vector<char> fixed_unknowns() const {
        std::vector<char> given;
        for_each_unknown([&](std::size_t, Vertex v, bool further) {
            for (bool fixed : conditions_.fixed[v]) given.push_back(fixed || further ? 1 : 0);
            given.push_back(0);
        });
        return given;
    }

    void prescribe(const Array<Vertex, Vec3>& velocity) {
        for (Vertex v : numbering().vertex)
            for (int m = 0; m < 3; ++m)
                if (conditions_.fixed[v][static_cast<std::size_t>(m)]) guess_.velocity[v][m] = velocity[v][m];
    }

    /// The pressure that is guessed is that of where vertices stood: there is the weight between. What rests under gravity on a
    /// mesh that moves then needs no pass.
    void take_weight_along(const Array<Vertex, Vec3>& position) {
        if (options_.gravity == Vec3{} || gas_) return;
        Array<Vertex, double> density(position.size(), 0.0);  // of the lowest region at each vertex
        for_each_cell(cells_, [&](const auto& cell) {
            const Region region = cell_region(current_, cell);
            for (Vertex v : cell_vertices(current_, cell))
                if (!numbering().is_upper(v, region)) density[v] = material_[region].density;
        });
        for_each_unknown([&](std::size_t, Vertex v, bool further) {
            const double weighs = further ? material_[upper()[v]].density : density[v];
            pressure_of(v, further) += weighs * dot(options_.gravity, position[v] - stood_[v]);
        });
        stood_ = position;
    }

    void solve_stage(const StageTime& at, const Array<Vertex, Vec3>& old, double per_time) {
        const Array<Vertex, Vec3> position = between(before_, current_, at.share);
        take_weight_along(position);
        const double time = t_ + at.share * dt_;
        if (gas_) gas_->begin(at, position, guess_.velocity, mesh_velocity_);
        set_forces(current_, position, options_, time, material_);
        const auto open_pressure = pressures_at_faces(position, time);
        const FlowStage stage{current_,         position,  mesh_velocity_,     old,
                              guess_,           material_, conditions_.open,   open_pressure,
                              options_.gravity, per_time,  options_.convection, upper()};
        if (std::ranges::count(conditions_.closed, 1) > 0)
            share_of_volume_ = shares_of_volume(current_, cells_, blocks_.pattern, position);
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
        const double least = options_.scheme == FlowScheme::first_order ? long_forcing : forcing;
        const bool is_solution = left <= rounding * solver_.size_of_terms(unknown());  // as it is
        for (int pass = 1; left > wanted && !is_solution; ++pass) {
            if (pass > options_.most_passes || !std::isfinite(left)) give_up(pass, left / largest_left_);
            add(correction(stage, std::max(margin * wanted / left, least)));
            ++passes_;
            assemble(stage, false);
            const double before = left;
            left = solver_.size(system_.residual);
            const double reduction = left / before;
            if (left <= wanted || reduction * reduction * left <= wanted) continue;  // two more passes as this one
            if (left > stagnation * before && left <= rounding * solver_.size_of_terms(unknown())) break;
            assemble(stage, true);
            take_matrix(stage);
            left = solver_.size(system_.residual);
        }
        if (left > 0) error_ = left / largest_left_;
        let_rest_out(ranks_, blocks_.pattern, boundary_, conditions_, position,
                     gas_ ? gas_->densities() : Array<Vertex, double>(), system_.residual, guess_.velocity);
        if (gas_) gas_->end(at, position, guess_.velocity);
        if (!steady() && options_.convection) note_momentum(stage, at.weight * dt_);
        dissipated_ += at.weight * dt_ * dissipation(current_, cells_, position, material_, guess_.velocity);
        surfaces_.end(guess_.velocity, at.weight * dt_);
    }

    /// Where the density depends on the temperature: what flows then is one region alone.
    void find_expanding() {
        for (FlowMaterial& material : material_)
            if (const Array<Vertex, double>& end = material.densities; !end.empty())
                gas_.emplace(VertexMasses(before_, current_, cells_,
                                          start_.density.empty() ? end : start_.density, end, dt_),
                             blocks_.pattern, boundary_, material, dt_);
        for (Vertex v : numbering().vertex)
            if (gas_ && conditions_.closed[blocks_.pattern.piece_of(v)] != 0) refuse_enclosed(current_.position[v]);
    }
    [[noreturn]] void refuse_enclosed(const Vec3& place) const {
        std::ostringstream message;
        message << options_.key << ": what expands at (" << place.x << ", " << place.y << ", " << place.z
                << ") m has no way out to an open face: a density that depends on the temperature needs one";
        throw CaseError(message.str());
    }

    [[noreturn]] void give_up(int pass, double left) const {
        std::ostringstream message;
        message << "the flow did not converge: after " << pass - 1 << " passes of Newton's method " << left
                << " of the residual is left, t = " << t_ + dt_ << " s: smaller steps may help";
        throw SolverError(message.str());
    }

    void assemble(const FlowStage& stage, bool derivative) {
        heed(ranks_);
        assemble_blocks(current_, blocks_, FlowKernel{stage, derivative}, derivative, system_, ranks_.watch);
        surfaces_.add(guess_.velocity, stage.per_time > 0 ? 1 / stage.per_time : 0, derivative, system_);
        if (options_.convection && !steady()) surfaces_.add_passing(guess_.velocity, derivative, system_);
        for (std::size_t r = 0; r < rows().count() && gas_; ++r)
            system_.residual[block_size * r + 3] += gas_->expansion(vertex_of(r));
        reaction_ = system_.residual;
        spread_net_flux(ranks_, rows(), conditions_.closed, share_of_volume_, system_.residual);
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

    /// Of cells as they go with the mesh, or as if they stood, whichever is less: however short the step is, vertices that are
    /// smoothed go some way in it.
    [[nodiscard]] double largest_courant() const {
        if (steady()) return 0;
        const std::array<Array<Vertex, double>, 6> none;
        const FlowStage end{current_, current_.position, mesh_velocity_, guess_.velocity, guess_, material_,
                            conditions_.open, none, {}, 0, true, upper()};
        double most = 0, all = 0;
        for (const Cells* cells : {&blocks_.pattern.cells, &blocks_.pattern.upper})
            for_each_cell(*cells, [&](const auto& cell) {
                const CrossingRates rates = crossing_rates(end, cell);
                most = std::max(most, std::min(rates.going, rates.standing));
            });
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
    std::optional<ExpandingGas> gas_;  // if the density depends on the temperature
    FlowState guess_;
    Array<Vertex, Vec3> stood_;  // where the vertices of its pressure did [m]
    double level_ = 0;  // [Pa] of the pressure at open faces, beside which that of `guess_` is in pieces that reach them
    BlockSystem system_;
    std::vector<double> reaction_;  // the residual of the last assembly, as it is
    std::vector<double> share_of_volume_;  // per row, where a piece is closed
    Array<Vertex, Vec3> mesh_velocity_;
    FlowSolver solver_;
    bool triangular_ = false;  // the preconditioner
    double dissipated_ = 0;  // [J] in the stages so far
    Vec3 pushed_;            // [kg m/s] in them
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
