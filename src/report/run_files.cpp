#include "report/run_files.h"

#include "io/file.h"

#include <algorithm>
#include <charconv>

namespace kropla {
namespace {

std::string folder_name(const std::filesystem::path& dir) {
    const std::filesystem::path whole = std::filesystem::absolute(dir).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

/// Without blanks and without what follows '#'.
std::string stripped(std::string_view line) {
    std::string text(line.substr(0, line.find('#')));
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '_'; });
    return text;
}

}  // namespace

RunFiles read_run_files(const std::filesystem::path& dir) {
    RunFiles run{.dir = dir,
                 .name = folder_name(dir),
                 .case_text = read_file(dir / "case.toml"),
                 .steps = read_table(dir / "steps.csv"),
                 .bodies = {},
                 .frames = read_pvd(dir / "frames.pvd")};
    if (std::filesystem::exists(dir / "bodies.csv")) run.bodies = read_table(dir / "bodies.csv");
    std::ranges::stable_sort(run.frames, {}, &SeriesEntry::time);
    return run;
}

std::optional<double> number_of_case(std::string_view case_text, std::string_view section,
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
        if (!inside || !line.starts_with(wanted)) continue;
        double value = 0;
        const char* last = line.data() + line.size();
        const auto [stop, error] = std::from_chars(line.data() + wanted.size(), last, value);
        if (error == std::errc() && stop == last) return value;
    }
    return {};
}

}  // namespace kropla
