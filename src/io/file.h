#pragma once

#include <kropla/base/watch.h>

#include <filesystem>
#include <string>
#include <string_view>

namespace kropla {

/// The bytes of a regular file. Throws FileError with the path and the system's reason.
[[nodiscard]] std::string read_file(const std::filesystem::path& path);

/// Makes `bytes` the contents of the file, as a whole or not at all: they are written under a temporary name
/// beside it, flushed to the disk, and renamed. A file that was there survives every failure and crash before
/// the rename. Throws FileError with the path and the system's reason: disk full, no such folder, no
/// permission. Throws Interrupted if the watch says so: the file is as it was then, and nothing lies beside it.
void write_file(const std::filesystem::path& path, std::string_view bytes, const Watch* watch = nullptr);

}  // namespace kropla
