// One time step: the list of the paper's section 1, in its order.

#include <kropla/step/advance.h>

#include <kropla/base/error.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <stdexcept>
#include <utility>

namespace kropla {
namespace {

constexpr double least_cut = 0.125, most_cut = 0.5;  // [-] of dt, when it is cut
constexpr double least_share = 1e-3;                 // [-] of dt

/// Adds the time from its construction to its end to a sum: of the wall's clock and, if asked for, of the processor.
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

/// Fields and contents, carried from `before` to `after`.
void carry(Fields& fields, const Mesh& before, const Mesh& after, const Changes& changes,
           const AdvanceOptions& options, Advanced& done) {
    for (std::size_t i = 0; i < options.contents.size(); ++i)
        done.contents[i].before_transfer = options.contents[i](before);
    if (!fields.empty()) {
        const Stopwatch watch(done.transfer_seconds);
        const TransferPlan plan = plan_transfer(before, after, changes.cells, changes.vertices, options.watch);
        const std::vector<TransferReport> reports = fields.carry(plan, options.watch);
        done.transfer.resize(reports.size());
        for (std::size_t i = 0; i < reports.size(); ++i) done.transfer[i] += reports[i];
        done.transferred_fraction =
            std::max(done.transferred_fraction, static_cast<double>(plan.cells) / count_tets(after));
    }
    for (std::size_t i = 0; i < options.contents.size(); ++i) {
        ContentReport& content = done.contents[i];
        content.after = options.contents[i](after);
        content.by_transfer += content.after - content.before_transfer;
    }
}

bool has_changed(const Attempt& attempt) {
    return !attempt.refined().cells.empty() || !attempt.refined().vertices.empty();
}

/// Stages 2.1 and 2.2.
Attempt begin(MovingMesh& moving, Fields& fields, const AdvanceOptions& options, Advanced& done) {
    Attempt attempt = [&] {
        const Stopwatch watch(done.mesh_seconds, &done.mesh_cpu_seconds);
        return Attempt(moving);
    }();
    if (has_changed(attempt))
        carry(fields, attempt.reference(), attempt.before(), attempt.refined(), options, done);
    return attempt;
}

/// Stage 2.5, with 2.3 and 2.4 again as often as the solver says that bodies went elsewhere; `begin` is what the fields
/// are at the beginning of the step.
std::optional<Refusal> solve_step(MovedAttempt& moved, const Fields::Copy& begin, const Solve& solve,
                                  const AdvanceOptions& options, Advanced& done) {
    heed(options.watch);
    if (!solve) return std::nullopt;
    for (int round = 1; round <= options.rounds; ++round) {
        heed(options.watch);
        const Answer answer = [&] {
            const Stopwatch watch(done.solve_seconds);
            return solve({moved.before(), moved.current(), moved.start(), moved.end() - moved.start(), round});
        }();
        if (std::holds_alternative<Solved>(answer)) return std::nullopt;
        if (const auto* refused = std::get_if<NotSolved>(&answer))
            return Refusal{.why = refused->why, .limiting = {}, .advised_dt = refused->advised_dt};
        begin.put_back();
        const Stopwatch watch(done.mesh_seconds, &done.mesh_cpu_seconds);
        const auto& [places, courses] = std::get<BodiesMoved>(answer);
        moved.move_again(places, courses);
        if (auto refusal = moved.refusal()) return refusal;
    }
    return Refusal{.why = "after " + std::to_string(options.rounds) + " rounds the solver still says that bodies go elsewhere",
                   .limiting = {}};
}

/// One attempt, as far as it can be taken back, fields and all: `start` is what they were.
std::variant<RemeshedAttempt, Refusal> attempt_step(MovingMesh& moving, Fields& fields, const Fields::Copy& start,
                                                    double dt, const Solve& solve, const AdvanceOptions& options,
                                                    Advanced& done) {
    done.transfer.clear();
    done.transferred_fraction = 0;
    done.contents.assign(options.contents.size(), {});
    const double end = moving.time() + dt;
    try {
        Attempt attempt = begin(moving, fields, options, done);  // 2.1, 2.2
        const bool refined = has_changed(attempt);
        const Fields::Copy on_refined = refined ? fields.copy() : Fields::Copy{};
        MovedAttempt moved = [&] {
            const Stopwatch watch(done.mesh_seconds, &done.mesh_cpu_seconds);
            const BodiesMoved expected = options.expected ? options.expected(attempt.before(), end) : BodiesMoved{};
            return move_bodies(std::move(attempt), end, expected.places, expected.courses);  // 2.3, 2.4
        }();
        auto refusal = moved.refusal();
        if (!refusal) refusal = solve_step(moved, refined ? on_refined : start, solve, options, done);  // 2.5
        if (refusal) {
            refuse(std::move(moved));
            return std::move(*refusal);
        }
        RemeshedAttempt remeshed = [&] {
            const Stopwatch watch(done.mesh_seconds, &done.mesh_cpu_seconds);
            return remesh(std::move(moved));  // 2.6
        }();
        carry(fields, remeshed.before(), remeshed.current(), remeshed.remeshed(), options, done);
        if (options.last_look) options.last_look(remeshed.current());
        return remeshed;
    } catch (const TransferError& error) {
        return Refusal{.why = error.what(), .limiting = {}};
    }
}

int count_new_cells(const Mesh& mesh, std::vector<Tet> cells) {
    std::ranges::sort(cells);
    const auto repeated = std::unique(cells.begin(), cells.end());
    const auto is_there = [&](Tet t) { return alive(mesh, t); };
    return static_cast<int>(std::count_if(cells.begin(), repeated, is_there));
}

void report_changes(const StepStatistics& mesh, int tets_before, const Mesh& reference, Advanced& done) {
    for (const Changes* changes : {&mesh.refined, &mesh.optimised, &mesh.remeshed}) done.changes += *changes;
    const double tets = count_tets(reference), vertices = count_vertices(reference);
    done.cells_touched = mesh.cells_touched;
    done.touched_fraction = mesh.cells_touched / static_cast<double>(tets_before);
    done.kept_tets = 1 - count_new_cells(reference, done.changes.cells) / tets;
    done.kept_vertices = 1 - done.changes.vertices_inserted / vertices;
}

/// Of an attempt that was refused.
double shorter(double dt, double advised) {
    return advised > 0 ? std::clamp(advised, least_cut * dt, most_cut * dt) : most_cut * dt;
}

Advanced try_to_advance(MovingMesh& moving, Fields& fields, const Fields::Copy& start, double dt, const Solve& solve,
                        const AdvanceOptions& options) {
    const double least_dt = options.least_dt > 0 ? options.least_dt : least_share * dt;
    bool remeshed = false;  // where an attempt got stuck, for the sake of the next
    Advanced done;
    for (done.attempts = 1;; ++done.attempts) {
        auto tried = attempt_step(moving, fields, start, dt, solve, options, done);
        if (auto* attempt = std::get_if<RemeshedAttempt>(&tried)) {
            const Stopwatch watch(done.mesh_seconds, &done.mesh_cpu_seconds);
            const int tets_before = count_tets(attempt->before());
            report_changes(accept(std::move(*attempt)), tets_before, moving.reference(), done);
            break;
        }
        start.put_back();
        const Refusal& refusal = std::get<Refusal>(tried);
        done.refused = refusal.why;
        if (refusal.limiting.exists() && !std::exchange(remeshed, true)) continue;
        const double next = shorter(dt, refusal.advised_dt);
        if (next < least_dt) {
            StuckError stuck("the mesh cannot go on from t = " + time_words(moving.time()) + ", even by " + time_words(dt) +
                                 ": " + refusal.why,
                             refusal.place);
            stuck.in_gap = refusal.in_gap;
            throw stuck;
        }
        dt = next;
    }
    done.time = moving.time();
    done.dt = dt;
    return done;
}

}  // namespace

Advanced advance(MovingMesh& moving, Fields& fields, double dt, const Solve& solve, const AdvanceOptions& options) {
    if (!(dt > 0)) throw std::logic_error("a step goes on by a positive dt");
    heed(options.watch);
    fields.check_sizes(moving.reference());
    const Fields::Copy start = fields.copy();
    try {
        return try_to_advance(moving, fields, start, dt, solve, options);
    } catch (...) {
        start.put_back();
        throw;
    }
}

double next_dt(const Advanced& done, double tried) { return done.attempts > 1 ? done.dt : 2 * tried; }

}  // namespace kropla
