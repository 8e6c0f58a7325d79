#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/petsc.h>

#include <vector>

namespace kropla {

struct DisplacedFlow {
    Array<Region, Array<Vertex, double>> potential;  // [m^2/s] u = grad Phi; empty where nothing flows
    int iterations = 0;                              // of the solver; 0 if nothing had to be solved
};

/// The least flow of an incompressible gas, at rest but for the bodies that move in it, which makes way for
/// them during the step from `before` to `current` (the same connectivity, dt [s] apart): u = grad Phi, in
/// each region of `resting` by itself, such that no gas passes the region's moving boundary. Where that
/// boundary stands still, u is exactly zero. Each region is in one piece.
///
/// In the weak form, with the region's shape at the end of the step and w the velocity of the mesh,
///     sum_j A_ij Phi_j = F_i,   A_ij = integral of grad phi_i . grad phi_j over the region,
///     F_i = the mean over the step of the integral of phi_i w.n over its boundary (n out of the region),
/// so that F_i is what the surface sweeps, to rounding (see heat.h for what this is good for). A in prisms is
/// the sum over their points (elements.h), as is what the flow carries; so they agree, to rounding. All F_i
/// together are the growth of the region's volume: zero if bodies keep theirs. If not, gas has no way to go;
/// then the divergence of u is that growth, spread evenly. Options of the solver: -potential_ksp_type and so
/// on. Throws SolverError if it does not converge.
[[nodiscard]] DisplacedFlow solve_displaced_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                                                 const std::vector<Region>& resting, double dt);

}  // namespace kropla
