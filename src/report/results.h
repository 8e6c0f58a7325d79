#pragma once

#include <kropla/base/vec3.h>
#include "report/run_files.h"

#include <optional>
#include <string>
#include <vector>

namespace kropla {

/// What came out for a body. Vectors have a value per step; those of heat are empty where none is simulated.
struct BodyResult {
    std::string name;                   // as the case has it; of older runs, as columns have it
    std::vector<Vec3> place, velocity;  // [m] of the centroid, [m/s]
    std::vector<double> volume;         // [m^3]
    std::vector<Vec3> force = {}, spin = {};  // [N] of the flow, [rad/s]; empty without one
    std::vector<double> gap = {};             // [m] to what is nearest; empty if it may not touch anything
    std::vector<Vec3> contact_force = {};     // [N] likewise
    std::vector<double> coldest = {}, mean = {}, hottest = {};  // [K]
    std::vector<double> heat_from = {};           // [W] conducted out through its surface
    double given_off = 0;                         // [J] of that, over the run
    Vec3 start_place = {};                        // [m]; where bodies.csv does not tell, of the first step
    std::optional<double> start_mean = {};        // [K] likewise
    std::optional<double> least = {}, most = {};  // [K] of the run
};
/// The largest of its coordinates on its way, or its size if that is larger [m].
[[nodiscard]] double length_scale(const BodyResult& body);
/// Does it move at all, by more than rounding?
[[nodiscard]] bool moves(const BodyResult& body);

/// The heat, or the volume of a flow, that leaves through a face of the box.
struct FaceResult {
    std::string name;         // "x_min"
    std::vector<double> out;  // [W] or [m^3/s] per step
    double total = 0;         // [J] or [m^3] over the run
};

/// Where the energy of a run came from and went [J].
struct EnergyBalance {
    double start = 0, end = 0;                              // stored
    std::vector<double> stored;                             // after each step
    double faces = 0, sources = 0, surfaces = 0, held = 0, expansion = 0;  // brought in by each
    double size = 0;  // the largest that was stored at any time or has passed: what an error is compared with

    [[nodiscard]] double brought() const { return faces + sources + surfaces + held + expansion; }
    [[nodiscard]] double error() const { return end - start - brought(); }
    [[nodiscard]] double relative_error() const { return size > 0 ? error() / size : 0; }
};

/// What is known of a flow as a whole. Vectors have a value per step.
struct FlowResult {
    std::vector<FaceResult> faces;                   // all six
    double flux_size = 0;  // [m^3/s] the largest that flows: with it faces are compared
    std::vector<double> courant;                     // [-]
    std::vector<double> passes, iterations, rounds;  // as in steps.csv
    double mass_missed = 0;                          // [kg] in all steps, by size
    std::optional<double> mass = {};  // [kg] of what flows, at the start; if the case tells its density
};

/// Below this share of what it is compared with, a figure of a run is rounding: single errors are some 1e-16, and add
/// up over vertices and steps.
inline constexpr double rounding_share = 1e-11;
/// Is it nothing but rounding, compared with `size`?
[[nodiscard]] bool is_rounding(double value, double size);

/// Below this share of the vector they belong to, components and spins are what the mesh makes of zero: they
/// are not shown as results.
inline constexpr double notable_share = 0.02;
/// The axes along which vectors of a run have more than that of their largest.
[[nodiscard]] std::vector<int> notable_axes(const std::vector<Vec3>& vectors);
/// Their sizes.
[[nodiscard]] std::vector<double> sizes(const std::vector<Vec3>& vectors);
/// Does it turn, so that its surface goes faster for it than what its speed makes of zero?
[[nodiscard]] bool turns(const BodyResult& body);

/// What came out of a run, from its steps.
struct RunResults {
    std::vector<double> time;  // [s] per step
    bool start_known = false;  // else the first step stands for the start
    std::vector<BodyResult> bodies;
    std::vector<FaceResult> faces;  // all six with their heat, or none
    std::optional<EnergyBalance> energy;
    std::optional<FlowResult> flow = {};
    std::vector<double> contacts = {};  // per step: pairs of bodies, or body and wall, that touched; empty if none may
};
/// Runs of older versions lack columns: what they would tell is not there. Throws FileError if a cell is no number.
[[nodiscard]] RunResults results_of(const RunFiles& run);

}  // namespace kropla
