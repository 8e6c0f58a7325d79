#pragma once

#include <string>
#include <vector>

namespace kropla {

/// A whole page in the look of all, with what stands in it. It needs nothing but itself.
[[nodiscard]] std::string html_page(const std::string& title, const std::string& content);

/// A figure with its name, for a row of `tiles`.
[[nodiscard]] std::string tile(const std::string& name, const std::string& value);

/// A row of a table; `cell` is "td" or "th". The values are HTML.
[[nodiscard]] std::string table_row(const char* cell, const std::vector<std::string>& values);

}  // namespace kropla
