// The solution of a step of the heat equation: the system derived in heat.h is assembled from what the cells add to it
// (heat_cell.h) and what acts from outside (heat_conditions.h), and solved, again where it is not linear, within bounds
// (bounded.h).
#include "simulate/heat_solution.h"

#include <kropla/base/error.h>
#include "simulate/heat_balance.h"
#include "simulate/stop.h"
#include "simulate/surface_flux.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace kropla {
namespace {

constexpr int quick_passes = 40;   // of what is not linear; if these go to and fro,
constexpr int sure_passes = 60;    // so many that come nearer from one side, if no neighbour is pushed away; then rows that do
                                   //   not settle are made of low order, so that none is, conductivities follow by halves, and
                                   //   quick ones from there, and so on
constexpr int most_passes = 400;   // of both, between two looks at bounds
constexpr int most_lowerings = 8;  // looks at bounds, before all is of low order
constexpr double noticeable = 1e-3;      // [-] of the range: a new extremum that is worth a second solution
constexpr double of_range = 1e-11;       // [-] of the range, and
constexpr double of_largest = 1e-12;     // [-] of the largest temperature: what a solution leaves
constexpr double exact = 1e-13;          // [-] the solver's tolerance, and
constexpr double enough_to_look = 1e-8;  // [-] where a new extremum of a noticeable share is all that is looked for
constexpr double settled = 1e-12;        // [-] of the largest temperature: a pass that changes less is the last

/// The flow's, if it is of the same cells.
std::shared_ptr<const Pattern> pattern_for(const Ranks& ranks, const HeatStep& step) {
    if (step.flow.pattern && !step.only.exists()) return step.flow.pattern;
    return std::make_shared<Pattern>(make_pattern(step.current, living_cells(step.current, step.only), ranks));
}

}  // namespace

HeatSolution::HeatSolution(const Ranks& ranks, HeatStep& step, const HeatConditions& conditions)
    : ranks_(ranks), step_(step), conditions_(conditions), pattern_(pattern_for(ranks, step)),
      after_(step.old_temperature), marked_(vertices().size(), 0), system_(pattern_->rows),
      solver_(ranks, pattern_->rows), allowance_(pattern_->rows.count()), linear_(is_linear()) {
    set_fixed();
    for (Region r : step_.enthalpy.indices())
        if (const Enthalpy& h = step_.enthalpy[r]; !h.proportional())
            per_vertex(step_.material[r].old, [&](Vertex v) { return h(step_.old_temperature[v]); });
}

void HeatSolution::begin_with(const Array<Vertex, double>& guess) {
    after_ = guess;
    set_fixed();
}

void HeatSolution::solve_all() {
    const std::vector<double> before = per_row(step_.old_temperature);
    for (int looks = 1;; ++looks) {
        settle();
        if (!mark_extrema(ranks_, *pattern_, before, per_row(after_), allowance_, negligible(), marked_)) break;
        if (looks == most_lowerings) std::ranges::fill(marked_, 1);
        lower_marked();
    }
    if (linear_) solve_to(exact);
    solved_ = after_;
    exchanged_.assign(pattern_->rows.column.size(), 0.0);
    if (!linear_) return;
    const HeatExtremes bounds = heat_extremes(step_, conditions_, vertices(), after_);
    keep_bound(bounds.lower, 1);
    keep_bound(bounds.upper, -1);
}

HeatReport HeatSolution::report() const {
    const Assembled assembled{*pattern_, systems_, diffusion_, exchanged_, solved_};
    HeatReport report;
    report.iterations = iterations_;
    report.passes = passes_;
    report.diffused = static_cast<std::size_t>(std::ranges::count(marked_, 1));
    report.error = error_;
    if (!step_.only.exists()) report.surfaces = surface_fluxes(ranks_, step_.current, assembled, step_.dt);
    report.extremes = heat_extremes(step_, conditions_, vertices(), after_);
    report.balance = heat_balance(ranks_, step_, conditions_, assembled, after_);
    return report;
}

std::vector<double> HeatSolution::per_row(const Array<Vertex, double>& values) const {
    std::vector<double> row;
    row.reserve(vertices().size());
    for (Vertex v : vertices()) row.push_back(values[v]);
    return row;
}

void HeatSolution::per_vertex(Array<Vertex, double>& values, const auto& value_of) const {
    values.resize(after_.size(), 0.0);
    for (Vertex v : vertices()) values[v] = value_of(v);
}

bool HeatSolution::is_linear() const {
    for (Region r : step_.enthalpy.indices())
        if (!step_.enthalpy[r].proportional() || !material(r).conductivity.constant()) return false;
    return std::ranges::none_of(conditions_.shares, [](const BoundaryShare& share) { return share.radiation > 0; });
}

void HeatSolution::set_fixed() {
    for (const FixedValue& fixed : conditions_.fixed) after_[fixed.vertex] = fixed.value;
}

void HeatSolution::lower_marked() {
    fresh_ = Array<Vertex, char>(after_.size(), 0);
    step_.low.resize(after_.size(), 0);
    for (std::size_t r = 0; r < marked_.size(); ++r) {
        if (marked_[r] == 0) continue;
        fresh_[vertices()[r]] = step_.low[vertices()[r]] == 0;
        step_.low[vertices()[r]] = 1;
    }
}

void HeatSolution::lower_unsettled() {
    std::vector<char> rows(changes_.size());
    std::ranges::transform(changes_, rows.begin(), [](double change) { return change > settled ? 1 : 0; });
    if (mark_with_those_near(ranks_, *pattern_, std::move(rows), marked_)) lower_marked();
}

/// By how much a value may be a new extremum, before it is cared for: what is not linear cannot be repaired.
double HeatSolution::negligible() const {
    double least = INFINITY, most = -INFINITY;
    for (Vertex v : vertices()) {
        least = std::min({least, step_.old_temperature[v], after_[v]});
        most = std::max({most, step_.old_temperature[v], after_[v]});
    }
    const double share = linear_ ? noticeable : of_range;
    return share * (most - least) + of_largest * std::max(std::abs(least), std::abs(most));
}

void HeatSolution::keep_bound(double bound, double side) {
    if (!std::isfinite(bound)) return;
    std::vector<double> values = per_row(after_);
    const Repair done = repair(ranks_, *pattern_, capacity_, bound, side, values);
    for (std::size_t k = 0; k < exchanged_.size(); ++k) exchanged_[k] += done.gained[k];
    for (std::size_t r = 0; r < values.size(); ++r) after_[vertices()[r]] = values[r];
}

/// Solves; if the step is not linear, again and again about what came out, by turns as said above.
void HeatSolution::settle() {
    constexpr int looked_at = 10;   // passes, in which changes
    constexpr double nearing = 0.5;  // fall by this at least where they come to an end
    surely_ = slowly_ = false;
    int in_turn = 0;
    double change_before = INFINITY;
    bool comes_nearer = false;
    for (int pass = 1;; ++pass) {
        take_as_guess();
        const bool about_one = !surely_ || falls_at_ == after_;  // all is taken as linear about the same temperatures
        const double change = solve_once();
        if (linear_ || (change <= settled && about_one)) return;
        if (pass == most_passes) throw SolverError(not_settled(change, pass));
        if (++in_turn % looked_at == 0) {
            comes_nearer = change < nearing * change_before;
            change_before = change;
        }
        if (in_turn < (surely_ ? sure_passes : quick_passes) || comes_nearer) {
            if (surely_ && change <= settled) falls_at_ = after_;
            continue;
        }
        if (surely_) {
            lower_unsettled();
            slowly_ = true;
        }
        surely_ = !surely_;
        falls_at_ = {};
        in_turn = 0;
        change_before = INFINITY;
    }
}

std::string HeatSolution::not_settled(double change, int pass) const {
    std::ostringstream message;
    message << step_.options.key << ": the field does not settle, it still changes by " << change
            << " of its largest value in pass " << pass;
    return message.str();
}

/// About the guess. Returns by how much the solution differs from it, by the largest temperature.
double HeatSolution::solve_once() {
    const auto is_to_change = [&](const auto& cell) {
        return !linear_ || fresh_.empty() ||
               std::ranges::any_of(cell_vertices(step_.current, cell), [&](Vertex v) { return fresh_[v] != 0; });
    };
    ask_cells(pattern_->cells, HeatKernel{step_}, is_to_change, systems_, ranks_.watch);
    assemble();
    heed(ranks_);  // a rank that was stopped in there is met before anything is done together
    solver_.take(system_, {.name = step_.options.key, .preconditioner = preconditioner_for(ranks_, system_)});
    ++passes_;
    return solve_to(linear_ ? enough_to_look : exact);
}

double HeatSolution::solve_to(double tolerance) {
    const Solution solution = solver_.solve(tolerance);
    iterations_ = std::max(iterations_, solution.iterations);
    error_ = solution.error;
    return take(solution.value);
}

/// Takes the solution. Returns by how much it differs from the guess, by the largest temperature.
double HeatSolution::take(const std::vector<double>& solution) {
    double change = 0, largest = 0;
    changes_.resize(solution.size());
    for (std::size_t r = 0; r < solution.size(); ++r) {
        const Vertex v = vertices()[r];
        const double taken = linear_ || surely_ ? solution[r] : nearest_to_guess(v, solution[r]);
        changes_[r] = std::abs(solution[r] - after_[v]);
        change = std::max(change, changes_[r]);
        largest = std::max(largest, std::abs(solution[r]));
        after_[v] = taken;
    }
    for (double& of_row : changes_) of_row = largest > 0 ? of_row / largest : 0;
    return largest > 0 ? change / largest : 0;
}

/// Evaluates what depends on the temperature.
void HeatSolution::take_as_guess() {
    if (linear_) return;
    step_.guess = after_;
    for (Region r : step_.material.indices()) {
        MaterialState& state = step_.material[r];
        if (const Property& k = material(r).conductivity; !k.constant())
            per_vertex(state.conductivity, [&](Vertex v) {
                const double there = k(after_[v]);
                return slowly_ ? 0.5 * (state.conductivity[v] + there) : there;
            });
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
void HeatSolution::take_falls_apart(const Enthalpy& h, MaterialState& state) const {
    for (Vertex v : vertices()) {
        state.enthalpy[v] += h.fallen(after_[v]);
        state.slope[v] += h.fallen_slope(after_[v]);
        if (falls_at_.empty()) continue;
        const double at = falls_at_[v];
        state.enthalpy[v] -= h.fallen(at) + h.fallen_slope(at) * (after_[v] - at);
        state.slope[v] -= h.fallen_slope(at);
    }
}

/// A step of Newton's method may be read as one in the temperature or, by the slope at the guess, as one in the
/// enthalpy; where a material begins or ends to melt these are far apart. The lesser is taken: no vertex leaps over
/// what it would melt by, nor out of melting by more than its neighbours are warm. Either alone goes to and fro. To
/// change between two unknowns where a curve bends is after [Brenner, Cances 2017] Improving Newton's method performance
/// by parametrization: the case of the Richards equation. SIAM J. Numer. Anal. 55; here vertex by vertex, afterwards.
double HeatSolution::nearest_to_guess(Vertex v, double solution) const {
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

void HeatSolution::assemble() {
    system_.clear();
    add_cells(*pattern_, systems_, system_);
    add_through();
    note_capacities();
    diffusion_ = add_diffusion(*pattern_, systems_, marked_, system_);
    allowance_ = Allowance(pattern_->rows.count());
    allow_loads();
    add_shares();
    for (std::size_t r = 0; r < system_.guess.size(); ++r) system_.guess[r] = after_[vertex_of(r)];
    fix_values();
}

/// What the flow takes out of the box has the temperature that is there; what it brings in, that of the step's begin:
/// with the one at its end, the gas beyond would follow what is downstream.
void HeatSolution::add_through() {
    for (const auto& [v, region, face, rate] : step_.flow.through) {
        const int row = pattern_->numbering.row[v];
        if (!step_.steps(region) || !system_.owns(row)) continue;
        const std::size_t r = system_.local(row);
        const Enthalpy& h = step_.enthalpy[region];
        const MaterialState& state = step_.material[region];
        const double taken = step_.dt * rate, slope = h.proportional() ? h.slope(0) : state.slope[v];
        if (rate < 0) {
            system_.right[r] -= taken * h(step_.old_temperature[v]);
            continue;
        }
        system_.row_sum[r] += taken * slope;
        if (!h.proportional()) system_.right[r] += taken * (slope * step_.guess[v] - state.enthalpy[v]);
    }
}

/// What each row of all ranks holds per kelvin, but for those that are fixed.
void HeatSolution::note_capacities() {
    capacity_.assign(vertices().size(), 0.0);
    std::ranges::copy(system_.held, capacity_.begin() + pattern_->rows.first_row);
    MPI_Allreduce(MPI_IN_PLACE, capacity_.data(), static_cast<int>(capacity_.size()), MPI_DOUBLE, MPI_SUM,
                  ranks_.communicator);
    for (const FixedValue& fixed : conditions_.fixed)
        capacity_[static_cast<std::size_t>(pattern_->numbering.row[fixed.vertex])] = 0;
}

/// What comes from outside may raise a value beyond those around it: by all of it in the vertex's own share, as that holds it
/// at the guess.
void HeatSolution::allow(std::size_t row, double load, double held) {
    const double rise = held > 0 ? load / held : load == 0 ? 0 : std::copysign(INFINITY, load);
    (rise > 0 ? allowance_.above : allowance_.below)[row] += std::abs(rise);
}

void HeatSolution::allow_loads() {
    for (std::size_t r = 0; r < pattern_->rows.count(); ++r) {
        double load = 0;
        for (const auto& at : pattern_->tets.of(r)) load += systems_.tets[at.cell].load[at.corner];
        for (const auto& at : pattern_->prisms.of(r)) load += systems_.prisms[at.cell].load[at.corner];
        allow(r, load, system_.row_sum[r]);
    }
}

void HeatSolution::add_shares() {
    for (const BoundaryShare& share : conditions_.shares) {
        const int row = pattern_->numbering.row[share.vertex];
        if (!system_.owns(row)) continue;
        const std::size_t r = system_.local(row);
        allow(r, step_.dt * share.flux, system_.row_sum[r]);
        if (share.exchanges()) {
            allowance_.least[r] = std::min(allowance_.least[r], share.ambient);
            allowance_.most[r] = std::max(allowance_.most[r], share.ambient);
        }
        const double guess = after_[share.vertex], rise = step_.dt * share.slope(guess);
        system_.row_sum[r] += rise;
        system_.held[r] += rise;
        system_.right[r] += step_.dt * (share.flux - share.given(guess)) + rise * guess;
    }
}

void HeatSolution::fix_values() {
    for (const FixedValue& fixed : conditions_.fixed) {
        const int row = pattern_->numbering.row[fixed.vertex];
        if (system_.owns(row)) allowance_.fixed[system_.local(row)] = 1;
        fix_unknown(system_, row, fixed.value);
    }
}

}  // namespace kropla
