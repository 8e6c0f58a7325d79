#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/petsc.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace kropla {

struct Pattern;

/// How the material of regions that do not go with the mesh flows during a step: u = velocity + grad Phi.
struct MaterialFlow {
    /// What passes a face of the box at a vertex: the integral of phi_i u.n, n out of the box.
    struct Through {
        Vertex vertex;
        Region region;
        std::size_t face;
        double rate;  // [m^3/s]
    };
    Array<Region, Array<Vertex, double>> potential;  // Phi [m^2/s]; empty where nothing flows
    Array<Vertex, Vec3> velocity = {};               // [m/s] that was solved for; empty: none
    std::vector<Through> through = {};
    int iterations = 0;  // of the solver; 0 if nothing had to be solved
    /// Of all cells of the mesh that it was solved on, for what else is solved there; empty if nothing had to be.
    std::shared_ptr<const Pattern> pattern = {};
};

/// The least flow of an incompressible gas beside `velocity` (empty: at rest) which makes way for bodies during the step
/// from `before` to `current` (the same connectivity, dt [s] apart), in each region of `flowing` by itself, such that no
/// gas passes the region's moving boundary, but as `velocity` has it the faces of the box. Where nothing moves, u is
/// exactly zero. Each region is in one piece.
///
/// In the weak form, with the region's shape at the end of the step, v the velocity and w that of the mesh,
///     sum_j A_ij Phi_j = F_i + Q_i - integral of grad phi_i . v,   A_ij = integral of grad phi_i . grad phi_j,
///     F_i = the mean over the step of the integral of phi_i w.n over its boundary (n out of the region),
///     Q_i = the integral of phi_i v.n over faces of the box,
/// so that F_i is what the surface sweeps, to rounding (see heat.h for what this is good for). A in prisms is
/// the sum over their points (elements.h), as is what the flow carries; so they agree, to rounding: what is carried by u
/// is conserved and a constant stays one, though a velocity of finite elements is solenoidal only in the mean. All F_i
/// together are the growth of the region's volume: zero if bodies keep theirs. If not, gas has no way to go;
/// then the divergence of u is that growth, spread evenly. Options of the solver: -potential_ksp_type and so
/// on. Throws SolverError if it does not converge.
[[nodiscard]] MaterialFlow material_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                                         const std::vector<Region>& flowing, double dt,
                                         const Array<Vertex, Vec3>& velocity = {});

}  // namespace kropla
