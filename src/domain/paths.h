#pragma once

#include <kropla/base/watch.h>
#include <kropla/domain/words.h>

#include <vector>

namespace kropla {

struct PathOptions {
    double start = 0, end = 0;          // [s], start before end
    int steps = 1;                      // of equal length that are to be gone
    double near = 0;                    // [m]: nothing is told of what keeps farther apart
    double shortest = 0;                // [s] a step that is refused is not cut below
    std::vector<double> also_at = {};   // [s] times that the motions' formulas speak of
    const Watch* watch = nullptr;
};

struct PathLook {
    std::vector<Approach> closest;  // of each pair nearer than `near`, at its least gap; the narrowest first
    std::vector<std::size_t> too_fast;  // bodies that move to and fro faster than can be followed; in order
};

/// Looks at all bodies on their way: at the ends of the steps, at `also_at`, at up to 128 times in each step,
/// and between two of these by bisection until every body is within a twentieth of `size.surface` of where
/// the straight line between them has it, and goes less than half of it. So finds what lasts longer than 1/64
/// of a step (of larger parts where bodies times steps are above 1,600, at most a half), or begins or ends at
/// a time of `also_at`. Throws DomainError, saying which body, when, and how far, if a motion is not finite,
/// or jumps (by more than a tenth of size.surface within the rounding of t), or leaps (by more than ten
/// within `shortest`), or takes a body out of the box or into another.
[[nodiscard]] PathLook look_at_paths(const Domain& domain, const PathOptions& options);

}  // namespace kropla
