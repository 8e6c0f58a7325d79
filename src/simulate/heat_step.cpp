// One step of the heat equation: assembly and solution of the system derived in heat.h, from what the cells
// add to it (heat_cell.h) and what acts from outside (heat_conditions.h), within bounds (bounded.h).

#include <kropla/base/error.h>
#include "simulate/bounded.h"
#include "simulate/carried.h"
#include "simulate/heat_cell.h"
#include "simulate/heat_conditions.h"
#include "simulate/heat_step.h"
#include "simulate/solver.h"
#include "simulate/stop.h"
#include "simulate/surface_flux.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>

namespace kropla {
namespace {

constexpr int quick_passes = 40;   // of what is not linear; if these go to and fro,
constexpr int sure_passes = 60;    // so many that come nearer from one side, and quick ones from there, and so on
constexpr int most_passes = 400;   // of both, between two looks at bounds
constexpr int most_lowerings = 8;  // looks at bounds, before all is of low order
constexpr double noticeable = 1e-3;  // [-] of the range: a new extremum that is worth a second solution
constexpr double of_range = 1e-11;   // [-] of the range, and
constexpr double of_largest = 1e-12; // [-] of the largest temperature: what a solution leaves
constexpr double exact = 1e-13;         // [-] the solver's tolerance, and
constexpr double enough_to_look = 1e-8;  // [-] where a new extremum of a noticeable share is all that is looked for
constexpr double settled = 1e-12;  // [-] of the largest temperature: a pass that changes less is the last

Array<Region, Array<Vertex, Vec3>> carry_bodies(const Mesh& before, const Mesh& current, const HeatOptions& options) {
    Array<Region, Array<Vertex, Vec3>> carried(options.regions.size());
    for (Region body : regions_that(Carried::with_mesh, options)) carried[body] = carried_along(before, current, body);
    return carried;
}

/// The signs with which heat comes from outside.
struct Signs {
    bool cools = false, heats = false;

    void note(double value) {
        cools = cools || value < 0;
        heats = heats || value > 0;
    }
};

HeatExtremes extremes(const HeatStep& step, const std::vector<Vertex>& vertices, const HeatConditions& conditions,
                      const Array<Vertex, double>& after) {
    const Vertex first = vertices.front();
    const double start = step.old_temperature[first];
    HeatExtremes found{{after[first], step.current.position[first]}, {after[first], step.current.position[first]},
                       start, start};
    const auto widen = [&](double value) {
        found.lower = std::min(found.lower, value);
        found.upper = std::max(found.upper, value);
    };
    for (Vertex v : vertices) {
        widen(step.old_temperature[v]);
        if (after[v] < found.least.value) found.least = {after[v], step.current.position[v]};
        if (after[v] > found.most.value) found.most = {after[v], step.current.position[v]};
    }
    for (const FixedValue& fixed : conditions.fixed) widen(fixed.value);
    Signs signs;
    for (const auto& source : conditions.source)
        for (double value : source) signs.note(value);
    for (const BoundaryShare& share : conditions.shares) {
        signs.note(share.flux);
        if (share.exchanges()) widen(share.ambient);
    }
    if (signs.cools) found.lower = -INFINITY;
    if (signs.heats) found.upper = INFINITY;
    return found;
}

/// The step while it is solved.
class HeatSolution {
public:
    HeatSolution(const Ranks& ranks, HeatStep& step, const HeatConditions& conditions)
        : ranks_(ranks), step_(step), conditions_(conditions),
          made_pattern_(pattern_for(ranks, step)), pattern_(*made_pattern_), after_(step.old_temperature),
          marked_(vertices().size(), 0), system_(pattern_.rows), solver_(ranks, pattern_.rows),
          allowance_(pattern_.rows.count()), linear_(is_linear()) {
        for (const FixedValue& fixed : conditions.fixed) after_[fixed.vertex] = fixed.value;
        fill_old_enthalpies();
    }

    void begin_with(const Array<Vertex, double>& guess) {
        after_ = guess;
        for (const FixedValue& fixed : conditions_.fixed) after_[fixed.vertex] = fixed.value;
    }

    void solve_all() {
        const std::vector<double> before = per_row(step_.old_temperature);
        for (int looks = 1;; ++looks) {
            settle();
            if (!mark_extrema(ranks_, pattern_, before, per_row(after_), allowance_, negligible(), marked_)) break;
            if (looks == most_lowerings) std::ranges::fill(marked_, 1);
            lower_marked();
        }
        if (linear_) solve_to(exact);
        solved_ = after_;
        exchanged_.assign(pattern_.rows.column.size(), 0.0);
        if (!linear_) return;
        const HeatExtremes bounds = extremes(step_, vertices(), conditions_, after_);
        keep_bound(bounds.lower, 1);
        keep_bound(bounds.upper, -1);
    }

    [[nodiscard]] const Array<Vertex, double>& after() const { return after_; }

    [[nodiscard]] HeatReport report() const {
        const Assembled assembled{pattern_, systems_, diffusion_, exchanged_, solved_};
        HeatReport report;
        report.iterations = iterations_;
        report.passes = passes_;
        report.diffused = static_cast<std::size_t>(std::ranges::count(marked_, 1));
        report.error = error_;
        if (!step_.only.exists()) report.surfaces = surface_fluxes(ranks_, step_.current, assembled, step_.dt);
        report.extremes = extremes(step_, vertices(), conditions_, after_);
        report.balance = balance(assembled);
        return report;
    }

private:
    /// The flow's, if it is of the same cells.
    static std::shared_ptr<const Pattern> pattern_for(const Ranks& ranks, const HeatStep& step) {
        if (step.flow.pattern && !step.only.exists()) return step.flow.pattern;
        return std::make_shared<Pattern>(make_pattern(step.current, living_cells(step.current, step.only), ranks));
    }
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return pattern_.numbering.vertex; }
    [[nodiscard]] Vertex vertex_of(std::size_t owned_row) const {
        return vertices()[static_cast<std::size_t>(pattern_.rows.first_row) + owned_row];
    }
    [[nodiscard]] std::vector<double> per_row(const Array<Vertex, double>& values) const {
        std::vector<double> row;
        row.reserve(vertices().size());
        for (Vertex v : vertices()) row.push_back(values[v]);
        return row;
    }
    void per_vertex(Array<Vertex, double>& values, const auto& value_of) const {
        values.resize(after_.size(), 0.0);
        for (Vertex v : vertices()) values[v] = value_of(v);
    }

    [[nodiscard]] bool is_linear() const {
        for (Region r : step_.enthalpy.indices())
            if (!step_.enthalpy[r].proportional() || !material(r).conductivity.constant()) return false;
        return std::ranges::none_of(conditions_.shares, [](const BoundaryShare& share) { return share.radiation > 0; });
    }
    [[nodiscard]] const HeatMaterial& material(Region r) const {
        return step_.options.regions[static_cast<std::size_t>(r.value)].material;
    }

    void fill_old_enthalpies() {
        for (Region r : step_.enthalpy.indices())
            if (const Enthalpy& h = step_.enthalpy[r]; !h.proportional())
                per_vertex(step_.material[r].old, [&](Vertex v) { return h(step_.old_temperature[v]); });
    }

    void lower_marked() {
        fresh_ = Array<Vertex, char>(after_.size(), 0);
        step_.low.resize(after_.size(), 0);
        for (std::size_t r = 0; r < marked_.size(); ++r) {
            if (marked_[r] == 0) continue;
            fresh_[vertices()[r]] = step_.low[vertices()[r]] == 0;
            step_.low[vertices()[r]] = 1;
        }
    }

    /// By how much a value may be a new extremum, before it is cared for: what is not linear cannot be repaired.
    [[nodiscard]] double negligible() const {
        double least = INFINITY, most = -INFINITY;
        for (Vertex v : vertices()) {
            least = std::min({least, step_.old_temperature[v], after_[v]});
            most = std::max({most, step_.old_temperature[v], after_[v]});
        }
        const double share = linear_ ? noticeable : of_range;
        return share * (most - least) + of_largest * std::max(std::abs(least), std::abs(most));
    }

    void keep_bound(double bound, double side) {
        if (!std::isfinite(bound)) return;
        std::vector<double> values = per_row(after_);
        const Repair done = repair(ranks_, pattern_, capacity_, bound, side, values);
        for (std::size_t k = 0; k < exchanged_.size(); ++k) exchanged_[k] += done.gained[k];
        for (std::size_t r = 0; r < values.size(); ++r) after_[vertices()[r]] = values[r];
    }

    /// Solves; if the step is not linear, again and again about what came out.
    void settle() {
        surely_ = false;
        for (int pass = 1;; ++pass) {
            take_as_guess();
            const bool about_one = !surely_ || falls_at_ == after_;  // all is taken as linear about the same temperatures
            const double change = solve_once();
            if (linear_ || (change <= settled && about_one)) return;
            if (pass == most_passes)
                throw SolverError(not_settled(change, pass));
            const bool sure_next = pass % (quick_passes + sure_passes) >= quick_passes;
            if (sure_next && !surely_) falls_at_ = {};
            else if (surely_ && change <= settled) falls_at_ = after_;
            surely_ = sure_next;
        }
    }

    [[nodiscard]] std::string not_settled(double change, int pass) const {
        std::ostringstream message;
        message << step_.options.key << ": the field does not settle, it still changes by " << change
                << " of its largest value in pass " << pass;
        return message.str();
    }

    /// About the guess. Returns by how much the solution differs from it, by the largest temperature.
    double solve_once() {
        ask_cells(pattern_.cells, HeatKernel{step_},
                  [&](const auto& cell) { return !linear_ || systems_are_to_change(cell); }, systems_, ranks_.watch);
        assemble();
        heed(ranks_);  // a rank that was stopped in there is met before anything is done together
        solver_.take(system_, {.name = step_.options.key, .preconditioner = preconditioner_for(ranks_, system_)});
        ++passes_;
        return solve_to(linear_ ? enough_to_look : exact);
    }

    double solve_to(double tolerance) {
        const Solution solution = solver_.solve(tolerance);
        iterations_ = std::max(iterations_, solution.iterations);
        error_ = solution.error;
        return take(solution.value);
    }

    template <class Cell>
    [[nodiscard]] bool systems_are_to_change(const Cell& cell) const {
        return fresh_.empty() || std::ranges::any_of(cell_vertices(step_.current, cell),
                                                     [&](Vertex v) { return fresh_[v] != 0; });
    }

    /// Evaluates what depends on the temperature.
    void take_as_guess() {
        if (linear_) return;
        step_.guess = after_;
        for (Region r : step_.material.indices()) {
            MaterialState& state = step_.material[r];
            if (const Property& k = material(r).conductivity; !k.constant())
                per_vertex(state.conductivity, [&](Vertex v) { return k(after_[v]); });
            const Enthalpy& h = step_.enthalpy[r];
            if (h.proportional()) continue;
            per_vertex(state.enthalpy, [&](Vertex v) { return h(after_[v]); });
            per_vertex(state.slope, [&](Vertex v) { return h.slope(after_[v]); });
            if (surely_) take_falls_apart(h, state);
        }
    }

    /// The enthalpy is what only bends upwards, less what its slope falls by. Taken as linear about temperatures of their
    /// own, the latter about those at which the former had settled, from none at all on, both settle from one side, if
    /// conduction lets no neighbour push another away: [Casulli, Zanolli 2012] Iterative solutions of mildly nonlinear
    /// systems. J. Comput. Appl. Math. 236. It takes more passes than nearest_to_guess, where that settles.
    void take_falls_apart(const Enthalpy& h, MaterialState& state) const {
        for (Vertex v : vertices()) {
            state.enthalpy[v] += h.fallen(after_[v]);
            state.slope[v] += h.fallen_slope(after_[v]);
            if (falls_at_.empty()) continue;
            const double at = falls_at_[v];
            state.enthalpy[v] -= h.fallen(at) + h.fallen_slope(at) * (after_[v] - at);
            state.slope[v] -= h.fallen_slope(at);
        }
    }

    /// Takes the solution. Returns by how much it differs from the guess, by the largest temperature.
    double take(const std::vector<double>& solution) {
        double change = 0, largest = 0;
        for (std::size_t r = 0; r < solution.size(); ++r) {
            const Vertex v = vertices()[r];
            const double taken = linear_ || surely_ ? solution[r] : nearest_to_guess(v, solution[r]);
            change = std::max(change, std::abs(solution[r] - after_[v]));
            largest = std::max(largest, std::abs(solution[r]));
            after_[v] = taken;
        }
        return largest > 0 ? change / largest : 0;
    }

    /// A step of Newton's method may be read as one in the temperature or, by the slope at the guess, as one in the
    /// enthalpy; where a material begins or ends to melt these are far apart. The lesser is taken: no vertex leaps over
    /// what it would melt by, nor out of melting by more than its neighbours are warm. Either alone goes to and fro. To
    /// change between two unknowns where a curve bends is after [Brenner, Cances 2017] Improving Newton's method performance
    /// by parametrization: the case of the Richards equation. SIAM J. Numer. Anal. 55; here vertex by vertex, afterwards.
    [[nodiscard]] double nearest_to_guess(Vertex v, double solution) const {
        double nearest = solution;
        for (Region r : step_.material.indices()) {
            const MaterialState& state = step_.material[r];
            if (state.enthalpy.empty() || state.slope[v] == 0) continue;  // not of this region
            const double enthalpy = state.enthalpy[v] + state.slope[v] * (solution - step_.guess[v]);
            const double by_enthalpy = step_.enthalpy[r].temperature(enthalpy);
            if (std::abs(by_enthalpy - step_.guess[v]) < std::abs(nearest - step_.guess[v])) nearest = by_enthalpy;
        }
        return nearest;
    }

    void assemble() {
        LinearSystem& system = system_;
        system.clear();
        add_cells(pattern_, systems_, system);
        add_through(system);
        note_capacities(system);
        diffusion_ = add_diffusion(pattern_, systems_, marked_, system);
        allowance_ = Allowance(pattern_.rows.count());
        allow_loads(system);
        add_shares(system);
        for (std::size_t r = 0; r < system.guess.size(); ++r) system.guess[r] = after_[vertex_of(r)];
        for (const FixedValue& fixed : conditions_.fixed) {
            const int row = pattern_.numbering.row[fixed.vertex];
            if (system.owns(row)) allowance_.fixed[system.local(row)] = 1;
            fix_unknown(system, row, fixed.value);
        }
    }

    /// What the flow takes out of the box has the temperature that is there; what it brings in, that of the step's begin:
    /// with the one at its end, the gas beyond would follow what is downstream.
    void add_through(LinearSystem& system) const {
        for (const auto& [v, region, face, rate] : step_.flow.through) {
            const int row = row_of(v, region);
            if (row < 0 || !system.owns(row)) continue;
            const std::size_t r = system.local(row);
            const Enthalpy& h = step_.enthalpy[region];
            const MaterialState& state = step_.material[region];
            const double taken = step_.dt * rate, slope = h.proportional() ? h.slope(0) : state.slope[v];
            if (rate < 0) {
                system.right[r] -= taken * h(step_.old_temperature[v]);
                continue;
            }
            system.row_sum[r] += taken * slope;
            if (!h.proportional()) system.right[r] += taken * (slope * step_.guess[v] - state.enthalpy[v]);
        }
    }
    /// -1 where the region is not stepped.
    [[nodiscard]] int row_of(Vertex v, Region region) const {
        return step_.only.exists() && region != step_.only ? -1 : pattern_.numbering.row[v];
    }

    /// What each row of all ranks holds per kelvin, but for those that are fixed.
    void note_capacities(const LinearSystem& system) {
        capacity_.assign(vertices().size(), 0.0);
        std::ranges::copy(system.held, capacity_.begin() + pattern_.rows.first_row);
        MPI_Allreduce(MPI_IN_PLACE, capacity_.data(), static_cast<int>(capacity_.size()), MPI_DOUBLE, MPI_SUM,
                      ranks_.communicator);
        for (const FixedValue& fixed : conditions_.fixed)
            capacity_[static_cast<std::size_t>(pattern_.numbering.row[fixed.vertex])] = 0;
    }

    /// What comes from outside may raise a value beyond those around it: by all of it in the vertex's own share.
    void allow(std::size_t row, double load, double held) {
        const double rise = linear_ && held > 0 ? load / held : load == 0 ? 0 : std::copysign(INFINITY, load);
        (rise > 0 ? allowance_.above : allowance_.below)[row] += std::abs(rise);
    }
    void allow_loads(const LinearSystem& system) {
        for (std::size_t r = 0; r < pattern_.rows.count(); ++r) {
            double load = 0;
            for (const auto& at : pattern_.tets.of(r)) load += systems_.tets[at.cell].load[at.corner];
            for (const auto& at : pattern_.prisms.of(r)) load += systems_.prisms[at.cell].load[at.corner];
            allow(r, load, system.row_sum[r]);
        }
    }

    void add_shares(LinearSystem& system) {
        for (const BoundaryShare& share : conditions_.shares) {
            const int row = pattern_.numbering.row[share.vertex];
            if (!system.owns(row)) continue;
            const std::size_t r = system.local(row);
            allow(r, step_.dt * share.flux, system.row_sum[r]);
            if (share.exchanges()) {
                allowance_.least[r] = std::min(allowance_.least[r], share.ambient);
                allowance_.most[r] = std::max(allowance_.most[r], share.ambient);
            }
            const double guess = after_[share.vertex], rise = step_.dt * share.slope(guess);
            system.row_sum[r] += rise;
            system.held[r] += rise;
            system.right[r] += step_.dt * (share.flux - share.given(guess)) + rise * guess;
        }
    }

    [[nodiscard]] HeatBalance balance(const Assembled& assembled) const {
        HeatBalance sum;
        const MaterialFlow& flow = step_.flow;
        sum.before = energy(step_.before, step_.options, step_.old_temperature, step_.only, {flow.by_mass, flow.density_before});
        sum.after = energy(step_.current, step_.options, after_, step_.only, {flow.by_mass, flow.density});
        sum.surfaces.assign(step_.options.surfaces.size(), 0.0);
        sum.sources.assign(step_.options.regions.size(), 0.0);
        sum.held.assign(step_.options.regions.size(), 0.0);
        Array<Vertex, double> acting(after_.size(), 0.0);  // by conditions [J]
        for (const BoundaryShare& share : conditions_.shares) {
            const double in = step_.dt * (share.flux - share.given(solved_[share.vertex]));
            acting[share.vertex] += in;
            if (share.origin.kind == Origin::Kind::face) sum.faces[share.origin.number] += in;
            else sum.surfaces[share.origin.number - 1] += in;
        }
        for (const auto& [v, region, face, rate] : step_.flow.through) {
            if (row_of(v, region) < 0) continue;
            const double temperature = rate < 0 ? step_.old_temperature[v] : solved_[v];
            const double in = -step_.dt * rate * step_.enthalpy[region](temperature);
            acting[v] += in;
            sum.faces[face] += in;
        }
        const auto anything = [](const auto& source) { return !source.empty(); };
        if (std::any_of(conditions_.source.begin(), conditions_.source.end(), anything)) sum.sources = sources();
        std::vector<double> kept(conditions_.fixed.size(), 0.0);  // what the cells gained and nothing acting on it brought
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const Vertex v = conditions_.fixed[k].vertex;
            const int row = pattern_.numbering.row[v] - pattern_.rows.first_row;
            if (row < 0 || static_cast<std::size_t>(row) >= pattern_.rows.count()) continue;
            kept[k] = gained_at(assembled, step_.current, static_cast<std::size_t>(row), [](const auto&) { return true; },
                                [](Vertex) { return true; }) - acting[v];
        }
        MPI_Allreduce(MPI_IN_PLACE, kept.data(), static_cast<int>(kept.size()), MPI_DOUBLE, MPI_SUM, ranks_.communicator);
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const Origin origin = conditions_.fixed[k].origin;
            (origin.kind == Origin::Kind::face ? sum.faces[origin.number] : sum.held[origin.number]) += kept[k];
        }
        return sum;
    }

    [[nodiscard]] std::vector<double> sources() const {
        std::vector<double> sum(step_.options.regions.size(), 0.0);
        for_each_share(step_.current, living_cells(step_.current, step_.only), [&](const auto& cell, Vertex v, double volume) {
            const Region region = cell_region(step_.current, cell);
            if (const auto& source = conditions_.source[region]; !source.empty())
                sum[static_cast<std::size_t>(region.value)] += step_.dt * volume * source[v];
        });
        return sum;
    }

    const Ranks& ranks_;
    HeatStep& step_;
    const HeatConditions& conditions_;
    std::shared_ptr<const Pattern> made_pattern_;
    const Pattern& pattern_;
    Array<Vertex, double> after_;
    Array<Vertex, double> solved_;  // before it was repaired: what the rows of the system speak of
    std::vector<char> marked_;    // rows of low order
    Array<Vertex, char> fresh_;   // that became so last; empty: none has
    CellSystems systems_;
    LinearSystem system_;
    Solver solver_;
    std::vector<double> diffusion_;  // along each coupling of the rank's rows
    std::vector<double> exchanged_;  // along it, by repair [J]
    std::vector<double> capacity_;   // of each row of all ranks [J/K]
    Allowance allowance_;
    bool linear_;
    bool surely_ = false;             // as take_falls_apart has it
    Array<Vertex, double> falls_at_;  // temperatures about which falls of slopes are taken as linear; empty: there are none
    int iterations_ = 0, passes_ = 0;
    double error_ = 0;
};

/// A time [s] after which nothing is left of how a steady state began: heat passes the domain ten million times.
double long_enough(const Mesh& mesh, const HeatOptions& options) {
    Vec3 least{INFINITY, INFINITY, INFINITY}, most = -1.0 * least;
    for_each_cell(living_cells(mesh), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) {
            for (int axis = 0; axis < 3; ++axis) {
                least[axis] = std::min(least[axis], mesh.position[v][axis]);
                most[axis] = std::max(most[axis], mesh.position[v][axis]);
            }
        }
    });
    double slowest = 0;  // [s/m^2]
    for (const HeatRegion& region : options.regions) {
        const Enthalpy enthalpy(region.material);
        for (double k : region.material.conductivity.values())
            slowest = std::max(slowest, enthalpy.slope(region.initial.value) / k);
    }
    return 1e7 * slowest * squared_norm(most - least);
}

HeatStep heat_step(const Mesh& before, const Mesh& current, const HeatOptions& options, const HeatConditions& conditions,
                   const MaterialFlow& flow, const Array<Vertex, double>& values, double dt) {
    return {.before = before,
            .current = current,
            .options = options,
            .old_temperature = values,
            .flow = flow,
            .carried = carry_bodies(before, current, options),
            .source = conditions.source,
            .dt = dt,
            .enthalpy = enthalpy_curves(options, flow.by_mass),
            .material = Array<Region, MaterialState>(options.regions.size())};
}

void check_step(const Mesh& mesh, const HeatOptions& options, double dt) {
    check_heat(options, mesh);
    if (!(dt > 0)) throw CaseError(options.key + ": the step must be positive, got " + std::to_string(dt) + " s");
}

}  // namespace

std::vector<Region> regions_that(Carried move, const HeatOptions& options) {
    std::vector<Region> regions;
    for (std::size_t r = 0; r < options.regions.size(); ++r)
        if (options.regions[r].carried == move) regions.push_back(Region(r));
    return regions;
}

double HeatBalance::brought() const {
    double sum = std::accumulate(faces.begin(), faces.end(), 0.0);
    for (const auto* parts : {&surfaces, &sources, &held}) sum = std::accumulate(parts->begin(), parts->end(), sum);
    return sum;
}

HeatReport step_heat_in(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                        const MaterialFlow& flow, Region only, Array<Vertex, double>& values, double t, double dt,
                        const Array<Vertex, double>& guess) {
    const HeatConditions conditions = heat_conditions(before, current, options, t, dt, ranks.watch);
    HeatStep step = heat_step(before, current, options, conditions, flow, values, dt);
    step.only = only;
    HeatSolution solution(ranks, step, conditions);
    if (!guess.empty()) solution.begin_with(guess);
    solution.solve_all();
    HeatReport report = solution.report();
    report.potential_iterations = flow.iterations;
    values = solution.after();
    return report;
}

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt) {
    check_step(current, options, dt);
    const MaterialFlow flow = material_flow(ranks, before, current, regions_that(Carried::at_rest, options), dt);
    return step_heat_in(ranks, before, current, options, flow, {}, temperature.values, t, dt);
}

HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     const MaterialFlow& flow, NodalField& temperature, double t, double dt,
                     const Array<Vertex, double>& guess) {
    check_step(current, options, dt);
    return step_heat_in(ranks, before, current, options, flow, {}, temperature.values, t, dt, guess);
}

void keep_within(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, double least, double most,
                 Array<Vertex, double>& temperature) {
    const Cells cells = living_cells(mesh);
    const Pattern pattern = make_pattern(mesh, cells, ranks);
    const std::vector<double> capacity = capacities(options);
    std::vector<double> held(pattern.numbering.vertex.size(), 0.0), values;
    for_each_share(mesh, cells, [&](const auto& cell, Vertex v, double volume) {
        held[static_cast<std::size_t>(pattern.numbering.row[v])] +=
            capacity[static_cast<std::size_t>(cell_region(mesh, cell).value)] * volume;
    });
    for (Vertex v : pattern.numbering.vertex) values.push_back(temperature[v]);
    (void)repair(ranks, pattern, held, least, 1, values);
    (void)repair(ranks, pattern, held, most, -1, values);
    for (std::size_t r = 0; r < values.size(); ++r) temperature[pattern.numbering.vertex[r]] = values[r];
}

void settle_start(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, NodalField& field) {
    const double dt = long_enough(mesh, options);
    HeatConditions conditions = heat_conditions(mesh, mesh, options, 0, dt, ranks.watch);
    Array<Vertex, char> known(mesh.position.size(), 0);
    for (const FixedValue& fixed : conditions.fixed) known[fixed.vertex] = 1;
    for (std::size_t r = 0; r < options.regions.size(); ++r) {
        if (options.regions[r].initial.steady) continue;
        for_each_cell(living_cells(mesh, Region(r)), [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell))
                if (std::exchange(known[v], 1) == 0)
                    conditions.fixed.push_back({v, field.values[v], {Origin::Kind::held, r}});
        });
    }
    const MaterialFlow rest{Array<Region, Array<Vertex, double>>(options.regions.size())};
    HeatStep step = heat_step(mesh, mesh, options, conditions, rest, field.values, dt);
    HeatSolution solution(ranks, step, conditions);
    solution.solve_all();
    field.values = solution.after();
}

}  // namespace kropla
