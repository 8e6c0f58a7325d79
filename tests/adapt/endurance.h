#pragma once

#include "adapt/stepping.h"

#include <functional>
#include <string>
#include <vector>

namespace kropla {

// Endurance: a droplet in a layer of prisms wanders among four bodies at rest, for as many steps as asked.

/// A smooth random walk within [-reach, reach] along each axis, from the origin, t in steps: per axis a sum of sines
/// with seeded frequencies and phases. Not periodic; the same on every machine but for the last bits of sines.
[[nodiscard]] Motion random_walk(double reach, std::uint64_t seed);

/// A droplet of radius 0.5 mm and four bodies of 0.4 mm at corners of a cube, in a box of 5.6 mm.
[[nodiscard]] Domain endurance_domain(std::uint64_t seed);

/// What has to hold at every step.
struct EnduranceBounds {
    double worst_aspect_ratio = 8;  // [-] R/r
    double count_change = 0.1;      // [-] of the cells at the start, up or down
    double growth = 1.2;            // [-] work per step: median of the last quarter against that of the first
};

struct EnduranceStep {
    int step = 0, cells = 0, attempts = 0, global_remeshes = 0, local_remeshes = 0, cells_touched = 0;
    double worst_aspect_ratio = 0;  // after the step
    double cpu_seconds = 0;         // [s] of mesh work
};

struct EnduranceReport {
    int cells_at_start = 0;
    std::vector<EnduranceStep> steps;
    std::string stuck;  // why it did not reach the last step, if so
};

/// Takes `steps` steps; `told` is called after each.
[[nodiscard]] EnduranceReport endure(int steps, std::uint64_t seed, const EnduranceBounds& bounds,
                                     const std::function<void(const EnduranceStep&)>& told = {});

/// The ratio of the medians of what `work` says of the steps, last quarter to first.
[[nodiscard]] double growth_of(const EnduranceReport& report, double (*work)(const EnduranceStep&));

/// The bounds that are broken, a line each, but for that of growth; empty: none.
[[nodiscard]] std::vector<std::string> broken_bounds(const EnduranceReport& report, const EnduranceBounds& bounds);

}  // namespace kropla
