#include "io/file.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace kropla {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, int error) {
    throw FileError(path.string() + ": " + what + ": " + std::strerror(error));
}

constexpr std::size_t bytes_at_once = std::size_t{1} << 22;  // between two looks at the watch

/// Owns an open file.
class OpenFile {
public:
    explicit OpenFile(int descriptor) : descriptor_(descriptor) {}
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
    }
    [[nodiscard]] int descriptor() const { return descriptor_; }
    /// Closing may be what finds the disk full: 0, or the system's error.
    [[nodiscard]] int close() { return ::close(std::exchange(descriptor_, -1)) == 0 ? 0 : errno; }

private:
    int descriptor_;
};

[[nodiscard]] bool says_stop(const Watch* watch) { return watch != nullptr && watch->stop; }

/// Writes all bytes and flushes them to the disk: 0, or the system's error, which is ECANCELED if the watch says stop.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes, const Watch* watch) {
    while (!bytes.empty()) {
        if (says_stop(watch)) return ECANCELED;
        const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), bytes_at_once));
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return errno;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return ::fsync(descriptor) == 0 ? 0 : errno;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
    // Not to wait for a writer, should this be a pipe.
    const OpenFile file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (file.descriptor() < 0) fail(path, "cannot be read", errno);
    struct stat status = {};
    if (::fstat(file.descriptor(), &status) != 0) fail(path, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) fail(path, "cannot be read", EISDIR);
    if (!S_ISREG(status.st_mode)) throw FileError(path.string() + ": cannot be read: not a regular file");

    std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
    std::size_t filled = 0;
    while (filled < bytes.size()) {
        const ssize_t got = ::read(file.descriptor(), bytes.data() + filled, bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) fail(path, "cannot be read", errno);
        if (got == 0) break;  // someone cut the file meanwhile
        filled += static_cast<std::size_t>(got);
    }
    bytes.resize(filled);
    return bytes;
}

void write_file(const std::filesystem::path& path, std::string_view bytes, const Watch* watch) {
    std::error_code unknown;
    const auto there = std::filesystem::status(path, unknown);
    if (std::filesystem::is_directory(there)) fail(path, "cannot be written", EISDIR);
    if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there))
        throw FileError(path.string() + ": cannot be written: not a regular file");

    const std::string temporary = path.string() + ".part";
    OpenFile file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.descriptor() < 0) fail(path, "cannot be written", errno);
    int error = write_all(file.descriptor(), bytes, watch);
    if (const int closing = file.close(); error == 0) error = closing;
    if (error == 0 && ::rename(temporary.c_str(), path.c_str()) != 0) error = errno;
    if (error == 0) return;
    ::unlink(temporary.c_str());
    if (error == ECANCELED) heed(watch);
    fail(path, "cannot be written", error);
}

}  // namespace kropla
