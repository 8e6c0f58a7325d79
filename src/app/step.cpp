#include "app/step.h"

#include "case/heat.h"
#include "app/flow_fields.h"
#include "app/liquid_bodies.h"
#include "app/span.h"
#include "app/species_fields.h"
#include "app/told_flows.h"
#include "simulate/cells.h"
#include "simulate/elements.h"
#include <kropla/simulate/heat.h>

#include <kropla/base/error.h>
#include <kropla/domain/words.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

namespace kropla {
namespace {

constexpr double agreed_density = 0.005;  // [-] of it, in the mean: how far it may be behind the temperature, and
constexpr int most_rounds = 5;           // of flow and heat in turns

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
            constexpr double rounding = 1e-12;  // [-]
            if (temperature[extremes.hottest] > property->temperatures().back() * (1 + rounding))
                say(extremes.hottest, property->temperatures().back(), "ends");
            else if (temperature[extremes.coldest] < property->temperatures().front() * (1 - rounding))
                say(extremes.coldest, property->temperatures().front(), "begins");
        }
    }
    return warnings;
}

/// Which pairs touched.
std::vector<StepWarning> touch_warnings(const Domain& domain, const ContactReport& report, double t) {
    std::vector<StepWarning> warnings;
    for (const ContactForce& contact : report.contacts) {
        if (!contact.touches) continue;
        const auto& [body, wall, other] = contact.who;
        const std::string pair = fmt::format("{} touches {}", named(domain.bodies[body]),
                                             wall >= 0 ? wall_name(wall) : named(domain.bodies[other]));
        warnings.push_back({pair, fmt::format("{} at {}, t = {}, for the first time", pair, place_words(contact.place),
                                              time_words(t))});
    }
    return warnings;
}

/// What is carried, solved for and looked at in a step of the case.
class Simulation {
public:
    Simulation(State& state, const Case& given, const Ranks& ranks) : state_(state), given_(given), ranks_(ranks) {
        if (given.heat) carry_heat();
        for (const SpeciesField& field : species_fields(given))
            fields_.per_vertex(state.fields[field.place].values, {.only = Region(field.region)});
        if (!given.flow) return;
        const std::vector<Carrying> how = carrying_of_flow(given);
        for (std::size_t k = 0; k < how.size(); ++k) fields_.per_vertex(state.fields[place_of_flow(given) + k].values, how[k]);
    }

    Advanced advance(const StepOptions& options, std::function<void(const Mesh&)> last_look = {}) {
        if (given_.heat) at_begin_ = span_of(state_.moving.reference(), temperature());
        species_at_begin_ = spans_of_species(state_.moving.reference());
        AdvanceOptions how{.least_dt = options.least_dt, .last_look = std::move(last_look), .watch = ranks_.watch};
        if (given_.heat) how.contents = {[&](const Mesh& mesh) { return energy_on(mesh); }};
        for (std::size_t s = 0; s < given_.species.size(); ++s)
            how.contents.push_back([&, s](const Mesh& mesh) { return energy_of(mesh, concentrations(given_, s, state_.fields)); });
        how.expected = [&](const Mesh& before, double end) {
            expect_liquids(before, end);
            return BodiesMoved{free_places(end), courses()};
        };
        Advanced done = [&] {
            try {
                return kropla::advance(state_.moving, fields_, options.dt,
                                       [&](const StepToSolve& step) { return solve(step); }, how);
            } catch (const StuckError& stuck) {
                if (!unsolved_.empty()) throw SolverError(unsolved_);
                if (!stuck.in_gap || free_.empty() || given_.contact) throw;
                throw StuckError(std::string(stuck.what()) + "; with a table [contact] bodies may touch", stuck.place);
            }
        }();
        if (given_.heat)
            take_transferred(state_.moving.reference(), {report.heat.extremes.least.value, report.heat.extremes.most.value});
        take_transferred_species(state_.moving.reference(), species_solved_);
        for (const auto& [body, step] : free_) state_.free[body] = step.end();
        if (contacts_) report.contact = contacts_->report();
        return done;
    }

    StepReport report;

private:
    [[nodiscard]] Array<Vertex, double>& temperature() { return state_.fields.front().values; }
    /// After a transfer, which may leave temperatures beyond all that there were.
    void take_transferred(const Mesh& mesh, const Span& bounds) {
        const auto take_temperatures = [&] {
            if (!enthalpy_.empty()) temperature_of(mesh, *given_.heat, enthalpy_, temperature(), known_density());
        };
        take_temperatures();
        if (bounds.holds(span_of(mesh, temperature()))) return;
        if (enthalpy_.empty()) keep_within(ranks_, mesh, *given_.heat, bounds.least, bounds.most, temperature());
        else keep_within(ranks_, mesh, *given_.heat, bounds.least, bounds.most, enthalpy_, known_density());
        take_temperatures();
    }

    /// The spans of all species in their regions.
    [[nodiscard]] std::vector<Span> spans_of_species(const Mesh& mesh) const {
        std::vector<Span> spans;
        for (const SpeciesField& field : species_fields(given_))
            spans.push_back(span_of(mesh, state_.fields[field.place].values, Region(field.region)));
        return spans;
    }
    void take_transferred_species(const Mesh& mesh, const std::vector<Span>& bounds) {
        const std::vector<Span> there = spans_of_species(mesh);
        const std::vector<SpeciesField> fields = species_fields(given_);
        for (std::size_t k = 0; k < fields.size(); ++k)
            if (!bounds[k].holds(there[k]))
                keep_within(ranks_, mesh, Region(fields[k].region), bounds[k].least, bounds[k].most,
                            state_.fields[fields[k].place].values);
    }

    /// Into the arrays that `fields_` knows.
    void take_enthalpies(const Mesh& mesh) {
        std::ranges::move(enthalpies(mesh, *given_.heat, temperature(), known_density()), enthalpy_.begin());
    }
    [[nodiscard]] KnownDensity known_density() const {
        if (!expands(given_)) return {};
        return {Region(0), flow_state(given_, state_.fields).density};
    }
    [[nodiscard]] double energy_on(const Mesh& mesh) {
        return enthalpy_.empty() ? energy(mesh, *given_.heat, temperature()) : energy_of(mesh, enthalpy_);
    }

    /// What is carried of the heat: the temperature, or where it does not tell the energy by a factor, enthalpies.
    void carry_heat() {
        if (proportional(*given_.heat)) {
            fields_.per_vertex(temperature(), {.weight = capacities(*given_.heat)});
            return;
        }
        enthalpy_ = enthalpies(state_.moving.reference(), *given_.heat, temperature(), known_density());
        for (std::size_t r = 0; r < enthalpy_.size(); ++r) fields_.per_vertex(enthalpy_[r], {.only = Region(r)});
        fields_.per_vertex(temperature());
    }

    Answer solve(const StepToSolve& step) {
        unsolved_.clear();
        if (given_.heat) take_transferred(step.before, at_begin_);
        const Array<Vertex, double> begin = given_.heat ? temperature() : Array<Vertex, double>{};
        FlowState flow;
        expect(step, begin);
        const bool carries = given_.heat || !given_.species.empty();
        const std::vector<ToldFlow> told =
            carries ? told_flows(given_, step.current, step.time, step.time + step.dt) : std::vector<ToldFlow>{};
        const bool in_turns = expands(given_) && step.round == 1;  // first what the gas does, then where bodies go in it
        for (int round = 1;; ++round) {
            SolvedFlow solved;
            if (given_.flow) {
                if (const Answer answer = solve_flow(step, flow, solved); !std::holds_alternative<Solved>(answer)) return answer;
                if (!in_turns) {
                    const bool rigid = bodies_agree();
                    if (!liquids_agree(step, flow, rigid) || !rigid) return BodiesMoved{places(), courses()};
                }
            }
            if (!carries) break;
            flow_ = material_flow(ranks_, step.before, step.current, regions_that(Carried::with_flow, materials()), step.dt,
                                  solved, told);
            if (!given_.heat) break;
            temperature() = begin;
            solve_heat(step);
            if (!in_turns || density_agrees(step, solved.density, round == most_rounds) || round == most_rounds) break;
            expected_ = temperature();
        }
        if (in_turns && !bodies_agree()) return BodiesMoved{places()};
        if (liquids_) keep_flow_rate(given_, rate_over(step, flow), state_.fields);
        if (given_.flow) keep_flow(given_, flow, state_.fields);
        if (!enthalpy_.empty()) take_enthalpies(step.current);
        take_transferred_species(step.before, species_at_begin_);
        for (std::size_t s = 0; s < given_.species.size(); ++s) solve_species(step, s);
        species_solved_ = spans_of_species(step.current);
        return Solved{};
    }

    /// Of the temperature at the step's end, for what flows: that at its begin. As bodies are moved once more, what was found
    /// before serves again, at vertices that are the same.
    void expect(const StepToSolve& step, const Array<Vertex, double>& begin) {
        const Array<Vertex, double> last = std::exchange(expected_, begin);
        const Array<Vertex, Vec3> place = std::exchange(expected_at_, step.before.position);
        if (step.round == 1 || !expands(given_)) return;
        for (Vertex v : begin.indices())
            if (as_size(v.value) < last.size() && place[v] == expected_at_[v]) expected_[v] = last[v];
    }

    /// Is a density that of the temperature, in the mean over the gas? If not, the last time it is said.
    bool density_agrees(const StepToSolve& step, const Array<Vertex, double>& density, bool last) {
        const Property& wanted = given_.flow->options.regions[0]->density;
        Vertex behind;
        double most = 0, sum = 0, volume = 0;
        for_each_share(step.current, living_cells(step.current, Region(0)), [&](const auto&, Vertex v, double share) {
            const double missed = std::abs(wanted(temperature()[v]) / density[v] - 1);
            if (missed > most) behind = v;
            most = std::max(most, missed);
            sum += share * missed;
            volume += share;
        });
        if (sum <= agreed_density * volume) return true;
        const Vec3& x = step.current.position[behind];
        if (last)
            report.warnings.push_back({"flow.region.surroundings.density",
                                       fmt::format("the density of the gas is behind its temperature, by {:.2g} of it in the mean and "
                                                   "{:.2g} at ({:.4g}, {:.4g}, {:.4g}) m, t = {:.4g} s: shorter steps would keep it nearer",
                                                   sum / volume, most, x.x, x.y, x.z, step.time + step.dt)});
        return false;
    }

    /// What the surroundings are like where bodies are, as cells are small there: the mean of all corners of their cells [K].
    [[nodiscard]] double temperature_around() {
        if (!given_.heat) return 0;  // nothing depends on it then
        const Mesh& mesh = state_.moving.reference();
        double sum = 0, count = 0;
        for (const Tet t : all_tets(mesh, surroundings))
            for (const Vertex v : mesh.tets[t]) {
                sum += temperature()[v];
                ++count;
            }
        return sum / count;
    }

    /// Where free bodies are expected, if they go on as in the step before.
    std::vector<BodyPlace> free_places(double end) {
        free_.clear();
        const MovingMesh& moving = state_.moving;
        const double dt = end - moving.time();
        if (std::ranges::none_of(given_.free, [](const auto& motion) { return motion.has_value(); })) return {};
        const FlowRegion& around = *given_.flow->options.regions[0];
        const double warm = temperature_around(), viscosity = around.viscosity(warm);
        for (std::size_t body = 0; body < given_.free.size(); ++body) {
            if (!given_.free[body]) continue;
            const FreeMotion& motion = *given_.free[body];
            RigidStep& step = free_.emplace_back(body, RigidStep(motion, state_.free[body],
                                                                 weighed(moving.reference(), region_of_body(body), motion.density),
                                                                 given_.domain.bodies[body].shape.centre + state_.free[body].pose.displacement,
                                                                 given_.flow->options.gravity, moving.time(), dt)).second;
            step.guess_response(around.density(warm), viscosity);
        }
        if (given_.contact) {
            contacts_.emplace(given_.domain, *given_.contact, viscosity, free_, moving.time(), dt);
            contacts_->guess();
        }
        return places();
    }
    [[nodiscard]] std::vector<BodyPlace> places() const {
        std::vector<BodyPlace> places;
        for (const auto& [body, step] : free_) places.push_back({body, step.pose()});
        return places;
    }

    /// Where liquid bodies are expected, if the flow goes on as in the step before.
    void expect_liquids(const Mesh& before, double end) {
        const std::vector<Region> liquids = liquids_of(given_);
        if (liquids.empty()) return;
        const double t = state_.moving.time();
        const FlowState flow = flow_state(given_, state_.fields);
        liquids_.emplace(liquids, before, flow.velocity, flow_rate(given_, state_.fields), t, end - t);
        settled_.reset();
    }
    [[nodiscard]] std::vector<BodyCourse> courses() const { return liquids_ ? liquids_->courses() : std::vector<BodyCourse>{}; }
    /// Is the mesh where the flow takes liquid bodies? If it is near, and the others agree, the flow is settled, and only the
    /// mesh has to go there.
    bool liquids_agree(const StepToSolve& step, const FlowState& flow, bool others) {
        if (!liquids_ || settled_) return true;
        const LiquidStep::Verdict verdict = liquids_->take(step.before, step.current, report.flow.surfaces);
        if (verdict == LiquidStep::Verdict::near && others) settled_ = flow;
        return verdict == LiquidStep::Verdict::arrived;
    }
    [[nodiscard]] Array<Vertex, Vec3> rate_over(const StepToSolve& step, const FlowState& flow) const {
        const FlowState begin = flow_state(given_, state_.fields);
        Array<Vertex, Vec3> rate(flow.velocity.size());
        for (Vertex v : rate.indices())
            if (alive(step.current, v)) rate[v] = (flow.velocity[v] - begin.velocity[v]) / step.dt;
        return rate;
    }

    /// The velocities of the surfaces of bodies.
    [[nodiscard]] std::vector<std::function<RigidVelocity(double)>> surface_velocities(double dt) const {
        std::vector<std::function<RigidVelocity(double)>> velocities;
        for (std::size_t body = 0; body < given_.domain.bodies.size(); ++body) {
            velocities.emplace_back();
            if (is_told(given_, body)) continue;  // no rigid body's: told_surfaces has them
            velocities.back() = [&of = given_.domain.bodies[body], dt](double t) { return velocity_of(of, t, dt); };
        }
        for (const auto& [body, step] : free_) velocities[body] = [&step = step](double t) { return step.velocity(t); };
        return velocities;
    }

    /// Do forces take bodies where they are? If not, they are told where to go instead.
    bool bodies_agree() {
        constexpr double agreed = 3e-4;  // [-] of what acts on a body
        double missed = 0;
        for (auto& [body, rigid] : free_) {
            const auto force = std::ranges::find(report.flow.bodies, region_of_body(body), &BodyForce::body);
            missed = std::max(missed, rigid.take(force->force, force->torque));
        }
        if (contacts_) missed = contacts_->settle();
        if (missed <= agreed) return true;
        if (contacts_) contacts_->improve();
        else for (auto& [body, rigid] : free_) rigid.improve();
        return false;
    }

    Answer solve_flow(const StepToSolve& step, FlowState& flow, SolvedFlow& solved) {
        constexpr double of_forces = 1e-4;  // [-] of what changes in a step, and
        constexpr double of_motion = 1e-6;  // [-] of it where they move bodies: speeds add up what they miss
        constexpr double let_pass = 1.1;  // [-] of the Courant number: no step is taken back for a little
        report.rounds = step.round;
        if (settled_) {
            flow = *settled_;
            return Solved{};
        }
        FlowOptions options = given_.flow->options;
        options.bodies = surface_velocities(step.dt);
        options.surfaces = told_surfaces(given_, step.time, step.time + step.dt);
        options.tolerance = free_.empty() ? of_forces : of_motion;
        flow = flow_state(given_, state_.fields);
        solved.density_before = flow.density;
        try {
            report.flow = step_flow(ranks_, step.before, step.current, options, flow, step.time, step.dt, expected_);
        } catch (const SolverError& error) {
            unsolved_ = error.what();
            return NotSolved{unsolved_};
        }
        if (const double most = given_.time.courant.value_or(INFINITY); report.flow.largest_courant > let_pass * most)
            return NotSolved{fmt::format("the flow crosses {:.3g} heights of a cell, more than time.courant = {}",
                                         report.flow.largest_courant, most),
                             step.dt * most / report.flow.largest_courant};
        solved.velocity = flow.velocity;
        solved.density = flow.density;
        solved.through = report.flow.through;
        for (std::size_t face = 0; face < solved.open.size(); ++face)
            solved.open[face] = options.faces[face].kind == FlowFace::Kind::open;
        return Solved{};
    }

    void solve_heat(const StepToSolve& step) {
        HeatReport heat =
            step_heat(ranks_, step.before, step.current, *given_.heat, flow_, state_.fields.front(), step.time, step.dt, expected_);
        report.warnings = beyond_tables(*given_.heat, step.current, temperature(), step.time + step.dt);
        report.heat = std::move(heat);
    }

    void solve_species(const StepToSolve& step, std::size_t s) {
        Concentrations values = concentrations(given_, s, state_.fields);
        report.species.resize(given_.species.size());
        report.species[s] = step_species(ranks_, step.before, step.current, given_.species[s], materials(), flow_,
                                         report.heat.surfaces, values, step.time, step.dt);
        for (const SpeciesField& field : species_fields(given_))
            if (field.species == s) state_.fields[field.place].values = std::move(values[field.region]);
    }

    /// How materials move.
    [[nodiscard]] HeatOptions materials() const {
        if (given_.heat) return *given_.heat;
        HeatOptions options{.regions = std::vector<HeatRegion>(given_.domain.bodies.size() + 1)};
        for (std::size_t r = 0; r < options.regions.size(); ++r) {
            options.regions[r].name = region_name(given_.domain, r);
            options.regions[r].carried = carried_in(given_.domain, r);
        }
        return options;
    }

    State& state_;
    const Case& given_;
    const Ranks& ranks_;
    Fields fields_;
    MaterialFlow flow_;
    Array<Vertex, double> expected_;   // temperature [K] at the end of the step, and
    Array<Vertex, Vec3> expected_at_;  // where the vertices were [m]
    FreeSteps free_;  // bodies that go where forces take them, in this attempt
    std::optional<LiquidStep> liquids_;  // bodies that go with the flow, likewise
    std::optional<FlowState> settled_;   // what the flow is, if only the mesh has to follow it still
    std::optional<Contacts> contacts_;  // likewise, what they do to each other
    Span at_begin_;         // of the temperature, and of species
    std::vector<Span> species_at_begin_, species_solved_;
    std::string unsolved_;  // why the flow could not be solved for, in the last round
    std::vector<Array<Vertex, double>> enthalpy_;  // of each region, where a temperature does not tell the energy by a factor
};

/// At the step's end [rad/s].
Vec3 spin_of(const State& state, const Case& given, std::size_t body, const StepReport& report) {
    const double end = report.mesh.time, dt = report.mesh.dt;
    if (given.free[body]) return state.free[body].spin;
    if (is_told(given, body)) return told_spin(given, body, report.bodies[body].place, end - dt, end);
    return velocity_of(given.domain.bodies[body], end, dt).spin;
}

/// Not an error: nobody but `take_step_back` hears of it.
struct TakenBack {};

}  // namespace

AdaptOptions adapt_options(const Case& given, const Watch* watch) {
    return {.floor = given.quality.max_aspect_ratio, .seed = given.random.seed, .paper = given.quality.paper, .watch = watch};
}

StepReport time_step(State& state, const Case& given, const Ranks& ranks, const StepOptions& options) {
    Simulation simulation(state, given, ranks);
    StepReport& report = simulation.report;
    const auto states = [&] {
        return body_states(given.domain, state.moving.reference(), given.heat ? &state.fields.front().values : nullptr);
    };
    const std::vector<BodyState> before = states();
    report.mesh = simulation.advance(options);
    report.bodies = states();
    if (given.contact) std::ranges::move(touch_warnings(given.domain, report.contact, report.mesh.time), std::back_inserter(report.warnings));
    for (std::size_t body = 0; body < before.size(); ++body) {
        report.gains.push_back(report.bodies[body].volume - before[body].volume);
        report.velocities.push_back((report.bodies[body].place - before[body].place) / report.mesh.dt);
    }
    for (std::size_t body = 0; given.flow && body < before.size(); ++body)
        report.spins.push_back(spin_of(state, given, body, report));
    return std::move(report);
}

void take_step_back(State& state, const Case& given, const Ranks& ranks, const StepOptions& options) {
    try {
        (void)Simulation(state, given, ranks).advance(options, [](const Mesh&) { throw TakenBack{}; });
    } catch (const TakenBack&) {
    }
}

}  // namespace kropla
