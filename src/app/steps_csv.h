#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace kropla {

/// A figure of an accepted step, in a column of steps.csv.
struct Figure {
    std::string column;  // name and unit: "time [s]"
    double value;
};
/// The same columns in each row of a run.
using StepRow = std::vector<Figure>;

/// The header: "step,time [s],dt [s],...".
[[nodiscard]] std::string csv_header(const StepRow& row);
/// One line, without its end; numbers to full precision.
[[nodiscard]] std::string csv_line(const StepRow& row);

/// The table of a run's steps. Every row is in the file when `append` returns.
class StepsTable {
public:
    /// Starts the file anew, with the header; the rows will have the columns of `like`.
    StepsTable(const std::filesystem::path& file, const StepRow& like);
    /// Continues the file after `last_step`; later rows are cut off, and so is a row that was not written to
    /// its end. Throws FileError also if the file has other columns, or does not reach `last_step`.
    StepsTable(const std::filesystem::path& file, const StepRow& like, int last_step);

    /// Throws FileError if the row cannot be written.
    void append(const StepRow& row);

private:
    std::filesystem::path file_;
    std::ofstream out_;
};

}  // namespace kropla
