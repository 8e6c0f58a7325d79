#include "app/progress.h"

#include "report/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <sys/ioctl.h>

namespace kropla {
namespace {

/// Characters on a line of the terminal; 0 if it does not tell or is none. mpirun gives its first process one
/// of no width, whatever its own output goes to.
std::size_t columns(std::FILE* out) {
    winsize size{};
    return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace

std::string spoken_time(double seconds) {
    constexpr std::array<std::pair<double, std::string_view>, 10> units = {{{31556952, "yr"},
                                                                           {86400, "d"},
                                                                           {3600, "h"},
                                                                           {60, "min"},
                                                                           {1, "s"},
                                                                           {1e-3, "ms"},
                                                                           {1e-6, "us"},
                                                                           {1e-9, "ns"},
                                                                           {1e-12, "ps"},
                                                                           {1e-15, "fs"}}};
    constexpr double three_digits = 999.5;
    const double size = std::abs(seconds);
    if (size == 0) return "0.00 s";
    // Up to seconds a unit begins at one of it; minutes and longer where the one below has no digits left.
    const auto fits = [&](const auto& unit) {
        const auto& [scale, name] = unit;
        return scale <= 1 ? size >= 0.9995 * scale : size >= three_digits * (&unit + 1)->first;
    };
    const auto unit = std::ranges::find_if(units, fits);
    if (unit == units.end() || size >= three_digits * unit->first) return fmt::format("{:.2e} s", seconds);
    const double value = seconds / unit->first;
    const int decimals = std::abs(value) < 9.995 ? 2 : std::abs(value) < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f} {}", value, decimals, unit->second);
}

std::string clock_time(double seconds) {
    const long whole = std::lround(std::clamp(seconds, 0.0, 3.6e8));
    const long hours = whole / 3600, minutes = whole / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                     : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string spoken_count(double count) {
    std::string text = fmt::format("{:.0f}", count);
    for (std::ptrdiff_t i = std::ssize(text) - 3; i > 0; i -= 3) text.insert(static_cast<std::size_t>(i), 1, ',');
    return text;
}

std::string plain(std::string text) {
    for (const std::string_view micro = "µ"; text.find(micro) != std::string::npos;)
        text.replace(text.find(micro), micro.size(), "u");
    return text;
}

std::string spoken_quantity(double value, const char* si) { return plain(with_unit(value, si, 3)); }

std::string progress_line(const ProgressRow& row) {
    const std::string steps = fmt::format("{}", row.steps);
    const auto seconds = [](const char* what, const std::optional<double>& spent) {
        return spent ? fmt::format("  {} {:5.2f} s", what, *spent) : "";
    };
    const std::string simulation = seconds("heat", row.heat_seconds) + seconds("flow", row.flow_seconds);
    return fmt::format(
        "step {:>{}}/{}  t {:>7}  worst R/r {:4.1f}  {:<8}  touched {:4.1f} %  mesh {:5.2f} s{}{}  left {}",
        row.step, steps.size(), steps, spoken_time(row.time), row.worst_aspect_ratio, row.rung,
        100 * row.touched_fraction, row.mesh_seconds, simulation,
        row.bodies.empty() ? "" : "  " + row.bodies, clock_time(row.seconds_left));
}

Progress::Progress(std::FILE* out) : out_(out), terminal_(columns(out) > 0) {}
Progress::~Progress() { finish(); }

void Progress::show(const ProgressRow& row) {
    if (terminal_) write_over(progress_line(row));
    else say(progress_line(row));
}

void Progress::show_stage(std::string_view stage, double share) {
    using namespace std::chrono_literals;
    const bool is_new = stage != stage_;
    const auto now = std::chrono::steady_clock::now();
    if (!is_new && (!terminal_ || now < stage_shown_ + 100ms)) return;
    stage_ = stage;
    stage_shown_ = now;
    if (terminal_) write_over(fmt::format("initial mesh: {:<16} {:3.0f} %", stage, 100 * share));
    else say(fmt::format("initial mesh: {}", stage));
}

void Progress::say(std::string_view line) {
    finish();
    print(fmt::format("{}\n", line));
}

void Progress::write_over(std::string line) {
    if (const std::size_t width = columns(out_); width > 1) line.resize(std::min(line.size(), width - 1));
    const std::size_t rest = standing_ > line.size() ? standing_ - line.size() : 0;
    print(fmt::format("\r{}{:{}}", line, "", rest));  // blanks over what was longer
    standing_ = line.size();
}

void Progress::finish() {
    if (standing_ == 0) return;
    print("\n");
    standing_ = 0;
}

void Progress::print(std::string_view text) {
    std::fwrite(text.data(), 1, text.size(), out_);
    std::fflush(out_);
}

}  // namespace kropla
