#pragma once

#include <kropla/domain/words.h>

#include <optional>
#include <string>

namespace kropla {

/// Why a step is refused: what is wrong, where, and what would help.
struct Refusal {
    std::string why;  // a sentence: what is near what, when, what would do; the cell comes last
    Tet limiting;                      // in the current mesh; none if it is not a tet that stops the step
    double advised_dt = 0;             // [s] that would have been safe; 0: none is known
    std::optional<Vec3> place = {};    // [m] where it is; none: all over
    double time = 0;                   // [s] at which the step was to end
    std::optional<Approach> near = {};  // what leaves the least room there; nothing without bodies
    bool in_gap = false;                // that is why
};

/// A step that fails at one place.
struct Trouble {
    std::string fault;   // "would have R/r 10.1, limit 10"
    Tet cell;            // none: a prism
    Vec3 place;          // [m]
    double start = 0, time = 0;  // [s] of the step; equal: no step was tried yet
    double floor = 10;   // [-] the limit of R/r
};
/// Puts it into words: by the gap, if the place is in one that is narrower than its cells; else by how far
/// the body next to it goes in the step.
[[nodiscard]] Refusal explained(const Domain& domain, const Trouble& trouble, double advised_dt);

/// How long from `start` on, and not beyond `end` [s], the body and what it approaches keep a gap of `least`
/// [m]: 0 if they do not at the start. For a gap that narrows and does not open again in between.
[[nodiscard]] double time_until_gap(const Domain& domain, const Approach& approach, double start, double end,
                                    double least);

}  // namespace kropla
