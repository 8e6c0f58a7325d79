#pragma once

#include <kropla/base/vec3.h>

#include <string>

namespace kropla {

/// A unit for reading.
struct ScaledUnit {
    double scale = 1;  // value [SI] * scale = value in this unit
    std::string name;  // "mW", "µm", "mm³"
};
/// The unit in which a quantity of this size reads well, between 1 and 1000 (speeds 0.1 and 100) where there
/// is such a one. `si` is as columns have it: "m", "m/s", "m^3", "m^3/s", "J", "W", "N", "Pa", "s". Others,
/// as "K" and "", stay as they are.
[[nodiscard]] ScaledUnit unit_for(double size, const std::string& si);

/// A value in the unit that suits it: "12.5 mW", "0 J".
[[nodiscard]] std::string with_unit(double value, const std::string& si, int digits = 4);

/// With so many digits behind the point: "2399.58", "0.0" (never "-0.0").
[[nodiscard]] std::string fixed(double value, int decimals);
/// How many digits behind the point show that two values differ, and by how much: at most six.
[[nodiscard]] int decimals_to_tell(double a, double b);

/// A place in the unit that suits lengths of `size` [m], to a thousandth of it or so: "(0.0, 0.0, 13.0) mm".
[[nodiscard]] std::string place_with_unit(const Vec3& place, double size);

}  // namespace kropla
