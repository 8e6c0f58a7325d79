#pragma once

#include <kropla/step/advance.h>

namespace kropla {

/// What it took to come to a wanted time, with the mesh alone.
struct StepCost {
    int attempts = 0, accepted = 0;  // one each, if nothing is refused
    double cpu_seconds = 0;          // [s] of all threads
    double wall_seconds = 0;
    Changes changes;                 // all that were accepted
    int cells_touched = 0;
};

/// Goes on to `t` [s]. Throws StuckError if less than a thousandth of the way can be gone at a time.
StepCost step_to(MovingMesh& moving, double t);

}  // namespace kropla
