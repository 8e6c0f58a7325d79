#include "adapt/stepping.h"

#include <algorithm>

namespace kropla {

StepCost step_to(MovingMesh& moving, double t) {
    const double wanted = t - moving.time();
    Fields none;
    StepCost cost;
    for (double dt = wanted; t - moving.time() > 1e-9 * wanted; ++cost.accepted) {
        const Advanced done =
            advance(moving, none, std::min(dt, t - moving.time()), {}, {.least_dt = 1e-3 * wanted});
        dt = std::min(wanted, next_dt(done, dt));
        cost.attempts += done.attempts;
        cost.cpu_seconds += done.mesh_cpu_seconds;
        cost.wall_seconds += done.mesh_seconds;
        cost.changes += done.changes;
        cost.cells_touched += done.cells_touched;
    }
    return cost;
}

}  // namespace kropla
