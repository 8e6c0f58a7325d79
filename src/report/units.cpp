#include "report/units.h"

#include "report/svg.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace kropla {
namespace {

using Prefix = std::pair<double, const char*>;
constexpr std::array<Prefix, 8> prefixes = {
    {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}, {1e-12, "p"}}};
// Units of volume [m^3], and from how much of one it is taken: they are far apart.
struct CubicUnit {
    double size;
    const char* prefix;
    double least;
};
constexpr std::array<CubicUnit, 4> cubic_units = {
    {{1, "", 0.01}, {1e-6, "c", 0.9995}, {1e-9, "m", 1e-3}, {1e-18, "µ", 0}}};
constexpr std::array<const char*, 7> scaled = {"m", "m/s", "J", "W", "N", "Pa", "s"};

/// "m^3" as it is printed.
std::string printed(std::string si) {
    for (const auto& [power, sign] : {std::pair{"^3", "³"}, {"^2", "²"}})
        if (const std::size_t at = si.find(power); at != std::string::npos) si.replace(at, 2, sign);
    return si;
}

/// A volume, or one per second, "m³/s".
ScaledUnit cubic_unit_for(double size, const std::string& name) {
    const auto fits = [&](const CubicUnit& unit) { return size >= unit.least * unit.size; };
    const CubicUnit& unit = *std::ranges::find_if(cubic_units, fits);  // the last one fits
    return {1 / unit.size, unit.prefix + name};
}

}  // namespace

ScaledUnit unit_for(double size, const std::string& si) {
    const bool cubic = si == "m^3" || si == "m^3/s";
    const bool scales = cubic || std::ranges::find(scaled, si) != scaled.end();
    if (!scales || !(size > 0) || !std::isfinite(size)) return {1, printed(si)};
    if (cubic) return cubic_unit_for(size, printed(si));
    const double least = si == "m/s" ? 0.1 : 0.9995;  // 0.89 m/s is as good as any
    const bool only_small = si.starts_with("m") || si == "s";  // no Mm, no ks
    const auto fits = [&](const Prefix& prefix) {
        return !(only_small && prefix.first > 1) && size >= least * prefix.first;
    };
    const auto found = std::ranges::find_if(prefixes, fits);
    const Prefix& prefix = found == prefixes.end() ? prefixes.back() : *found;
    return {1 / prefix.first, prefix.second + printed(si)};
}

std::string with_unit(double value, const std::string& si, int digits) {
    const auto [scale, name] = unit_for(std::abs(value), si);
    return readable(value * scale + 0.0, digits) + (name.empty() ? "" : " " + name);
}

std::string fixed(double value, int decimals) {
    const double ten = std::pow(10.0, decimals);
    const double rounded = std::abs(value) * ten < 0.5 ? 0.0 : value;
    std::array<char, 400> text;  // as long as the largest number
    char* const end = text.data() + text.size();
    return {text.data(), std::to_chars(text.data(), end, rounded, std::chars_format::fixed, decimals).ptr};
}

int decimals_to_tell(double a, double b) {
    constexpr double same = 1e-9, most = 6;
    const double change = std::abs(a - b);
    if (!(change > same * std::max(std::abs(a), std::abs(b)))) return 0;
    return static_cast<int>(std::clamp(std::ceil(0.7 - std::log10(change)), 0.0, most));
}

std::string place_with_unit(const Vec3& place, double size) {
    const auto [scale, name] = unit_for(size, "m");
    const double largest = size * scale;
    const int decimals = largest >= 100 ? 0 : largest >= 10 ? 1 : 2;
    return "(" + fixed(place.x * scale, decimals) + ", " + fixed(place.y * scale, decimals) + ", " +
           fixed(place.z * scale, decimals) + ") " + name;
}

}  // namespace kropla
