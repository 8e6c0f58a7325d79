#include "report/run_files.h"

#include <kropla/base/error.h>
#include "io/file.h"

#include <algorithm>
#include <charconv>

namespace kropla {
namespace {

/// Without blanks and without what follows '#'; of `key = "formula"  # = number` with the number for the formula.
std::string stripped(std::string_view line) {
    constexpr std::string_view value = "  # = ";
    const std::size_t known = line.find(value);
    std::string text(line.substr(0, line.find(known == std::string_view::npos ? '#' : '=')));
    if (known != std::string_view::npos) text += '=' + std::string(line.substr(known + value.size()));
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '_'; });
    return text;
}

/// The line `key = ...` of a file in the plain form in which a run writes it, without the key; empty without it.
std::string_view value_of(std::string_view text, std::string_view key) {
    const std::string wanted = '\n' + std::string(key) + " = ";
    const std::size_t at = text.find(wanted);
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at + wanted.size());
    return text.substr(0, text.find('\n'));
}

/// What stands between quotes, its escapes undone.
std::string unquoted(std::string_view quoted) {
    std::string text;
    for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
        if (quoted[i] == '\\' && i + 2 < quoted.size()) ++i;
        text += quoted[i];
    }
    return text;
}

/// Three numbers as a TOML array begins; nothing if they are not there.
std::optional<Vec3> read_vector(std::string_view text) {
    Vec3 vector;
    for (int axis = 0; axis < 3; ++axis) {
        text.remove_prefix(std::min(text.find_first_not_of("[, "), text.size()));
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), vector[axis]);
        if (error != std::errc()) return {};
        text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    }
    return vector;
}

/// What stands as `key` in the table `[section]` of a case as run, without blanks.
std::optional<std::string> text_of_case(std::string_view case_text, std::string_view section,
                                        std::string_view key) {
    const std::string header = '[' + std::string(section) + ']';
    std::string wanted = std::string(key) + '=';
    std::erase(wanted, '_');
    bool inside = false;
    while (!case_text.empty()) {
        const std::size_t end = std::min(case_text.find('\n'), case_text.size());
        const std::string line = stripped(case_text.substr(0, end));
        case_text.remove_prefix(std::min(end + 1, case_text.size()));
        if (line.starts_with('[')) inside = line == header;
        if (inside && line.starts_with(wanted)) return line.substr(wanted.size());
    }
    return {};
}

Ending read_ending(const std::filesystem::path& path) {
    const std::string text = read_file(path);
    Ending ending{unquoted(value_of(text, "why")), {}};
    if (ending.why.empty()) throw FileError(path.string() + ": does not say why the run ended");
    ending.place = read_vector(value_of(text, "place"));
    return ending;
}

/// Of a run that ended before its first step.
RunFiles without_steps(const std::filesystem::path& dir) {
    RunFiles run{.dir = dir, .name = folder_name(dir), .case_text = {}, .steps = {}, .bodies = {}, .frames = {}};
    run.ending = read_ending(dir / ending_name);
    return run;
}

}  // namespace

std::string folder_name(const std::filesystem::path& dir) {
    const std::filesystem::path whole = std::filesystem::absolute(dir).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

RunFiles read_run_files(const std::filesystem::path& dir) {
    const bool ended = std::filesystem::exists(dir / ending_name);
    if (ended && !std::filesystem::exists(dir / "steps.csv")) return without_steps(dir);
    RunFiles run{.dir = dir,
                 .name = folder_name(dir),
                 .case_text = read_file(dir / "case.toml"),
                 .steps = read_table(dir / "steps.csv"),
                 .bodies = {},
                 .frames = read_pvd(dir / "frames.pvd")};
    if (std::filesystem::exists(dir / "bodies.csv")) run.bodies = read_table(dir / "bodies.csv");
    if (ended) run.ending = read_ending(dir / ending_name);
    std::ranges::stable_sort(run.frames, {}, &SeriesEntry::time);
    return run;
}

std::optional<double> number_of_case(std::string_view case_text, std::string_view section,
                                     std::string_view key) {
    const std::optional<std::string> text = text_of_case(case_text, section, key);
    if (!text) return {};
    double value = 0;
    const char* last = text->data() + text->size();
    const auto [stop, error] = std::from_chars(text->data(), last, value);
    return error == std::errc() && stop == last ? std::optional(value) : std::nullopt;
}

std::optional<Vec3> vector_of_case(std::string_view case_text, std::string_view section,
                                   std::string_view key) {
    const std::optional<std::string> text = text_of_case(case_text, section, key);
    return text ? read_vector(*text) : std::nullopt;
}

}  // namespace kropla
