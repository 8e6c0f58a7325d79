#include "app/step.h"

#include "app/case_heat.h"
#include "app/species_fields.h"
#include "simulate/cells.h"
#include <kropla/simulate/heat.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr double rounding = 1e-13;  // [-] of the largest temperature: what a transfer may leave beyond bounds

/// The coldest and hottest vertex of a region.
struct Extremes {
    Vertex coldest, hottest;
};
Extremes extremes_of(const Mesh& mesh, Region region, const Array<Vertex, double>& temperature) {
    Extremes found;
    for_each_cell(living_cells(mesh, region), [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) {
            if (!found.coldest.exists() || temperature[v] < temperature[found.coldest]) found.coldest = v;
            if (!found.hottest.exists() || temperature[v] > temperature[found.hottest]) found.hottest = v;
        }
    });
    return found;
}

/// Where temperatures are beyond the tables of materials.
std::vector<StepWarning> beyond_tables(const HeatOptions& heat, const Mesh& mesh, const Array<Vertex, double>& temperature,
                                       double t) {
    std::vector<StepWarning> warnings;
    for (std::size_t r = 0; r < heat.regions.size(); ++r) {
        const HeatMaterial& m = heat.regions[r].material;
        if (m.conductivity.constant() && m.density.constant() && m.specific_heat.constant()) continue;
        const Extremes extremes = extremes_of(mesh, Region(r), temperature);
        if (!extremes.coldest.exists()) continue;
        for (const auto& [name, property] : {std::pair{"conductivity", &m.conductivity}, std::pair{"density", &m.density},
                                             std::pair{"specific_heat", &m.specific_heat}}) {
            if (property->constant()) continue;
            const std::string key = fmt::format("{}.{}", region_key(heat, r), name);
            const auto say = [&](Vertex v, double end, const char* word) {
                const Vec3& x = mesh.position[v];
                warnings.push_back({key, fmt::format("{} {} at {:.6g} K; at ({:.4g}, {:.4g}, {:.4g}) m, t = {:.4g} s it is "
                                                     "{:.6g} K: the value at the end of the table holds there", key, word,
                                                     end, x.x, x.y, x.z, t, temperature[v])});
            };
            if (temperature[extremes.hottest] > property->temperatures().back())
                say(extremes.hottest, property->temperatures().back(), "ends");
            else if (temperature[extremes.coldest] < property->temperatures().front())
                say(extremes.coldest, property->temperatures().front(), "begins");
        }
    }
    return warnings;
}

/// What is carried, solved for and looked at in a step of the case.
class Simulation {
public:
    Simulation(State& state, const Case& it, const Ranks& ranks) : state_(state), it_(it), ranks_(ranks) {
        if (it.heat) carry_heat();
        for (const SpeciesField& field : species_fields(it))
            fields_.per_vertex(state.fields[field.place].values, {.only = Region(field.region)});
    }

    Advanced advance(const StepOptions& options, std::function<void(const Mesh&)> last_look = {}) {
        AdvanceOptions how{.least_dt = options.least_dt, .last_look = std::move(last_look), .watch = ranks_.watch};
        if (it_.heat) how.contents = {[&](const Mesh& mesh) { return energy_on(mesh); }};
        for (std::size_t s = 0; s < it_.species.size(); ++s)
            how.contents.push_back([&, s](const Mesh& mesh) { return energy_of(mesh, concentrations(it_, s, state_.fields)); });
        Advanced done = kropla::advance(state_.moving, fields_, options.dt,
                                        [&](const StepToSolve& step) { return solve(step); }, how);
        if (it_.heat) finish_heat(done);
        return done;
    }

    StepReport report;

private:
    [[nodiscard]] Array<Vertex, double>& temperature() { return state_.fields.front().values; }
    /// After the last transfer.
    void finish_heat(const Advanced& done) {
        const Mesh& mesh = state_.moving.reference();
        const HeatExtremes& solved = report.heat.extremes;
        if (!enthalpy_.empty()) temperature_of(mesh, *it_.heat, enthalpy_, temperature());
        else if (!done.transfer.empty() && done.transfer.front().beyond > rounding * std::abs(solved.most.value))
            keep_within(ranks_, mesh, *it_.heat, solved.least.value, solved.most.value, temperature());
    }

    /// Into the arrays that `fields_` knows.
    void take_enthalpies(const Mesh& mesh) {
        std::ranges::move(enthalpies(mesh, *it_.heat, temperature()), enthalpy_.begin());
    }
    [[nodiscard]] double energy_on(const Mesh& mesh) {
        return enthalpy_.empty() ? energy(mesh, *it_.heat, temperature()) : energy_of(mesh, enthalpy_);
    }

    /// What is carried of the heat: the temperature, or where it does not tell the energy by a factor, enthalpies.
    void carry_heat() {
        if (proportional(*it_.heat)) {
            fields_.per_vertex(temperature(), {.weight = capacities(*it_.heat)});
            return;
        }
        enthalpy_ = enthalpies(state_.moving.reference(), *it_.heat, temperature());
        for (std::size_t r = 0; r < enthalpy_.size(); ++r) fields_.per_vertex(enthalpy_[r], {.only = Region(r)});
        fields_.per_vertex(temperature());
    }

    Answer solve(const StepToSolve& step) {
        if (!it_.heat && it_.species.empty()) return Solved{};
        flow_ = material_flow(ranks_, step.before, step.current, regions_that(Carried::at_rest, materials()), step.dt);
        if (it_.heat) solve_heat(step);
        for (std::size_t s = 0; s < it_.species.size(); ++s) solve_species(step, s);
        return Solved{};
    }

    void solve_heat(const StepToSolve& step) {
        if (!enthalpy_.empty()) temperature_of(step.before, *it_.heat, enthalpy_, temperature());
        HeatReport heat =
            step_heat(ranks_, step.before, step.current, *it_.heat, flow_, state_.fields.front(), step.time, step.dt);
        if (!enthalpy_.empty()) take_enthalpies(step.current);
        report.warnings = beyond_tables(*it_.heat, step.current, temperature(), step.time + step.dt);
        report.heat = std::move(heat);
    }

    void solve_species(const StepToSolve& step, std::size_t s) {
        Concentrations values = concentrations(it_, s, state_.fields);
        report.species.resize(it_.species.size());
        report.species[s] = step_species(ranks_, step.before, step.current, it_.species[s], materials(), flow_,
                                         report.heat.surfaces, values, step.time, step.dt);
        for (const SpeciesField& field : species_fields(it_))
            if (field.species == s) state_.fields[field.place].values = std::move(values[field.region]);
    }

    /// How materials move.
    [[nodiscard]] HeatOptions materials() const {
        if (it_.heat) return *it_.heat;
        HeatOptions options{.regions = std::vector<HeatRegion>(it_.domain.bodies.size() + 1)};
        for (std::size_t r = 0; r < options.regions.size(); ++r) {
            options.regions[r].name = region_name(it_.domain, r);
            options.regions[r].carried = r == 0 ? Carried::at_rest : Carried::with_mesh;
        }
        return options;
    }

    State& state_;
    const Case& it_;
    const Ranks& ranks_;
    Fields fields_;
    MaterialFlow flow_;
    std::vector<Array<Vertex, double>> enthalpy_;  // of each region, where a temperature does not tell the energy by a factor
};

/// Not an error: nobody but `take_step_back` hears of it.
struct TakenBack {};

}  // namespace

AdaptOptions adapt_options(const Case& it, const Watch* watch) {
    return {.floor = it.quality.max_aspect_ratio, .seed = it.random.seed, .paper = it.quality.paper, .watch = watch};
}

StepReport time_step(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    Simulation simulation(state, it, ranks);
    StepReport& report = simulation.report;
    const auto states = [&] {
        return body_states(it.domain, state.moving.reference(), it.heat ? &state.fields.front().values : nullptr);
    };
    const std::vector<BodyState> before = states();
    report.mesh = simulation.advance(options);
    report.bodies = states();
    for (std::size_t body = 0; body < before.size(); ++body)
        report.velocities.push_back((report.bodies[body].place - before[body].place) / report.mesh.dt);
    return std::move(report);
}

void take_step_back(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    try {
        (void)Simulation(state, it, ranks).advance(options, [](const Mesh&) { throw TakenBack{}; });
    } catch (const TakenBack&) {
    }
}

}  // namespace kropla
