#pragma once

#include <kropla/adapt/moving_mesh.h>
#include <kropla/domain/domain.h>

#include <vector>

namespace kropla {

/// What takes a body from where its motion says to where it really is: turned further about its centre, then displaced.
using Correction = Pose;

/// From `planned` to `real`.
[[nodiscard]] Correction correction(const Pose& planned, const Pose& real);

/// A step of a body over [t0, t1] [s] that a solver has told otherwise than its motion says.
struct CorrectedStep {
    Correction from, to;
    double t0, t1;
};
/// The motion with the correction that it has at t0, and all along the step to that at t1: evenly in displacement and
/// angle; before and after as at the ends.
[[nodiscard]] Motion corrected(Motion planned, const CorrectedStep& step);

/// The motions of bodies as they were asked for, and how far each body is from it.
struct PlannedMotions {
    PlannedMotions(const Domain& domain, double t);
    /// At t [s] a body stands there, and its motion in the domain goes on from it.
    void correct(Domain& domain, const BodyPlace& place, double t);

    std::vector<Motion> motion;
    std::vector<CorrectedStep> corrected;  // per body: the last step that was told otherwise
};

}  // namespace kropla
