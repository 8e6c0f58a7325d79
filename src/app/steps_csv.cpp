#include "app/steps_csv.h"

#include "base/error.h"
#include "io/file.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>
#include <string_view>

namespace kropla {
namespace {

constexpr std::string_view columns =
    "step,time [s],dt [s],attempts,vertices,tets,prisms,max_aspect_ratio,p999_aspect_ratio,min_dihedral "
    "[deg],"
    "max_dihedral [deg],smoothing_sweeps,swaps,splits,collapses,local_remeshes,largest_ring,global_remeshes,"
    "touched_fraction,kept_vertices,kept_tets,mesh_seconds [s],simulate_seconds [s],transfer_seconds [s],"
    "mesh_cpu_seconds [s],transferred_fraction";

/// The step of a row; 0 if it has none.
int step_of(const std::string& line) {
    int step = 0;
    std::from_chars(line.data(), line.data() + line.size(), step);
    return step;
}

/// The header and the rows up to `last_step`, each with its end.
std::string kept(const std::filesystem::path& file, const std::string& header, int last_step) {
    std::istringstream in(read_file(file));
    std::string line;
    if (!std::getline(in, line) || line != header) {
        throw FileError(fmt::format("{}: has other columns than this run; was it written by another case?",
                                    file.string()));
    }
    std::string text = header + "\n";
    int reached = 0;
    while (reached < last_step && std::getline(in, line) && !in.eof()) {  // eof: the row has no end
        reached = step_of(line);
        if (reached > last_step) break;
        text += line + "\n";
    }
    if (reached != last_step) {
        throw FileError(fmt::format("{}: has no row for step {}, after which the run is to go on",
                                    file.string(), last_step));
    }
    return text;
}

}  // namespace

std::string csv_header(const std::vector<FieldBalance>& fields) {
    std::string header(columns);
    for (const FieldBalance& f : fields) {
        header += fmt::format(",{0}_integral [{1}],{0}_transfer_error,{0}_before_transfer [{1}],"
                              "{0}_limited [{2}],{0}_beyond_bounds [{2}]",
                              f.field, f.unit, f.value_unit);
        for (std::size_t body = 1; body <= f.from_bodies.size(); ++body)
            header += fmt::format(",{}_from_body_{} [{}/s]", f.field, body, f.unit);
    }
    return header;
}

std::string csv_line(const StepRow& r) {
    std::string line = fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", r.step, r.time, r.dt,
        r.attempts, r.vertices, r.tets, r.prisms, r.max_aspect_ratio, r.p999_aspect_ratio, r.min_dihedral,
        r.max_dihedral, r.smoothing_sweeps, r.swaps, r.splits, r.collapses, r.local_remeshes, r.largest_ring,
        r.global_remeshes, r.touched_fraction, r.kept_vertices, r.kept_tets, r.mesh_seconds, r.simulate_seconds,
        r.transfer_seconds, r.mesh_cpu_seconds, r.transferred_fraction);
    for (const FieldBalance& f : r.fields) {
        line += fmt::format(",{},{},{},{},{}", f.integral, f.transfer_error, f.before_transfer, f.limited,
                            f.beyond);
        for (const double flux : f.from_bodies) line += fmt::format(",{}", flux);
    }
    return line;
}

StepsTable::StepsTable(const std::filesystem::path& file, const std::vector<FieldBalance>& fields)
    : file_(file), out_(file, std::ios::binary) {
    out_ << csv_header(fields) << '\n' << std::flush;
    if (!out_) throw FileError(fmt::format("{}: cannot be written", file.string()));
}

StepsTable::StepsTable(const std::filesystem::path& file, const std::vector<FieldBalance>& fields,
                       int last_step)
    : file_(file) {
    write_file(file, kept(file, csv_header(fields), last_step));
    out_.open(file, std::ios::binary | std::ios::app);
    if (!out_) throw FileError(fmt::format("{}: cannot be written", file.string()));
}

void StepsTable::append(const StepRow& row) {
    out_ << csv_line(row) << '\n' << std::flush;
    if (!out_) throw FileError(fmt::format("{}: cannot be written; is the disk full?", file_.string()));
}

}  // namespace kropla
