#pragma once

#include <kropla/base/vec3.h>

#include <string_view>

namespace kropla {

/// The pressure that the weight of what flows makes where it is at rest; zero in the middle of the box.
struct Hydrostatic {
    Vec3 weight = {};  // [N/m^3]
    Vec3 middle = {};  // [m]
};
/// By a case as run; none without gravity.
[[nodiscard]] Hydrostatic hydrostatic(std::string_view case_text);

[[nodiscard]] inline bool is_there(const Hydrostatic& at_rest) { return squared_norm(at_rest.weight) > 0; }
[[nodiscard]] inline double pressure_at(const Hydrostatic& at_rest, const Vec3& x) {
    return dot(at_rest.weight, x - at_rest.middle);
}

}  // namespace kropla
