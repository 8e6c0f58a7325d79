#pragma once

#include "program.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace kropla {

/// The program at work, its output a pipe that has room for what it says before the first step (`opening`
/// characters) and for so many lines: in the step after them it stands still when it has done all but to say so,
/// until `finish` drains the pipe. So a test may meet it at a step of its choice.
class HeldProgram {
public:
    HeldProgram(const TemporaryFolder& folder, std::vector<std::string> arguments, int lines,
                std::size_t opening)
        : folder_(folder.path) {
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        reader_ = ends[0];
        const int room = fcntl(reader_, F_SETPIPE_SZ, 1);  // as small as they come: a page
        constexpr int line = 105;                          // what a step of a short case says
        const std::string filling(static_cast<std::size_t>(room - line * lines - line / 2) - opening, ' ');
        filling_ = filling.size();
        if (::write(ends[1], filling.data(), filling_) != static_cast<ssize_t>(filling_))
            throw std::runtime_error("a pipe that cannot be filled");
        process_ = fork();
        if (process_ == 0) become_the_program(std::move(arguments), ends[1]);
        close(ends[1]);
    }
    ~HeldProgram() {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
        close(reader_);
    }
    HeldProgram(const HeldProgram&) = delete;
    HeldProgram& operator=(const HeldProgram&) = delete;

    /// Waits until the table of the run in the folder `run` has so many rows; false if that takes too long.
    bool reaches(const std::string& run, int rows) const {
        for (int i = 0; i < 30000; ++i) {
            const std::string table = contents(folder_ / run / "steps.csv");
            if (std::count(table.begin(), table.end(), '\n') > rows) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    /// Waits until there is such a file; false if that takes too long.
    bool writes(const std::string& file) const {
        for (int i = 0; i < 30000; ++i) {
            if (std::filesystem::exists(folder_ / file)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return false;
    }
    /// Waits until it has said `text`, which is taken out of the pipe; false if that takes too long.
    bool says(const std::string& text) {
        pollfd output = {reader_, POLLIN, 0};
        char part[4096];
        while (said_.find(text) == std::string::npos) {
            if (poll(&output, 1, 60000) <= 0) return false;
            const ssize_t n = read(reader_, part, sizeof part);
            if (n <= 0) return false;
            said_.append(part, static_cast<std::size_t>(n));
        }
        return true;
    }
    void signal(int number) const { kill(process_, number); }
    /// Does it end within so many seconds?
    bool ends_within(int seconds) const {
        for (int i = 0; i < 100 * seconds; ++i) {
            siginfo_t info = {};
            if (waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
                info.si_pid == process_)
                return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    }
    /// From now on, no file of its can be longer: what it sees is what a full disk shows.
    void let_files_grow_to(std::size_t bytes) const {
        const rlimit limit{bytes, bytes};
        if (prlimit(process_, RLIMIT_FSIZE, &limit, nullptr) != 0) throw std::runtime_error("no limit");
    }

    /// Lets it go on to its end. The code is -1 if a signal ended it.
    Outcome finish() {
        std::string out = std::move(said_);
        char part[4096];
        for (ssize_t n; (n = read(reader_, part, sizeof part)) > 0;)
            out.append(part, static_cast<std::size_t>(n));
        int status = 0;
        waitpid(process_, &status, 0);
        process_ = 0;
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out.substr(filling_),
                contents(folder_ / "err.txt")};
    }

private:
    [[noreturn]] void become_the_program(std::vector<std::string> arguments, int output) const {
        const int errors = open((folder_ / "err.txt").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        std::signal(SIGXFSZ, SIG_IGN);  // so that a write beyond the limit fails, and does not kill
        dup2(output, STDOUT_FILENO);
        dup2(errors, STDERR_FILENO);
        arguments.insert(arguments.begin(), KROPLA_PROGRAM);
        std::vector<char*> words;
        for (std::string& word : arguments) words.push_back(word.data());
        words.push_back(nullptr);
        if (chdir(folder_.c_str()) == 0) execv(KROPLA_PROGRAM, words.data());
        _exit(127);
    }

    std::filesystem::path folder_;
    int reader_ = -1;
    std::size_t filling_ = 0;
    std::string said_;
    pid_t process_ = 0;
};

}  // namespace kropla
