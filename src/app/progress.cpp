#include "app/progress.h"

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
    constexpr std::array<std::pair<double, std::string_view>, 4> units = {
        {{1, "s"}, {1e-3, "ms"}, {1e-6, "us"}, {1e-9, "ns"}}};
    const double size = std::abs(seconds);
    const auto fits = [&](const auto& unit) { return size >= 0.9995 * unit.first; };
    const auto unit = size == 0 ? units.begin() : std::ranges::find_if(units, fits);
    const auto [scale, name] = unit == units.end() ? units.back() : *unit;
    const double value = seconds / scale;
    const int decimals = std::abs(value) < 9.995 ? 2 : std::abs(value) < 99.95 ? 1 : 0;
    return fmt::format("{:.{}f} {}", value, decimals, name);
}

std::string clock_time(double seconds) {
    const long whole = std::lround(std::clamp(seconds, 0.0, 3.6e8));
    const long hours = whole / 3600, minutes = whole / 60 % 60;
    return hours > 0 ? fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60)
                     : fmt::format("{}:{:02}", minutes, whole % 60);
}

std::string progress_line(const ProgressRow& row) {
    const std::string steps = fmt::format("{}", row.steps);
    const std::string heat = row.heat_seconds ? fmt::format("  heat {:5.2f} s", *row.heat_seconds) : "";
    return fmt::format(
        "step {:>{}}/{}  t {:>7}  worst R/r {:4.1f}  {:<8}  touched {:4.1f} %  mesh {:5.2f} s{}  left {}",
        row.step, steps.size(), steps, spoken_time(row.time), row.worst_aspect_ratio, row.rung,
        100 * row.touched_fraction, row.mesh_seconds, heat, clock_time(row.seconds_left));
}

Progress::Progress(std::FILE* out) : out_(out), terminal_(columns(out) > 0) {}
Progress::~Progress() { finish(); }

void Progress::show(const ProgressRow& row) {
    std::string line = progress_line(row);
    if (!terminal_) {
        fmt::print(out_, "{}\n", line);
        std::fflush(out_);
        return;
    }
    if (const std::size_t width = columns(out_); width > 1) line.resize(std::min(line.size(), width - 1));
    const std::size_t rest = standing_ > line.size() ? standing_ - line.size() : 0;
    fmt::print(out_, "\r{}{:{}}", line, "", rest);  // blanks over what was longer
    std::fflush(out_);
    standing_ = line.size();
}

void Progress::finish() {
    if (standing_ == 0) return;
    fmt::print(out_, "\n");
    std::fflush(out_);
    standing_ = 0;
}

}  // namespace kropla
