#include "report/table.h"

#include <kropla/base/error.h>
#include "io/file.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace kropla {
namespace {

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// A cell with commas stands in quotes, which are doubled within (RFC 4180).
std::vector<std::string> cells_of(std::string_view line) {
    std::vector<std::string> cells(1);
    bool quoted = false;
    for (std::size_t i = 0; i < line.size(); ++i) {
        const bool doubled = quoted && line.substr(i, 2) == "\"\"";
        if (line[i] == '"' && !doubled) quoted = !quoted;
        else if (line[i] == ',' && !quoted) cells.emplace_back();
        else cells.back() += line[i];
        if (doubled) ++i;
    }
    for (std::string& cell : cells) cell = trimmed(cell);
    return cells;
}

/// The lines that have an end.
std::vector<std::string_view> lines_of(std::string_view text) {
    std::vector<std::string_view> lines;
    for (std::size_t end; (end = text.find('\n')) != std::string_view::npos; text.remove_prefix(end + 1)) {
        if (const std::string_view line = trimmed(text.substr(0, end)); !line.empty()) lines.push_back(line);
    }
    return lines;
}

Column column_named(std::string_view header) {
    const std::size_t bracket = header.find(" [");  // without the blank it is a part of the name: body[0].radius
    if (bracket == std::string_view::npos) return {std::string(header), "", {}};
    const std::string_view unit = header.substr(bracket + 2);
    return {std::string(trimmed(header.substr(0, bracket))), std::string(unit.substr(0, unit.find(']'))), {}};
}

}  // namespace

Table read_table(const std::filesystem::path& path) { return parse_table(read_file(path), path.string()); }

Table parse_table(std::string_view text, const std::string& file) {
    const std::vector<std::string_view> lines = lines_of(text);
    if (lines.empty()) throw FileError(file + ": has no line of column names");
    Table table{.file = file, .rows = lines.size() - 1, .columns = {}};
    for (const std::string& header : cells_of(lines[0])) table.columns.push_back(column_named(header));
    for (std::size_t row = 1; row < lines.size(); ++row) {
        std::vector<std::string> cells = cells_of(lines[row]);
        if (cells.size() != table.columns.size()) {
            throw FileError(file + ": row " + std::to_string(row) + " has " + std::to_string(cells.size()) +
                            " cells, not " + std::to_string(table.columns.size()));
        }
        for (std::size_t i = 0; i < cells.size(); ++i) table.columns[i].cells.push_back(std::move(cells[i]));
    }
    return table;
}

std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

bool has_column(const Table& table, std::string_view name) {
    return std::ranges::any_of(table.columns, [&](const Column& c) { return c.name == name; });
}

std::vector<double> numbers(const Table& table, std::string_view name) {
    const auto column = std::ranges::find(table.columns, name, &Column::name);
    if (column == table.columns.end()) throw FileError(table.file + ": has no column " + std::string(name));
    std::vector<double> values;
    for (const std::string& cell : column->cells) {
        double value = 0;
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || end != cell.data() + cell.size()) {
            throw FileError(table.file + ": row " + std::to_string(values.size() + 1) + ", " + column->name +
                            ": not a number: '" + cell + "'");
        }
        values.push_back(value);
    }
    return values;
}

}  // namespace kropla
