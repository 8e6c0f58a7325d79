#pragma once

#include <kropla/domain/domain.h>

#include <string>

// How refusals speak of quantities, bodies and walls.

namespace kropla {

/// The value with three digits and its unit, "0.0625 m".
[[nodiscard]] std::string written(double value, const char* unit);
[[nodiscard]] std::string written(double value);  ///< of what has no unit
[[nodiscard]] inline std::string metres(double value) { return written(value, "m"); }
/// A time [s] with up to six digits in the unit in which it is easy to read, "1.2 ms".
[[nodiscard]] std::string time_words(double seconds);
/// "(0.001, 0, 0.0024) m"
[[nodiscard]] std::string place_words(const Vec3& place);

/// `value` > 0 with two digits, rounded down: what is advised shall really do.
[[nodiscard]] double rounded_down(double value);

/// "body "droplet""
[[nodiscard]] std::string named(const Body& body);
/// "the wall z min", of the face of the box 0 ... 5; or "the fixed walls"
[[nodiscard]] std::string wall_name(int wall);

/// Two things that come near each other: a body, and a face of the box or another body.
struct Approach {
    std::size_t body = 0;
    int wall = -1;          // the face of the box, 0 ... 5, or the fixed walls; -1: it is another body
    std::size_t other = 0;  // that body
    double gap = 0;         // [m] between the surfaces; 0 if they touch or overlap
    double time = 0;        // [s] when it is so
};
/// "body "droplet" is 0.0625 m from the wall y min", or "body "a" and body "b" are 0.0625 m apart"
[[nodiscard]] std::string in_words(const Domain& domain, const Approach& approach);

}  // namespace kropla
