#include <kropla/domain/words.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace kropla {

std::string written(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}
std::string written(double value, const char* unit) { return written(value) + ' ' + unit; }

std::string time_words(double seconds) {
    struct Unit {
        double size;  // [s]
        const char* name;
    };
    constexpr std::array units = {Unit{1, "s"}, Unit{1e-3, "ms"}, Unit{1e-6, "us"}, Unit{1e-9, "ns"}};
    const double size = std::abs(seconds);
    char text[60];
    for (const Unit& unit : units) {
        // The ten millionth is for a time that rounding has left just below the unit.
        if (size < unit.size * (1 - 1e-7) || size >= 1e4) continue;
        std::snprintf(text, sizeof text, "%.6g %s", seconds / unit.size, unit.name);
        return text;
    }
    std::snprintf(text, sizeof text, "%.6g s", seconds);
    return text;
}

std::string place_words(const Vec3& place) {
    char text[120];
    std::snprintf(text, sizeof text, "(%.5g, %.5g, %.5g) m", place.x, place.y, place.z);
    return text;
}

double rounded_down(double value) {
    constexpr double rounding = 1e-12;  // 0.12 that has become 0.11999...9 is not taken for 0.11
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    char text[40];  // so that it is the number that is read when it is written
    std::snprintf(text, sizeof text, "%.1e", std::floor(value / digit * (1 + rounding)) * digit);
    return std::strtod(text, nullptr);
}

std::string named(const Body& body) { return "body \"" + body.name + "\""; }

std::string wall_name(int wall) {
    if (wall == fixed_walls) return "the fixed walls";
    return std::string("the wall ") + "xyz"[wall / 2] + (wall % 2 == 0 ? " min" : " max");
}

std::string in_words(const Domain& domain, const Approach& approach) {
    const std::string body = named(domain.bodies[approach.body]);
    const bool is_wall = approach.wall >= 0;
    const std::string other = is_wall ? wall_name(approach.wall) : named(domain.bodies[approach.other]);
    if (approach.gap == 0) return is_wall ? body + " touches " + other : body + " and " + other + " touch or overlap";
    return is_wall ? body + " is " + metres(approach.gap) + " from " + other
                   : body + " and " + other + " are " + metres(approach.gap) + " apart";
}

}  // namespace kropla
