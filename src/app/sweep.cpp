// A case run for many values, one after another. Each run is a process of its own, which takes down no other with it.
#include "app/sweep.h"

#include "case/case.h"
#include "app/commands.h"
#include "app/interrupt.h"
#include "app/progress.h"
#include "app/run_folder.h"
#include "app/run_lock.h"
#include "app/sweep_table.h"
#include <kropla/base/error.h>
#include "io/file.h"
#include "report/sweep_file.h"
#include "report/sweep_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

constexpr const char* log_name = "run.log";

/// Becomes `kropla run ...`, as execute would do it, what it says going to the log.
[[noreturn]] void become(const std::vector<std::string>& words, const fs::path& log, const Watch& watch) {
    prctl(PR_SET_PDEATHSIG, SIGINT);  // nobody would wait for it
    std::signal(SIGINT, SIG_DFL);     // until the run catches them itself
    std::signal(SIGTERM, SIG_DFL);
    if (watch.stop) _exit(interrupted);
    if (std::freopen(log.c_str(), "a", stdout) == nullptr || dup2(STDOUT_FILENO, STDERR_FILENO) < 0) _exit(file_trouble);
    const int code = execute(words);
    std::fflush(stdout);
    _exit(code);
}

/// Runs it as a process of its own: the exit code. Whoever stops the sweep stops it too.
int run_apart(const std::vector<std::string>& words, const fs::path& log, const Watch& watch) {
    std::fflush(nullptr);
    const pid_t process = fork();
    if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
    if (process == 0) become(words, log, watch);
    int status = 0;
    bool told = false;
    while (waitpid(process, &status, WNOHANG) == 0) {
        if (watch.stop && !std::exchange(told, true)) kill(process, SIGINT);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The last complaint in a run's log, which is no warning.
std::string complaint_in(const fs::path& log) {
    const std::string text = read_file(log);
    constexpr std::string_view start = "kropla: ", warning = "kropla: warning: ";
    std::string found;
    for (std::size_t at = 0, end; at < text.size(); at = end + 1) {
        end = std::min(text.find('\n', at), text.size());
        const std::string_view line = std::string_view(text).substr(at, end - at);
        if (line.starts_with(start) && !line.starts_with(warning)) found = line.substr(start.size());
    }
    return found;
}

class Sweep {
public:
    Sweep(const SweepOptions& options, SweepPlan plan, std::vector<std::string> cases)
        : options_(options), plan_(std::move(plan)), cases_(std::move(cases)),
          known_(read_sweep_table(options.out, plan_.keys)) {
        for (const SweepRun& run : plan_.runs) name_width_ = std::max(name_width_, run.name.size());
    }

    int run_all(const Watch& watch) {
        const auto start = std::chrono::steady_clock::now();
        const std::size_t count = plan_.runs.size();
        print(fmt::format("{}: {} runs into {}\n", options_.case_file.string(), count, options_.out.string()));
        for (std::size_t number = 0; number < count && !interrupted_; ++number) {
            run(number, watch);
            interrupted_ = interrupted_ || watch.stop;
        }
        keep();
        const auto succeeded = static_cast<std::size_t>(std::ranges::count(rows_, 0, &SweepRow::code));
        if (interrupted_) {
            print(fmt::format("interrupted: {} of {} runs are done; the same command goes on\n", succeeded, count));
            return interrupted;
        }
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        const std::string runs = succeeded == count ? fmt::format("done: {} runs", count)
                                                    : fmt::format("{} of {} runs are done,", succeeded, count);
        print(fmt::format("{} in {}; see {}\n", runs, clock_time(taken.count()),
                          (options_.out / sweep_page_name).string()));
        return std::ranges::max_element(rows_, {}, &SweepRow::code)->code;
    }

private:
    void run(std::size_t number, const Watch& watch) {
        const SweepRun& planned = plan_.runs[number];
        const fs::path folder = options_.out / planned.name;
        const auto before = std::ranges::find(known_, planned.name, [](const SweepRow& row) { return row.run.name; });
        SweepRow row = before != known_.end() ? *before : SweepRow{planned};
        print(fmt::format("run {:>{}}/{}  {:<{}}  ", number + 1, fmt::formatted_size("{}", plan_.runs.size()),
                          plan_.runs.size(), planned.name, name_width_));
        if (before != known_.end() && row.code == done && is_complete(folder, cases_[number])) {
            rows_.push_back(row);
            return print("done before\n");
        }
        const auto start = std::chrono::steady_clock::now();
        make_folder(folder);
        row.code = run_apart(words(planned, folder), folder / log_name, watch);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        row.seconds += taken.count();
        interrupted_ = row.code == interrupted;
        rows_.push_back(row);
        tell(row, taken.count());
        if (!interrupted_) keep();
    }

    /// Has the run come to the end of this very case?
    static bool is_complete(const fs::path& folder, const std::string& case_text) {
        return fs::exists(folder / checkpoint_name) && fs::exists(folder / "case.toml") &&
               read_file(folder / "case.toml") == case_text;
    }

    static void make_folder(const fs::path& folder) {
        std::error_code trouble;
        fs::create_directories(folder, trouble);
        if (trouble) throw FileError(fmt::format("{}: cannot be made: {}", folder.string(), trouble.message()));
    }

    /// What the run is told: to go on where it can; else to start, over what it left before its first checkpoint.
    std::vector<std::string> words(const SweepRun& planned, const fs::path& folder) const {
        std::vector<std::string> words = {"run", options_.case_file.string(), "--out", folder.string()};
        words.push_back(fs::exists(folder / checkpoint_name) ? "--resume" : "--force");
        for (const std::string& setting : settings_of(plan_, planned)) words.insert(words.end(), {"--set", setting});
        if (options_.threads > 0) words.insert(words.end(), {"--threads", std::to_string(options_.threads)});
        words.insert(words.end(), options_.solver_options.begin(), options_.solver_options.end());
        return words;
    }

    void tell(const SweepRow& row, double seconds) const {
        const std::string in = "in " + clock_time(seconds);
        if (row.code == done) return print(fmt::format("done {}\n", in));
        if (row.code == interrupted) return print(fmt::format("interrupted {}\n", in));
        print(fmt::format("failed {}, exit code {}\n", in, row.code));
        const fs::path folder = options_.out / row.run.name;
        const std::string why = row.code > 128 ? fmt::format("ended by signal {}", row.code - 128)
                                               : complaint_in(folder / log_name);
        fmt::print(stderr, "kropla: {}: {}\n", folder.string(), why);
    }

    /// The table and the page, with the rows of runs that are still to come, or are of other values, as they were.
    void keep() const {
        std::vector<SweepRow> all = rows_;
        for (const SweepRow& row : known_)
            if (std::ranges::none_of(all, [&](const SweepRow& other) { return other.run.name == row.run.name; }) &&
                fs::exists(options_.out / row.run.name))
                all.push_back(row);
        if (all.empty()) return;
        write_sweep_table(options_.out, plan_.keys, all);
        write_sweep_report(options_.out);
    }

    static void print(std::string_view text) {
        std::fwrite(text.data(), 1, text.size(), stdout);
        std::fflush(stdout);
    }

    const SweepOptions& options_;
    SweepPlan plan_;
    std::vector<std::string> cases_;  // as they will be run
    std::vector<SweepRow> known_;     // of the table when the sweep began
    std::vector<SweepRow> rows_;
    std::size_t name_width_ = 0;
    bool interrupted_ = false;
};

/// The cases as they will be run. Throws CaseError, naming the run, if one is wrong.
std::vector<std::string> cases_of(const fs::path& case_file, const SweepPlan& plan) {
    std::vector<std::string> cases;
    for (const SweepRun& run : plan.runs) {
        try {
            cases.push_back(to_toml(read_case(case_file, settings_of(plan, run))));
        } catch (const CaseError& error) {
            throw CaseError(fmt::format("{} (in the run {})", error.what(), run.name));
        }
    }
    return cases;
}

void check_sweep_folder(const fs::path& folder) {
    if (folder.empty()) throw CaseError("--out: names no folder; \".\" is the one you are in");
    if (fs::exists(folder) && !fs::is_directory(folder))
        throw FileError(fmt::format("{}: is a file; --out must name a folder", folder.string()));
    if (fs::exists(folder / checkpoint_name))
        throw CaseError(fmt::format("{}: holds a run; name another folder with --out", folder.string()));
    if (std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr || std::getenv("PMI_SIZE") != nullptr)
        throw CaseError("kropla sweep starts its runs itself, one after another: leave mpirun out");
}

}  // namespace

int sweep(const SweepOptions& options) {
    Watch watch;
    const CatchInterrupts catching(watch);
    SweepPlan plan = plan_sweep(options.settings);
    std::vector<std::string> cases = cases_of(options.case_file, plan);
    check_sweep_folder(options.out);
    const RunLock lock(options.out);
    return Sweep(options, std::move(plan), std::move(cases)).run_all(watch);
}

}  // namespace kropla
