#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace kropla {

/// What one field conserves: its integral over the box, how far the transfer missed it, and what became of
/// its values.
struct FieldBalance {
    std::string field;       // "energy"
    std::string unit;        // "J", of the integral
    std::string value_unit;  // "K", of the values that are carried
    double integral = 0;
    double transfer_error = 0;   // [-] relative
    double before_transfer = 0;  // the integral, before the last transfer of the step
    double limited = 0;          // the most that the limiter moved a value
    double beyond = 0;           // the most that a value is beyond the old ones around it
    std::vector<double> from_bodies = {};  // [unit/s] that left body 1, 2, ... through its surface
};

/// A row of steps.csv: an accepted step.
struct StepRow {
    int step = 0;
    double time = 0, dt = 0;  // [s]
    int attempts = 0;
    int vertices = 0, tets = 0, prisms = 0;
    double max_aspect_ratio = 0, p999_aspect_ratio = 0;  // [-] R/r
    double min_dihedral = 0, max_dihedral = 0;           // [deg]
    int smoothing_sweeps = 0, swaps = 0, splits = 0, collapses = 0;
    int local_remeshes = 0;
    int largest_ring = 0;  // of cells around a cluster that local remeshing had to take in
    int global_remeshes = 0;
    double touched_fraction = 0;                                          // [-] of the cells
    double kept_vertices = 0, kept_tets = 0;                              // [-] of those there are now
    double mesh_seconds = 0, simulate_seconds = 0, transfer_seconds = 0;  // [s]
    double mesh_cpu_seconds = 0;                                          // [s] of all threads
    double transferred_fraction = 0;                                      // [-] of the cells
    std::vector<FieldBalance> fields;  // the same ones, in the same order, in each row of a run
};

/// The header, names and units: "step,time [s],dt [s],...,energy_integral [J],energy_transfer_error".
[[nodiscard]] std::string csv_header(const std::vector<FieldBalance>& fields);
/// One line, without its end; numbers to full precision.
[[nodiscard]] std::string csv_line(const StepRow& row);

/// The table of a run's steps. Every row is in the file when `append` returns.
class StepsTable {
public:
    /// Starts the file anew, with the header; `fields` name what the rows will have.
    StepsTable(const std::filesystem::path& file, const std::vector<FieldBalance>& fields);
    /// Continues the file after `last_step`; later rows are cut off, and so is a row that was not written to
    /// its end. Throws FileError also if the file has other columns, or does not reach `last_step`.
    StepsTable(const std::filesystem::path& file, const std::vector<FieldBalance>& fields, int last_step);

    /// Throws FileError if the row cannot be written.
    void append(const StepRow& row);

private:
    std::filesystem::path file_;
    std::ofstream out_;
};

}  // namespace kropla
