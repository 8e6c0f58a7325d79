#pragma once

#include "adapt/moving_mesh.h"
#include "app/case.h"
#include "simulate/heat.h"
#include "transfer/transfer.h"

#include <vector>

namespace kropla {

/// All that a step changes, and nothing else: what a checkpoint keeps.
struct State {
    MovingMesh moving;
    std::vector<NodalField> fields;  // on moving.reference(); none if nothing is simulated
};

/// What an accepted step was and cost.
struct StepReport {
    double time = 0, dt = 0;  // reached [s], and how far it went
    int attempts = 0;
    Changes changes;          // of the mesh, at all stages of the accepted attempt
    double touched_fraction = 0;
    double kept_vertices = 0, kept_tets = 0;  // of those there are now, the share that was there before the step
    double mesh_seconds = 0, simulate_seconds = 0, transfer_seconds = 0;  // all attempts
    double mesh_cpu_seconds = 0;              // of all threads
    double energy = 0;              // [J] after the step
    double energy_before_transfer = 0;  // [J] before the last transfer of the step
    double energy_by_transfer = 0;      // [J] that the transfers of the step added
    TransferReport transfer;            // of all fields and transfers of the step
    double transferred_fraction = 0;    // [-] of the cells, that took part in the largest of them
    std::vector<double> heat_from_bodies = {};  // [W] through the surface of body 1, 2, ...
    std::string beyond_bounds = {};    // if the temperature is: how far and where
    std::string refused;               // why the last refused attempt was, if one was
};

struct StepOptions {
    double dt;                   // [s] wanted
    double least_dt;             // [s] below, the floors count as unreachable
    bool test_rollback = false;  // refuse the step once after it was computed, and do it again: the same to the bit
};

/// Takes the state one step on, by `dt` or as much of it as can be done: an attempt that is refused is tried
/// again with the mesh remeshed where it got stuck, then with half the way; so is one whose fields cannot be carried
/// with their integrals. On any exception the state is as it was.
/// Throws StuckError if the way left is below `least_dt`, SolverError if the solver does not converge, FieldError if
/// a field is not finite, Interrupted if the watch of the ranks says so (AllInterrupted if all ranks know).
[[nodiscard]] StepReport time_step(State& state, const Case& it, const Ranks& ranks,
                                   const StepOptions& options);

}  // namespace kropla
