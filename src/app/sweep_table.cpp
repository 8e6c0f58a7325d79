// The table of a sweep.
#include "app/sweep_table.h"

#include <kropla/base/error.h>
#include "io/file.h"
#include "report/sweep_file.h"
#include "report/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace kropla {
namespace {

std::string header_of(const Column& column) {
    return column.unit.empty() ? column.name : fmt::format("{} [{}]", column.name, column.unit);
}

/// The steps of a run; nothing if it has taken none.
std::optional<Table> steps_of(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(folder / "steps.csv")) return {};
    Table steps = read_table(folder / "steps.csv");
    return steps.rows > 0 ? std::optional(std::move(steps)) : std::nullopt;
}

std::string last_of(const std::optional<Table>& steps, const std::string& header) {
    if (!steps) return "";
    const auto column = std::ranges::find(steps->columns, header, header_of);
    return column == steps->columns.end() ? "" : column->cells.back();
}

}  // namespace

std::vector<SweepRow> read_sweep_table(const std::filesystem::path& dir, const std::vector<std::string>& keys) {
    std::vector<SweepRow> rows;
    if (!std::filesystem::exists(dir / sweep_table_name)) return rows;
    const SweepFile file = read_sweep_file(dir);
    if (file.keys != keys)
        throw CaseError(fmt::format("{}: holds a sweep over {}, this one is over {}; name another folder with --out",
                                    dir.string(), fmt::join(file.keys, ", "), fmt::join(keys, ", ")));
    for (const SweptRun& run : file.runs) rows.push_back({{run.name, run.values}, run.code, run.seconds});
    return rows;
}

void write_sweep_table(const std::filesystem::path& dir, const std::vector<std::string>& keys,
                       const std::vector<SweepRow>& rows) {
    std::vector<std::optional<Table>> steps;
    std::vector<std::string> columns;  // of any run's steps
    for (const SweepRow& row : rows) {
        steps.push_back(steps_of(dir / row.run.name));
        for (const Column& column : steps.back() ? steps.back()->columns : std::vector<Column>())
            if (std::ranges::find(columns, header_of(column)) == columns.end()) columns.push_back(header_of(column));
    }
    std::string text = "run";
    for (const std::string& key : keys) text += ',' + csv_cell(key);
    text += ",exit_code,wall_seconds [s]";
    for (const std::string& column : columns) text += ',' + csv_cell(column);
    text += '\n';
    for (std::size_t r = 0; r < rows.size(); ++r) {
        text += csv_cell(rows[r].run.name);
        for (const std::string& value : rows[r].run.values) text += ',' + csv_cell(value);
        text += fmt::format(",{},{:.3f}", rows[r].code, rows[r].seconds);
        for (const std::string& column : columns) text += ',' + last_of(steps[r], column);
        text += '\n';
    }
    write_file(dir / sweep_table_name, text);
}

}  // namespace kropla
