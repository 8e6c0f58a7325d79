#include "report/sweep_file.h"

#include <kropla/base/error.h>

#include <algorithm>

namespace kropla {

SweepFile read_sweep_file(const std::filesystem::path& dir) {
    Table table = read_table(dir / sweep_table_name);
    const auto code = std::ranges::find(table.columns, "exit_code", &Column::name);
    if (table.columns.front().name != "run" || table.columns.end() - code < 2)
        throw FileError(table.file + ": is no table of a sweep");
    const std::vector<double> codes = numbers(table, "exit_code"), seconds = numbers(table, "wall_seconds");
    SweepFile sweep;
    for (auto key = table.columns.begin() + 1; key != code; ++key) sweep.keys.push_back(key->name);
    for (std::size_t r = 0; r < table.rows; ++r) {
        SweptRun run{table.columns.front().cells[r], {}, static_cast<int>(codes[r]), seconds[r]};
        for (auto key = table.columns.begin() + 1; key != code; ++key) run.values.push_back(key->cells[r]);
        sweep.runs.push_back(std::move(run));
    }
    sweep.last.assign(code + 2, table.columns.end());
    return sweep;
}

}  // namespace kropla
