#pragma once

#include "adapt/moving_mesh.h"

#include <cstdint>

namespace kropla {

// Steps as a run takes them, without its files: for tests of many steps and for benchmarks.

/// The mesh of the domain at t = 0 as a run begins: generated, improved, repaired, without free slots.
[[nodiscard]] Mesh starting_mesh(const Domain& domain, std::uint64_t seed, const AdaptOptions& options = {});

/// What it took to come to a wanted time.
struct StepCost {
    int attempts = 0, accepted = 0;  // one each, if nothing is refused
    double cpu_seconds = 0;          // [s] of all threads, for the mesh alone
    double wall_seconds = 0;
    Changes changes;                 // all that were accepted
    int cells_touched = 0;
};

/// Goes on to `t` [s]: a refused attempt is tried again with the mesh remeshed where it stuck, then with half the
/// way. Throws FloorError if less than a thousandth of the way can be gone at a time.
StepCost step_to(MovingMesh& moving, double t);

}  // namespace kropla
