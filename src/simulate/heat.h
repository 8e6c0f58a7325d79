#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/fields.h>
#include <kropla/simulate/petsc.h>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace kropla {

// The heat equation on a moving mesh, material by region:
//     rho c (dT/dt + u . grad T) = div(k grad T) + s.
//
// With the shape functions phi_i of tets and prisms (elements.h) that move with the mesh (velocity w), with
// div u = 0, and with u.n = w.n where a region ends, it reads, region by region, in conservative form
//     d/dt (M T)_i = integral(rho c T (u - w).grad phi_i) - integral(k grad T.grad phi_i) + load_i,
// M_ij = integral(rho c phi_i phi_j). A step by backward Euler:
//     M1 T1 - M0 T0 + L (T1 - T0 - moved.grad T1) = dt (C - K) T1 + dt load,
//     C_ij = mean over the step of integral(rho c phi_j (u - w).grad phi_i).
// First order in time, second in space. K and values at the boundary are taken at the step's end. Sources and
// fluxes act over the step: the load is of their means, each at the moving place of a vertex (step_mean.h), and
// nothing of them is lost between two ends.
//
// L, the lumped less the consistent mass (at the end), damps the wiggles that a consistent mass makes beside
// a jump; where the mesh rests, the two masses together are the lumped one, the integral of rho c phi_i per
// corner. It acts on what the material gains alone: `moved` is how far a vertex was moved past the material,
// and the bracket, with the mean gradient over the cell, is zero for a linear temperature that rests.
// (Lumping M itself would lose most of the convection where single vertices move.)
//
// It keeps energy: the phi_i sum to one, so that every column of C, K and L sums to zero, and the masses gain
// what the load brings. It keeps a constant state: for T = 1 the mesh's part of C and the change of mass
// leave
//     sum_j (M1 - M0)_ij + dt integral(rho c w.grad phi_i) = dt rho c F_i,
//     F_i = the integral of phi_i w.n over the region's boundary,
// an identity at every instant that holds for the step as well, since its integrals over space and its means
// over time are exact, in prisms too: with sum_j phi_j = 1 what is left under them are polynomials of so low
// a degree that the points of elements.h integrate them. The quads between prisms sweep what one gains and
// the other loses; so F_i is of triangles alone. A body moves as a whole; for one who goes with it u = 0, and
// w = 0 but for vertices that were moved inside the body; F_i = 0. Around bodies F_i is not zero, and gas at
// rest would go through their surface; instead it flows as they push it, u = grad Phi with
// integral(grad Phi.grad phi_i) = F_i (flow_potential.h). The flow's part of C is that same sum over the
// cells' points and makes up for F_i, exactly.
//
// Where cells are too coarse for the convection, SUPG: the residual without diffusion (linear tets have none,
// prisms next to none), rho c (dT/dt + v.grad T) - s, is weighted with tau v.grad phi_i, v the mean of u - w
// over the cell. It is zero for a constant state and its weights sum to zero: both properties hold.

/// A quantity at a place [m] and a time [s].
using Quantity = std::function<double(const Vec3& place, double t)>;

struct HeatMaterial {
    double conductivity = 1;   // [W/(m K)]
    double density = 1;        // [kg/m^3]
    double specific_heat = 1;  // [J/(kg K)]
};

/// How the material of a region moves.
enum class Carried {
    with_mesh,  ///< as its interface does: a body, which moves as a whole
    at_rest,    ///< it rests, but for making way for the bodies that move in it
};

struct HeatRegion {
    HeatMaterial material = {};
    Carried carried = Carried::at_rest;
    double initial = 0;    // [K]
    Quantity source = {};  // [W/m^3]; empty: none
    std::string name = {};  // for messages; empty: by its number
};

struct HeatFace {
    enum class Kind { insulated, value, flux } kind = Kind::insulated;
    Quantity quantity = {};  // the value [K], or the flux into the domain [W/m^2]
};

struct HeatOptions {
    std::vector<HeatRegion> regions;     // region 0 (the surroundings), 1, ...
    std::array<HeatFace, 6> faces = {};  // x min, x max, y min, y max, z min, z max
};

/// What messages call a region, "heat.region.droplet", and a face of the box, "heat.face.z_min".
[[nodiscard]] std::string region_key(const HeatOptions& options, std::size_t region);
[[nodiscard]] std::string face_key(std::size_t face);

/// Throws CaseError, naming the key below `heat`, if a material is not positive, an initial value not finite,
/// a face without its quantity, or a region of the mesh without its material.
void check_heat(const HeatOptions& options, const Mesh& mesh);

/// "temperature" [K], the initial value of each region; a body's at its surface.
[[nodiscard]] NodalField initial_temperature(const Mesh& mesh, const HeatOptions& options);

/// The heat that leaves a body through its surface in a step, in the mean over the step, positive out of it.
/// `total` * dt is, to the solver's tolerance, what the body's energy fell by, less what sources brought.
struct SurfaceFlux {
    Region body;
    double total = 0;              // [W]
    std::vector<Vertex> vertices;  // of the surface
    std::vector<double> density;   // [W/m^2] at each of them
};

/// A temperature and where it is.
struct Extreme {
    double value = 0;  // [K]
    Vec3 place = {};   // [m]
};

/// The coldest and hottest vertices after a step, and the bounds that conduction and convection keep: the extremes
/// before it and of values at faces; none (infinite) on the side to which sources or fluxes act.
struct HeatExtremes {
    Extreme least, most;
    double lower = 0, upper = 0;  // [K]
};

struct HeatReport {
    int iterations = 0;            // for the temperature
    double error = 0;              // [-] of the solution, as solver.h has it: the backward error by vertices
    int potential_iterations = 0;  // for the flow that makes way for the bodies
    std::vector<SurfaceFlux> surfaces;  // of bodies 1, 2, ...
    HeatExtremes extremes = {};
};

/// Takes the temperature from t [s] on `before` to t + dt on `current`: the same connectivity. At a vertex of
/// several faces with values, the first of them holds. All ranks call it together with the same arguments,
/// and all get the whole field. The solver's options are -ksp_type, -ksp_rtol, -pc_type and so on. Throws
/// CaseError as check_heat, or if dt is not positive or a quantity not finite; SolverError if the solver does
/// not converge, Interrupted if the watch of the ranks says so. Then `temperature` is untouched.
HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt);

/// The integral of rho c T [J], of all regions or of one.
[[nodiscard]] double energy(const Mesh& mesh, const HeatOptions& options,
                            const Array<Vertex, double>& temperature, Region only = {});

}  // namespace kropla
