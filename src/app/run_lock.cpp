#include "app/run_lock.h"

#include <kropla/base/error.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <ranges>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace kropla {
namespace {

namespace fs = std::filesystem;

/// Makes the folder with those above it. Returns those that are new, the outermost first.
std::vector<fs::path> make_folders(const fs::path& folder) {
    std::vector<fs::path> missing;
    std::error_code trouble;
    for (fs::path path = folder; !path.empty() && !fs::exists(path, trouble) && path != path.parent_path();
         path = path.parent_path())
        missing.push_back(path);
    fs::create_directories(folder, trouble);
    if (trouble) throw FileError(fmt::format("{}: cannot be made: {}", folder.string(), trouble.message()));
    std::ranges::reverse(missing);
    return missing;
}

std::string me() {
    std::array<char, 256> host = {};
    gethostname(host.data(), host.size() - 1);
    return fmt::format("process {} on {}", getpid(), host.data());
}

/// What the holder of the lock has written about itself.
std::string holder(int descriptor) {
    std::array<char, 400> text = {};
    const ssize_t got = pread(descriptor, text.data(), text.size() - 1, 0);
    return got > 0 ? std::string(text.data(), static_cast<std::size_t>(got)) : "another process";
}

/// Is the open file still the one of that name? Whoever held the lock takes the file away before he lets it go.
bool is_there(int descriptor, const fs::path& file) {
    struct stat opened = {}, named = {};
    return fstat(descriptor, &opened) == 0 && stat(file.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
           opened.st_dev == named.st_dev;
}

void remove_empty(const std::vector<fs::path>& folders) {
    std::error_code not_empty;
    for (const fs::path& folder : folders | std::views::reverse) fs::remove(folder, not_empty);
}

/// Opens and locks the file: its descriptor.
int locked(const fs::path& file) {
    for (;;) {
        const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) throw FileError(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
        if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
            const int error = errno;
            const std::string who = holder(descriptor);
            close(descriptor);
            const std::string folder = file.parent_path().string();
            if (error == EWOULDBLOCK) throw CaseError(fmt::format("{}: another run is at work there, {}", folder, who));
            throw FileError(fmt::format("{}: cannot be locked: {}", file.string(), std::strerror(error)));
        }
        if (is_there(descriptor, file)) return descriptor;
        close(descriptor);
    }
}

}  // namespace

RunLock::RunLock(fs::path folder) : file_(folder / "run.lock"), made_(make_folders(folder)) {
    try {
        descriptor_ = locked(file_);
    } catch (...) {
        remove_empty(made_);
        throw;
    }
    const std::string text = me();
    if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0) return;  // full: nameless
}

RunLock::~RunLock() {
    unlink(file_.c_str());
    close(descriptor_);
    remove_empty(made_);
}

}  // namespace kropla
