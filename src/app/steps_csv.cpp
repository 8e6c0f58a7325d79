#include "app/steps_csv.h"

#include <kropla/base/error.h>
#include "io/file.h"

#include <fmt/format.h>

#include <charconv>
#include <sstream>

namespace kropla {
namespace {

template <class Text>
std::string joined(const StepRow& row, Text text) {
    std::string line;
    for (const Figure& figure : row) line += (line.empty() ? "" : ",") + text(figure);
    return line;
}

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

std::string csv_header(const StepRow& row) {
    return joined(row, [](const Figure& figure) { return figure.column; });
}

std::string csv_line(const StepRow& row) {
    return joined(row, [](const Figure& figure) { return fmt::format("{}", figure.value); });
}

StepsTable::StepsTable(const std::filesystem::path& file, const StepRow& like)
    : file_(file), out_(file, std::ios::binary) {
    out_ << csv_header(like) << '\n' << std::flush;
    if (!out_) throw FileError(fmt::format("{}: cannot be written", file.string()));
}

StepsTable::StepsTable(const std::filesystem::path& file, const StepRow& like,
                       int last_step)
    : file_(file) {
    write_file(file, kept(file, csv_header(like), last_step));
    out_.open(file, std::ios::binary | std::ios::app);
    if (!out_) throw FileError(fmt::format("{}: cannot be written", file.string()));
}

void StepsTable::append(const StepRow& row) {
    out_ << csv_line(row) << '\n' << std::flush;
    if (!out_) throw FileError(fmt::format("{}: cannot be written; is the disk full?", file_.string()));
}

}  // namespace kropla
