#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace kropla {

/// Looks at the words of a command line before CLI11 reads it. Throws CaseError for a command or option that is not
/// known, with what was perhaps meant.
void check_words(const CLI::App& app, const std::vector<std::string>& words);

/// What is said of a command line that CLI11 cannot read; of something missing also what it is.
[[nodiscard]] std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error);

}  // namespace kropla
