#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// A column as it stands in the file, its header "time [s]" taken apart.
struct Column {
    std::string name, unit;
    std::vector<std::string> cells;
};

/// A table of comma-separated values with one line of names.
struct Table {
    std::string file;
    std::size_t rows = 0;
    std::vector<Column> columns;
};

/// Reads a table. What follows the last line end is left out: a row that a run was just about to write.
/// Throws FileError if the file is missing, has no line of names, or a row has more or fewer cells than
/// names.
[[nodiscard]] Table read_table(const std::filesystem::path& path);
/// As above, from the text itself; `file` stands in errors.
[[nodiscard]] Table parse_table(std::string_view text, const std::string& file);

/// A text as it stands in a cell: in quotes where it has to be.
[[nodiscard]] std::string csv_cell(const std::string& text);

[[nodiscard]] bool has_column(const Table& table, std::string_view name);

/// The column's cells as numbers. Throws FileError if there is no such column, or a cell is not a number:
/// says which.
[[nodiscard]] std::vector<double> numbers(const Table& table, std::string_view name);

}  // namespace kropla
