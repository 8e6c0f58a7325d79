// A run: from the initial mesh or the checkpoint to the end, step by step, with what each step leaves behind.

#include "app/run.h"

#include "case/case.h"
#include "app/commands.h"
#include "app/ending.h"
#include "app/flow_fields.h"
#include "app/first_mesh.h"
#include "case/foresight.h"
#include "app/interrupt.h"
#include "app/run_folder.h"
#include "app/run_lines.h"
#include "app/run_lock.h"
#include "app/run_output.h"
#include "case/same_case.h"
#include "app/solver_options.h"
#include "app/species_fields.h"
#include "app/step.h"
#include <kropla/base/error.h>
#include "io/triangles.h"
#include "report/page.h"
#include "simulate/stop.h"
#include <kropla/step/initial_mesh.h>

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <set>
#include <memory>
#include <new>
#include <optional>
#include <utility>

namespace kropla {
namespace {

constexpr double least_dt_share = 1e-3;    // of the wanted dt: below, the floors count as unreachable
constexpr double same_time = 1e-9;         // of the wanted dt: what is left of a step is rounding

State start(const Case& given, const Ranks& ranks) {
    const Watch* watch = ranks.watch;
    Mesh mesh = first_mesh(given, watch);
    std::vector<NodalField> fields;
    if (given.heat) {
        check_heat(*given.heat, mesh);
        fields.push_back(initial_temperature(ranks, mesh, *given.heat));
    }
    std::ranges::move(initial_species(mesh, given), std::back_inserter(fields));
    if (given.flow) {
        check_flow(given.flow->options, mesh);
        std::ranges::move(initial_flow(mesh, given, given.heat ? fields.front().values : Array<Vertex, double>{}), std::back_inserter(fields));
    }
    State state{MovingMesh(given.domain, std::move(mesh), 0, adapt_options(given, watch)), std::move(fields), {}};
    for (const auto& motion : given.free) {
        state.free.emplace_back();
        if (motion) state.free.back() = {.pose = {}, .velocity = motion->velocity, .spin = motion->spin};
    }
    return state;
}

/// How far a run is.
struct Place {
    State state;
    std::int64_t step = 0;
    double next_dt;       // [s]
    int steps_given = 0;  // time.steps as the case file has it (same_case.h)
    bool owes_frame = false;  // of this step: the run was interrupted before it was written
    FileContents files = {};  // that the case names, as they were when the run was begun
};

bool at_end(const Place& place, const TimePlan& plan) {
    return place.state.moving.time() >= plan.end - same_time * plan.end / plan.steps;
}

/// Is there to be a frame of this step?
bool is_framed(const Place& place, const Case& given) {
    return place.step % given.output.every == 0 || at_end(place, given.time);
}

constexpr const char* steps_given_name = "steps_given";
constexpr std::string_view contents_of = "contents of ";  // before the key that names the file

/// What a checkpoint keeps of a free body, by name.
template <class State, class Visit>
void for_each_number(State& state, std::size_t body, const Visit& visit) {
    const std::string name = fmt::format("body {} ", body);
    const auto vector = [&](const char* what, auto& v) {
        for (int axis = 0; axis < 3; ++axis) visit(fmt::format("{}{} {}", name, what, axis), v[axis]);
    };
    vector("displacement", state.pose.displacement);
    for (std::size_t axis = 0; axis < 3; ++axis) vector(axis == 0 ? "x axis" : axis == 1 ? "y axis" : "z axis", state.pose.rotation.axes[axis]);
    vector("velocity", state.velocity);
    vector("spin", state.spin);
    for (std::size_t i = 0; i < 6; ++i) {
        visit(fmt::format("{}rate {}", name, i), state.rate[i]);
        for (std::size_t j = 0; j < 6; ++j) visit(fmt::format("{}response {} {}", name, i, j), state.response[i][j]);
    }
}

std::map<std::string, double> values_of(const std::vector<FreeState>& free) {
    std::map<std::string, double> values;
    for (std::size_t body = 0; body < free.size(); ++body)
        if (free[body].knows_response)
            for_each_number(free[body], body, [&](const std::string& name, double value) { values[name] = value; });
    return values;
}

std::vector<FreeState> free_states(const Case& given, const std::map<std::string, double>& values) {
    std::vector<FreeState> free(given.free.size());
    for (std::size_t body = 0; body < free.size(); ++body) {
        if (!given.free[body]) continue;
        free[body].velocity = given.free[body]->velocity;
        free[body].spin = given.free[body]->spin;
        for_each_number(free[body], body, [&](const std::string& name, double& value) {
            const auto known = values.find(name);
            if (known == values.end()) return;
            value = known->second;
            free[body].knows_response = true;
        });
    }
    return free;
}

/// Makes the case one with which the run goes on.
Place resume(Case& given, const RunOptions& options, const Watch* watch) {
    Checkpoint saved = read_checkpoint(options.out / checkpoint_name);
    const int steps_asked = given.time.steps;
    const auto known = saved.values.find(steps_given_name);
    const double had = known != saved.values.end() ? known->second : 0;
    FileContents files;
    for (const auto& [name, value] : saved.values)
        if (name.starts_with(contents_of)) files[name.substr(contents_of.size())] = value;
    go_on_with(given, {saved.case_text, static_cast<int>(had), saved.time, files}, options.case_file.string(),
               options.out.string());
    std::vector<FreeState> free = free_states(given, saved.values);
    std::vector<BodyPlace> places;
    for (std::size_t body = 0; body < free.size(); ++body)
        if (given.free[body]) places.push_back({body, free[body].pose});
    Place place{{MovingMesh(given.domain, std::move(saved.mesh), saved.time, adapt_options(given, watch), places),
                 std::move(saved.fields), std::move(free)},
                saved.step,
                saved.next_dt,
                steps_asked};
    place.owes_frame = is_framed(place, given) && !has_frame(options.out, place.step);
    place.files = std::move(files);
    return place;
}

Checkpoint checkpoint_of(const Place& place, const Case& given) {
    std::map<std::string, double> values = values_of(place.state.free);
    values.emplace(steps_given_name, place.steps_given);
    for (const auto& [key, contents] : place.files) values.emplace(std::string(contents_of) + key, contents);
    return {.mesh = place.state.moving.reference(),
            .fields = place.state.fields,
            .time = place.state.moving.time(),
            .next_dt = place.next_dt,
            .step = place.step,
            .case_text = to_toml(given),
            .values = std::move(values)};
}

/// The way to the next of the wanted times, or as much of it as `next_dt` allows.
double step_length(const Place& place, const TimePlan& plan) {
    const double wanted = plan.end / plan.steps, t = place.state.moving.time();
    const double target = wanted * (std::floor(t / wanted + same_time) + 1);
    const double left = std::min(target, plan.end) - t;
    return left > place.next_dt * (1 + same_time) ? place.next_dt : left;
}

class TimeLoop {
public:
    TimeLoop(const Case& given, const Ranks& ranks, Place place, RunOutput& output, bool test_rollback)
        : given_(given), ranks_(ranks), place_(std::move(place)), output_(output), test_rollback_(test_rollback) {}

    /// Goes on to the end of the case. Throws Interrupted if a watch says so: then the step is dropped.
    void run() {
        const double wanted = given_.time.end / given_.time.steps;
        if (place_.owes_frame) write_frame();
        for (heed(ranks_); !at_end(place_, given_.time); heed(ranks_)) {
            const auto begin = std::chrono::steady_clock::now();
            const StepOptions options{step_length(place_, given_.time), least_dt_share * wanted};
            if (test_rollback_) take_step_back(place_.state, given_, ranks_, options);
            const StepReport report = time_step(place_.state, given_, ranks_, options);
            ++place_.step;
            is_saved_ = false;
            place_.next_dt = std::min(wanted, next_dt(report.mesh, place_.next_dt));
            if (const double c = report.flow.largest_courant; given_.time.courant && c > 0)
                place_.next_dt = std::min(place_.next_dt, *given_.time.courant / c * report.mesh.dt);
            write(report, begin);
        }
    }

    /// Writes the checkpoint, if there is none of this step yet.
    void save() {
        if (!is_saved_) output_.write_checkpoint(checkpoint_of(place_, given_));
        is_saved_ = true;
    }
    [[nodiscard]] const Mesh& mesh() const { return place_.state.moving.reference(); }

private:
    void write(const StepReport& report, std::chrono::steady_clock::time_point begin) {
        const State& state = place_.state;
        output_.write_step(place_.step, report, state);
        for (const StepWarning& warning : report.warnings)
            if (said_.insert(warning.about).second) output_.say("warning: " + warning.text);
        if (is_framed(place_, given_)) {
            write_frame();
            save();
        }
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        output_.show_progress(place_.step, report, taken.count() * (given_.time.end - report.mesh.time) / report.mesh.dt);
    }

    /// If this is interrupted, a run that is resumed makes up for it.
    void write_frame() {
        output_.write_frame(place_.step, place_.state, ranks_.watch);
        place_.owes_frame = false;
    }

    const Case& given_;
    const Ranks& ranks_;
    Place place_;
    RunOutput& output_;
    bool test_rollback_;
    bool is_saved_ = false;  // the checkpoint is of this step
    std::set<std::string> said_;  // what warnings were about: each is said once
};

/// Does what all ranks do alike. A rank that its watch or an error has ended tells the others, who hear of it where
/// they meet next. (What ends rank 0 alone, which writes, ends the others too: see below.)
template <class Deed>
auto together(const Ranks& ranks, Deed deed) {
    try {
        return deed();
    } catch (const AllInterrupted&) {
        throw;
    } catch (const FileError&) {
        throw;
    } catch (const std::runtime_error&) {
        leave(ranks);
        throw;
    }
}

/// What was done is kept, whatever goes wrong: the last accepted step is in the checkpoint, and the page says why.
int run_to_end(TimeLoop& loop, RunOutput& output, const Ranks& ranks, Progress& progress,
               const std::filesystem::path& case_file) {
    try {
        together(ranks, [&] { loop.run(); });
        return 0;
    } catch (const FileError& error) {
        try {
            output.write_end(error, loop.mesh());
        } catch (const FileError&) {  // what could not be written first is what is told
        }
        throw;  // the checkpoint could not be written either
    } catch (const Interrupted&) {
        loop.save();
        progress.say("interrupted: a checkpoint is written; go on with --resume");
        return 130;
    } catch (const CaseError& error) {  // a quantity that has no value: first asked for here
        loop.save();
        output.write_end(error, loop.mesh());
        throw CaseError(fmt::format("{}: {}", case_file.string(), error.what()));
    } catch (const std::runtime_error& error) {
        loop.save();
        output.write_end(error, loop.mesh());
        throw;
    }
}

/// The run's first mesh, told on the way.
Place begin(const Case& given, const Ranks& ranks, Progress& progress) {
    FileContents files = contents_of_files(to_toml(given));
    const auto start_time = std::chrono::steady_clock::now();
    ranks.watch->progress = [&](std::string_view stage, double share) { progress.show_stage(stage, share); };
    Place place{start(given, ranks), 0, given.time.end / given.time.steps, given.time.steps, true, std::move(files)};
    ranks.watch->progress = {};
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_time;
    progress.say(mesh_line(place.state.moving.reference(), taken.count()));
    return place;
}

/// Where a run begins. Nothing is written yet; but if the mesh cannot be made, a page that says why.
Place first_place(const RunOptions& options, Case& given, const Ranks& ranks, Progress& progress) {
    try {
        return together(ranks, [&] {
            warn(foresee(given, ranks.watch));
            Place place = options.resume ? resume(given, options, ranks.watch) : begin(given, ranks, progress);
            heed(ranks);  // all have looked at the folder before one writes
            return place;
        });
    } catch (const Interrupted&) {
        if (options.resume) throw Interrupted("interrupted before the first step; the folder is as it was");
        throw Interrupted("interrupted while the initial mesh was made; nothing was written");
    } catch (const FloorError& error) {
        const bool holds_another = std::filesystem::exists(options.out / "steps.csv");  // with --force: as it was
        if (ranks.rank == 0 && !holds_another) report_end(options.out, error, nullptr);
        throw;
    }
}

/// Rank 0 holds the folder, for all; all look at it before.
std::unique_ptr<RunLock> hold_folder(const RunOptions& options, const Ranks& ranks) {
    check_run_folder(options);
    MPI_Barrier(ranks.communicator);
    std::unique_ptr<RunLock> lock;
    std::exception_ptr trouble;
    if (ranks.rank == 0) {
        try {
            lock = std::make_unique<RunLock>(options.out);
        } catch (...) {
            trouble = std::current_exception();
        }
    }
    int held = trouble ? 0 : 1;
    MPI_Bcast(&held, 1, MPI_INT, 0, ranks.communicator);
    if (trouble) std::rethrow_exception(trouble);
    if (held == 0) throw CaseError("the folder of the run cannot be held");
    return lock;
}

/// Of a run that is done.
void write_run_report(const std::filesystem::path& folder, const PageOptions& options) {
    try {
        write_report(folder, options);
    } catch (const Interrupted&) {
        throw Interrupted(fmt::format("interrupted while the report was made; the run is done. kropla report {}",
                                      folder.string()));
    }
}

/// The case, or why not; of a body's surface that is at fault, its triangles for who wants to look at them.
Case read_or_show(const RunOptions& options, bool writes) {
    try {
        return read_case(options.case_file, options.settings);
    } catch (const SurfaceFileError& error) {
        if (options.debug_mesh.empty()) throw;
        std::vector<std::array<int, 3>> faulty;
        std::vector<int> numbers;
        for (std::size_t t : error.faulty) {
            faulty.push_back(error.triangles[t]);
            numbers.push_back(static_cast<int>(t));
        }
        if (writes) write_triangles(options.debug_mesh, error.points, faulty, numbers);
        throw CaseError(fmt::format("{}; its {} triangles are in {}", error.what(), faulty.size(), options.debug_mesh.string()));
    }
}

int run_with(const RunOptions& options, const Ranks& ranks) {
    const auto start_time = std::chrono::steady_clock::now();
    Case given = read_or_show(options, ranks.rank == 0);
    const auto lock = hold_folder(options, ranks);
    Progress progress;
    if (!options.resume) progress.say(opening_line(options, given));
    Place place = first_place(options, given, ranks, progress);
    const std::string reached = spoken_time(place.state.moving.time());
    if (options.resume && at_end(place, given.time) && !place.owes_frame) {
        progress.say(fmt::format("{}: the run is finished: step {} at {}; nothing was done. With a later time.end it "
                                 "goes on", options.out.string(), place.step, reached));
        return 0;
    }
    if (options.resume)
        progress.say(fmt::format("{}: goes on after step {} at {}, until {}", options.out.string(), place.step, reached,
                                 spoken_time(given.time.end)));
    RunOutput output(options, given, ranks.rank == 0, place.step, place.state, progress);
    TimeLoop loop(given, ranks, std::move(place), output, options.test_rollback);
    if (!options.resume) loop.save();
    const int code = run_to_end(loop, output, ranks, progress, options.case_file);
    for (const std::string& option : unused_solver_options(options.solver_options))
        progress.say(fmt::format("{} was never used: nothing that was chosen asks for it", option));
    const PageOptions page = code == 0 ? PageOptions{.watch = ranks.watch} : PageOptions{.cuts = false};
    if (ranks.rank == 0) write_run_report(options.out, page);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_time;
    if (code != 0 || ranks.rank != 0) return code;
    for (const std::string& line : closing_lines(options.out, taken.count())) progress.say(line);
    return code;
}

/// Only rank 0 speaks: the others meet the same errors, as they do the same.
void silence(const Ranks& ranks) {
    if (ranks.rank == 0) return;
    if (std::freopen("/dev/null", "w", stdout) == nullptr ||
        std::freopen("/dev/null", "w", stderr) == nullptr)
        throw FileError("/dev/null cannot be opened");
}

}  // namespace

int run(const RunOptions& options) {
    Watch watch;
    const CatchInterrupts catching(watch);
    const PetscSession petsc(options.solver_options);
    Ranks ranks = petsc.all_ranks();
    ranks.watch = &watch;
    silence(ranks);
    using oneapi::tbb::global_control;
    std::optional<global_control> threads;
    if (options.threads > 0)
        threads.emplace(global_control::max_allowed_parallelism, static_cast<std::size_t>(options.threads));
    try {
        check_solver_options(options.solver_options);
        const int code = run_with(options, ranks);
        return ranks.rank == 0 ? code : 0;
    } catch (const FileError& error) {
        if (ranks.count == 1) throw;
        if (ranks.rank != 0) return 0;
        // The other ranks write nothing and would wait for this one for ever.
        fmt::print(stderr, "kropla: {}\n", error.what());
        MPI_Abort(ranks.communicator, 5);
        throw;
    } catch (const std::bad_alloc&) {
        if (ranks.count > 1) MPI_Abort(ranks.communicator, resources_used_up);  // as above
        throw;
    } catch (const std::runtime_error&) {
        // All ranks meet it; a rank that ended with a code of its own would have rank 0 killed before it has spoken.
        if (ranks.rank != 0) return 0;
        throw;
    }
}

}  // namespace kropla
