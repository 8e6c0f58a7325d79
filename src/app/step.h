#pragma once

#include "app/body_state.h"
#include "case/case.h"
#include <kropla/simulate/fields.h>
#include "simulate/partition.h"
#include <kropla/step/advance.h>

#include <string>
#include <vector>

namespace kropla {

/// All that a step changes, and nothing else: what a checkpoint keeps.
struct State {
    MovingMesh moving;
    std::vector<NodalField> fields;  // on moving.reference(): temperature, species, flow, of those that are simulated
    std::vector<FreeState> free;     // per body: how it goes on, if it goes where forces take it
};

/// Something that a user should hear of, once.
struct StepWarning {
    std::string about;  // what is not to be said twice
    std::string text;
};

/// What an accepted step was and cost, and what it found.
struct StepReport {
    Advanced mesh;
    HeatReport heat;                     // if heat is simulated
    std::vector<SpeciesReport> species;  // of each
    FlowReport flow;                     // if it is simulated, of
    int rounds = 0;                      // solutions for it, until free bodies went where it took them
    std::vector<BodyState> bodies;       // at its end
    std::vector<double> gains;           // [m^3] of the bodies' volumes in it
    std::vector<Vec3> velocities;        // [m/s] of the bodies' centroids, in the mean over it
    std::vector<Vec3> spins;             // [rad/s] of the bodies at its end, if there is a flow
    ContactReport contact;               // if the case has contacts
    std::vector<StepWarning> warnings;
};

[[nodiscard]] AdaptOptions adapt_options(const Case& given, const Watch* watch = nullptr);

struct StepOptions {
    double dt;        // [s] wanted
    double least_dt;  // [s] below, the floors count as unreachable
};

/// Takes the state one step on, by `dt` or as much of it as can be done (`advance`), with what the case simulates. On any
/// exception the state is as it was. Throws what `advance` does, SolverError if the solver does not converge,
/// AllInterrupted if all ranks know that a watch says stop.
[[nodiscard]] StepReport time_step(State& state, const Case& given, const Ranks& ranks, const StepOptions& options);

/// Does all of such a step, and takes it back when nothing is left to do but to accept it.
void take_step_back(State& state, const Case& given, const Ranks& ranks, const StepOptions& options);

}  // namespace kropla
