#pragma once

#include <kropla/base/watch.h>
#include <kropla/simulate/heat.h>

#include <span>
#include <string>
#include <vector>

namespace kropla {

/// A quantity that is the same everywhere and always: there is nothing to integrate.
struct Constant {
    double value;
    double operator()(const Vec3&, double) const { return value; }
};

/// Where a vertex goes, straight, during a step [m].
struct Way {
    Vec3 from, to;
};

/// The means over the step from t [s] to t + dt of a quantity at places that move. Whatever it does in between
/// counts: jumps at times that hold for several places are found to rounding and between them it is integrated
/// by Lobatto's rule, place by place, until the error is within 1e-10 of the largest value or a piece
/// is a millionth of the step. Up to 32 of the places, evenly among them, are looked at beforehand, eight of
/// them at 2048 times: what lasts shorter than that, or is shorter than a twentieth of the step and passes
/// places by that were not looked at, may be missed. Deterministic.
///
/// `key` is what the user calls the quantity: throws CaseError with it, place and time if a value is not finite;
/// Interrupted if the watch says so.
[[nodiscard]] std::vector<double> step_means(const Quantity& quantity, std::span<const Way> ways, double t,
                                             double dt, const std::string& key, const Watch* watch = nullptr);

/// The quantity's value; throws as above.
[[nodiscard]] double value_at(const Quantity& quantity, const Vec3& place, double t, const std::string& key);

}  // namespace kropla
