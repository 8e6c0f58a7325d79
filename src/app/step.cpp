// One time step: the list of the paper's section 1, in its order.

#include "app/step.h"

#include "app/ending.h"
#include "mesh/quality.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>

namespace kropla {
namespace {

/// Adds the time from its construction to its end to a sum: of the wall's clock and, if asked for, of the
/// processor.
class Stopwatch {
public:
    explicit Stopwatch(double& seconds, double* cpu_seconds = nullptr)
        : seconds_(seconds), cpu_seconds_(cpu_seconds) {}
    ~Stopwatch() {
        seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
        if (cpu_seconds_ != nullptr)
            *cpu_seconds_ += static_cast<double>(std::clock() - cpu_start_) / CLOCKS_PER_SEC;
    }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;

private:
    double& seconds_;
    double* cpu_seconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::clock_t cpu_start_ = std::clock();
};

double energy_in(const Case& it, const Mesh& mesh, const std::vector<NodalField>& fields) {
    return it.heat ? energy(mesh, *it.heat, fields.front().values) : 0;
}

/// The heat capacity of each region per volume [J/(m^3 K)]: its integral with the temperature is what is
/// kept.
std::vector<double> capacities(const Case& it) {
    std::vector<double> capacity;
    if (it.heat)
        for (const HeatRegion& region : it.heat->regions)
            capacity.push_back(region.material.density * region.material.specific_heat);
    return capacity;
}

void carry_fields(std::vector<NodalField>& fields, const Mesh& before, const Mesh& after,
                  const Changes& changes, const Case& it, const Ranks& ranks, StepReport& report) {
    if (fields.empty()) return;
    report.energy_before_transfer = energy_in(it, before, fields);
    {
        const Stopwatch watch(report.transfer_seconds);
        const TransferPlan plan = plan_transfer(before, after, changes.cells, changes.vertices, ranks.watch);
        const std::vector<double> weight = capacities(it);
        for (NodalField& field : fields)
            report.transfer += project(plan, field.values, {.weight = weight, .watch = ranks.watch});
        report.transferred_fraction =
            std::max(report.transferred_fraction, static_cast<double>(plan.cells) / count_tets(after));
    }
    report.energy = energy_in(it, after, fields);
    report.energy_by_transfer += report.energy - report.energy_before_transfer;
}

/// Stages 2.1 to 2.4: the current mesh and the fields on its beginning; the reference is not touched.
void prepare(MovingMesh& moving, std::vector<NodalField>& fields, double t, const Case& it, const Ranks& ranks,
             StepReport& report) {
    const Changes* refined = nullptr;
    {
        const Stopwatch watch(report.mesh_seconds, &report.mesh_cpu_seconds);
        moving.begin_step();           // 2.1
        refined = &moving.refine();    // 2.2
    }
    if (!refined->cells.empty() || !refined->vertices.empty())
        carry_fields(fields, moving.reference(), moving.before(), *refined, it, ranks, report);
    const Stopwatch watch(report.mesh_seconds, &report.mesh_cpu_seconds);
    moving.move_boundary(t);                   // 2.3
    moving.optimise();                         // 2.4
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

/// Stage 2.5.
void simulate(const MovingMesh& moving, std::vector<NodalField>& fields, const Case& it, const Ranks& ranks,
              double dt, StepReport& report) {
    const Stopwatch watch(report.simulate_seconds);
    if (!it.heat) return;
    const HeatReport heat =
        step_heat(ranks, moving.before(), moving.current(), *it.heat, fields.front(), moving.time(), dt);
    report.beyond_bounds = beyond_bounds(heat.extremes, moving.time() + dt);
    report.heat_from_bodies.clear();
    for (const SurfaceFlux& flux : heat.surfaces) report.heat_from_bodies.push_back(flux.total);
}

/// Stage 2.6, up to what cannot be taken back.
void remesh(MovingMesh& moving, std::vector<NodalField>& fields, const Case& it, const Ranks& ranks,
            StepReport& report) {
    const Changes* remeshed = nullptr;
    {
        const Stopwatch watch(report.mesh_seconds, &report.mesh_cpu_seconds);
        remeshed = &moving.remesh();
    }
    carry_fields(fields, moving.before(), moving.current(), *remeshed, it, ranks, report);
}

void accept(State& state, std::vector<NodalField> fields, StepReport& report) {
    const Stopwatch watch(report.mesh_seconds, &report.mesh_cpu_seconds);
    state.moving.accept();
    state.fields = std::move(fields);
}

Changes all_changes(const StepStatistics& s) {
    Changes all = s.refined;
    all += s.optimised;
    all += s.remeshed;
    return all;
}

int count_new_cells(const Mesh& mesh, std::vector<Tet> cells) {
    std::ranges::sort(cells);
    const auto repeated = std::ranges::unique(cells);
    const auto is_there = [&](Tet t) { return alive(mesh, t); };
    return static_cast<int>(std::count_if(cells.begin(), repeated.begin(), is_there));
}

void report_changes(const MovingMesh& moving, StepReport& report) {
    const Mesh& mesh = moving.reference();
    const StepStatistics& done = moving.statistics();
    report.changes = all_changes(done);
    const double tets = count_tets(mesh), vertices = count_vertices(mesh);
    report.touched_fraction = done.cells_touched / static_cast<double>(count_tets(moving.before()));
    report.kept_tets = 1 - count_new_cells(mesh, report.changes.cells) / tets;
    report.kept_vertices = 1 - report.changes.vertices_inserted / vertices;
}

/// The step as far as it can be taken back, fields and all. Returns why it is refused, if it is.
std::optional<Refusal> attempt(MovingMesh& moving, std::vector<NodalField>& fields, const Case& it,
                                   const Ranks& ranks, double dt, StepReport& report) {
    report.energy_by_transfer = report.transferred_fraction = 0;
    report.transfer = {};
    try {
        prepare(moving, fields, moving.time() + dt, it, ranks, report);
        heed(ranks.watch);
        if (const auto refusal = moving.refusal()) return refusal;
        simulate(moving, fields, it, ranks, dt, report);
        remesh(moving, fields, it, ranks, report);
    } catch (const TransferError& error) {
        return Refusal{.why = error.what(), .limiting = {}};
    }
    return std::nullopt;
}

StepReport try_step(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    MovingMesh& moving = state.moving;
    double dt = options.dt;
    bool to_roll_back = options.test_rollback;
    const double start = moving.time();
    StepReport report;
    for (report.attempts = 1;; ++report.attempts) {
        std::vector<NodalField> fields = state.fields;
        if (const auto why = attempt(moving, fields, it, ranks, dt, report)) {
            moving.refuse();
            report.refused = why->why;
            if (report.attempts > 1) dt /= 2;
            if (dt >= options.least_dt) continue;
            throw StuckError(fmt::format("the mesh cannot go on from t = {}, even by {}: {}", time_words(start),
                                         time_words(2 * dt), why->why),
                             why->place);
        }
        if (to_roll_back) {
            moving.refuse();
            to_roll_back = false;
            --report.attempts;
            continue;
        }
        accept(state, std::move(fields), report);
        break;
    }
    report.time = moving.time();
    report.dt = dt;
    report_changes(moving, report);
    return report;
}

}  // namespace

StepReport time_step(State& state, const Case& it, const Ranks& ranks, const StepOptions& options) {
    try {
        return try_step(state, it, ranks, options);
    } catch (...) {
        state.moving.drop();
        throw;
    }
}

}  // namespace kropla
