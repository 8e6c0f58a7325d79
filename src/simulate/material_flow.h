#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/flow.h>
#include <kropla/simulate/petsc.h>

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace kropla {

struct Pattern;

/// What a step of a flow found (flow.h).
struct SolvedFlow {
    Array<Vertex, Vec3> velocity = {};  // [m/s] at the step's end; empty: at rest
    // Where the density depends on the temperature: at the step's begin and end [kg/m^3], and what passed the faces.
    Array<Vertex, double> density_before = {}, density = {};
    std::vector<FaceMass> through = {};
    std::array<bool, 6> open = {};  // faces: the velocity is of one time, the mesh's motion of the step; what they
                                    //   differ by passes these
};
/// How the material of a region moves, where that is told: a body that deforms as it is told, or comes in through a face.
struct ToldFlow {
    Region region;
    Array<Vertex, Vec3> velocity;         // [m/s] the mean over the step, at the region's vertices
    Array<Vertex, double> expansion = {};  // [1/s] its divergence; empty: none
};
/// How the material of regions that do not go with the mesh flows during a step: u = velocity + grad Phi.
struct MaterialFlow {
    /// What passes a face of the box at a vertex: the integral of phi_i u.n, n out of the box.
    struct Through {
        Vertex vertex;
        Region region;
        std::size_t face;
        double rate;  // [m^3/s], or [kg/s] in the region that is carried by its mass
    };
    Array<Region, Array<Vertex, double>> potential;  // Phi [m^2/s]; empty where nothing flows
    Array<Vertex, Vec3> velocity = {};               // [m/s] that was solved for; empty: none
    Array<Region, Array<Vertex, Vec3>> told = {};      // [m/s] instead of it, in regions that have it
    /// div u [1/s], where it is not zero: more of the material comes, as it was at the step's begin, or some leaves, as it
    /// is. In the region that is carried by its mass: what that grows by, per mass.
    Array<Region, Array<Vertex, double>> expansion = {};
    std::vector<Through> through = {};
    Region by_mass = {};  // whose density depends on the temperature: what is carried there is per mass
    Array<Vertex, double> density_before = {}, density = {};  // of it [kg/m^3], at the step's begin and end
    int iterations = 0;  // of the solver; 0 if nothing had to be solved
    /// Of all cells of the mesh that it was solved on, for what else is solved there; empty if nothing had to be.
    std::shared_ptr<const Pattern> pattern = {};

    [[nodiscard]] bool expands(Region region) const {
        return as_size(region.value) < expansion.size() && !expansion[region].empty();
    }
    [[nodiscard]] const Array<Vertex, Vec3>& velocity_in(Region region) const {
        return as_size(region.value) < told.size() && !told[region].empty() ? told[region] : velocity;
    }
};

/// The least flow of an incompressible gas beside what `solved` has which makes way for bodies during the step
/// from `before` to `current` (the same connectivity, dt [s] apart), in each region of `flowing` by itself, such that no
/// gas passes the region's moving boundary, but the faces of the box as `solved` or `told` has it. Where nothing moves, u is
/// exactly zero. A region may be in pieces that do not meet.
///
/// In the weak form, with the region's shape at the end of the step, v the velocity and w that of the mesh,
///     sum_j A_ij Phi_j = F_i + Q_i - integral of grad phi_i . v - integral of phi_i div u,
///     A_ij = integral of grad phi_i . grad phi_j,
///     F_i = the mean over the step of the integral of phi_i w.n over its boundary (n out of the region),
///     Q_i = the integral of phi_i v.n over faces of the box,
/// so that F_i is what the surface sweeps, to rounding (see heat.h for what this is good for). A in prisms is
/// the sum over their points (elements.h), as is what the flow carries; so they agree, to rounding: what is carried by u
/// is conserved and a constant stays one, though a velocity of finite elements is solenoidal only in the mean. All F_i
/// of a piece together are the growth of its volume: zero if bodies keep theirs. If not, the divergence of u is that
/// growth, spread evenly over the piece: `expansion`, with which a constant stays one all the same. But where the piece
/// meets open faces, what is left over passes these, evenly.
///
/// In the regions of `told`, v is what is told, at faces of the box too, and the divergence of u what is told of it. What
/// is left over there, as surfaces are of facets, is more or less of what passes faces, or else an even divergence.
///
/// With a density, which the first of `flowing` then has, it is mass that is conserved in it, not volume: there A_ij is
/// of rho grad phi_i . grad phi_j, and the right side what makes, at each vertex,
///     m1_i - m0_i = dt (integral of rho (u - w) . grad phi_i - what passes faces),   m_i = integral of rho phi_i,
/// rho in the flux the mean of a cell's vertices at the end. So a state that is constant per mass stays constant.
/// Options of the solver: -potential_ksp_type and so on. Throws SolverError if it does not converge.
[[nodiscard]] MaterialFlow material_flow(const Ranks& ranks, const Mesh& before, const Mesh& current,
                                         const std::vector<Region>& flowing, double dt,
                                         const SolvedFlow& solved = {}, const std::vector<ToldFlow>& told = {});

}  // namespace kropla
