#pragma once

#include <kropla/simulate/petsc.h>

#include <string>
#include <vector>

namespace kropla {

/// A value of the exact solution of a problem, and the one that was reached.
struct Reached {
    std::string what;  // "front [mm]"
    double exact, value;
    double scale = 0;  // to which the error is compared; 0: to `exact`

    [[nodiscard]] double error() const { return (value - exact) / (scale != 0 ? scale : exact); }
};

/// What came of a problem whose solution is known.
struct Outcome {
    std::string mesh, steps;  // in words, for the table
    std::vector<Reached> reached;
    double balance = 0;    // [-] the largest HeatBalance::error of a step, of |before| + |brought|
    int passes = 0;        // the largest number in a step
    double beyond = 0;     // [-] the farthest that a temperature was outside of those there are, of the range

    [[nodiscard]] double error() const;  // the largest
};

// Below, `fineness` 1 is what the tests take, 2 has cells half as large. Where it says "Richardson": twice what steps half
// as long lead to, less what the whole steps lead to; of the first order in time nothing is left.

/// Freezing from a wall 1 K below the melting point, in liquid that is at it; all properties one, L = 1/Ste.
[[nodiscard]] Outcome one_phase_stefan(const Ranks& ranks, double stefan_number, int fineness);

/// Freezing from a wall, in liquid that is warmer than its melting point.
struct TwoPhases {
    double conductivity_solid, conductivity_liquid;  // [W/(m K)]
    double heat_solid, heat_liquid;                  // [J/(kg K)]
    double density, latent_heat;                     // [kg/m^3], [J/kg]
    double wall, melting, initial;                   // [K]
    double time;                                     // [s] when it is looked at
};
inline constexpr TwoPhases unit_phases{1, 1, 1, 1, 1, 1, -1, 0, 1, 1};
inline constexpr TwoPhases iron_phases{30, 35, 750, 825, 7200, 2.47e5, 1000, 1800, 2000, 0.1};
[[nodiscard]] Outcome two_phase_stefan(const Ranks& ranks, const TwoPhases& material, int fineness);

/// A ball that freezes outwards around a sink of heat in its middle that grows as the square root of time, in liquid that
/// is warmer than its melting point; the middle is left out, at values of the exact solution.
[[nodiscard]] Outcome freezing_ball(const Ranks& ranks, int fineness);

/// A sphere at 1 K that exchanges heat with surroundings at 0, by its Biot number, at Fo = 0.2 and 0.5. Richardson.
[[nodiscard]] Outcome robin_sphere(const Ranks& ranks, double biot, int fineness);

/// A sphere at 1 K in an infinite medium at 0 of the same diffusivity, and as much or a tenth of its conductivity, at
/// Fo = 0.1 and 0.2. Richardson.
[[nodiscard]] Outcome sphere_in_like_medium(const Ranks& ranks, int fineness);
[[nodiscard]] Outcome sphere_in_poor_medium(const Ranks& ranks, int fineness);

/// A flux of Gauss's shape on a half-space, at rest and moving. Richardson.
[[nodiscard]] Outcome resting_source(const Ranks& ranks, double time, int fineness);
[[nodiscard]] Outcome moving_source(const Ranks& ranks, double time, int fineness);

/// A sphere with a constant flux into its surface, at Fo = 0.1 and 0.5. Richardson.
[[nodiscard]] Outcome heated_sphere(const Ranks& ranks, int fineness);

/// A sphere that conducts so well that it is of one temperature, and radiates, at 2400 K to surroundings at 0 and at 600 K.
/// Richardson.
[[nodiscard]] Outcome radiating_sphere(const Ranks& ranks, double ambient, int fineness);

}  // namespace kropla
