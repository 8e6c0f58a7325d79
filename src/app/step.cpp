#include "app/step.h"

#include <kropla/simulate/heat.h>

#include <fmt/format.h>

#include <algorithm>

namespace kropla {
namespace {

/// The heat capacity of each region per volume [J/(m^3 K)]: its integral with the temperature is what is kept.
std::vector<double> capacities(const HeatOptions& heat) {
    std::vector<double> capacity;
    for (const HeatRegion& region : heat.regions)
        capacity.push_back(region.material.density * region.material.specific_heat);
    return capacity;
}

/// A sentence if a temperature is noticeably beyond what conduction and convection can make; else empty.
std::string beyond_bounds(const HeatExtremes& e, double t) {
    constexpr double noticeable = 1e-3;  // [-] of what lies between the bounds; less is of no consequence
    const auto beyond = [&](const Extreme& extreme, double by, double bound, const char* side) {
        return fmt::format("the temperature is {:.3g} K {} {:.6g} K, which the equation allows, at ({:.4g}, {:.4g}, "
                           "{:.4g}) m, t = {:.4g} s: cells are too coarse for the step there",
                           by, side, bound, extreme.place.x, extreme.place.y, extreme.place.z, t);
    };
    const double lower = std::max(e.lower, std::min(e.least.value, e.upper)),
                 upper = std::min(e.upper, std::max(e.most.value, e.lower));
    const double most = noticeable * (upper - lower);
    const double below = e.lower - e.least.value, above = e.most.value - e.upper;
    if (below > most && below >= above) return beyond(e.least, below, e.lower, "below");
    if (above > most) return beyond(e.most, above, e.upper, "above");
    return "";
}

/// What is carried, solved for and looked at in a step of the case.
class Simulation {
public:
    Simulation(State& state, const Case& it, const Ranks& ranks) : state_(state), it_(it), ranks_(ranks) {
        if (!it.heat) return;
        fields_.per_vertex(state.fields.front().values, {.weight = capacities(*it.heat)});
    }

    Advanced advance(const StepOptions& options, std::function<void(const Mesh&)> last_look = {}) {
        AdvanceOptions how{.least_dt = options.least_dt, .last_look = std::move(last_look), .watch = ranks_.watch};
        if (it_.heat)
            how.contents = {[&](const Mesh& mesh) { return energy(mesh, *it_.heat, state_.fields.front().values); }};
        return kropla::advance(state_.moving, fields_, options.dt, [&](const StepToSolve& step) { return solve(step); },
                               how);
    }

    StepReport report;

private:
    Answer solve(const StepToSolve& step) {
        if (!it_.heat) return Solved{};
        const HeatReport heat = step_heat(ranks_, step.before, step.current, *it_.heat, state_.fields.front(), step.time,
                                          step.dt);
        report.beyond_bounds = beyond_bounds(heat.extremes, step.time + step.dt);
        report.heat_from_bodies.clear();
        for (const SurfaceFlux& flux : heat.surfaces) report.heat_from_bodies.push_back(flux.total);
        return Solved{};
    }

    State& state_;
    const Case& it_;
    const Ranks& ranks_;
    Fields fields_;
};

/// Not an error: nobody but `take_step_back` hears of it.
struct TakenBack {};

}  // namespace

AdaptOptions adapt_options(const Case& it, const Watch* watch) {
    return {.floor = it.quality.max_aspect_ratio, .seed = it.random.seed, .paper = it.quality.paper, .watch = watch};
}

StepReport time_step(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    Simulation simulation(state, it, ranks);
    simulation.report.mesh = simulation.advance(options);
    return std::move(simulation.report);
}

void take_step_back(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    try {
        (void)Simulation(state, it, ranks).advance(options, [](const Mesh&) { throw TakenBack{}; });
    } catch (const TakenBack&) {
    }
}

}  // namespace kropla
