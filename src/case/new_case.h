#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kropla {

/// The commented case that a user starts from: cases/droplet.toml.
[[nodiscard]] std::string_view starting_case();

/// Writes it to NAME.toml (NAME may end in .toml already) and returns that path.
/// Throws CaseError if there is such a file, FileError if it cannot be written.
std::filesystem::path write_new_case(const std::string& name);

}  // namespace kropla
