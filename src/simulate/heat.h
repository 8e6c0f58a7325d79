#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/fields.h>
#include <kropla/simulate/material.h>
#include <kropla/simulate/material_flow.h>
#include <kropla/simulate/petsc.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kropla {

// The heat equation on a moving mesh, material by region:
//     rho c (dT/dt + u . grad T) = div(k grad T) + s.
//
// With the shape functions phi_i of tets and prisms (elements.h) that move with the mesh (velocity w), with
// div u = 0 (or see below), and with u.n = w.n where a region ends, it reads, region by region, in conservative form
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
// integral(grad Phi.grad phi_i) = F_i (material_flow.h). The flow's part of C is that same sum over the
// cells' points and makes up for F_i, exactly. Where the volume of a region changes, u has a divergence: material comes, of
// the enthalpy at the step's begin, or leaves, of that at its end, dt div u of each vertex's share.
//
// Where cells are too coarse for the convection, SUPG: the residual without diffusion (linear tets have none,
// prisms next to none), rho c (dT/dt + v.grad T) - s, is weighted with tau v.grad phi_i, v the mean of u - w
// over the cell. It is zero for a constant state and its weights sum to zero: both properties hold.
//
// Where a temperature would be a new extremum, cells are of low order (bounded.h): M lumped, no L, no SUPG.
//
// Where rho c depends on the temperature, or latent heat is taken up, M and C act on the enthalpy h(T) per volume
// instead of rho c T, and the step is repeated: h about the last temperatures by Newton's method (of a vertex's new
// temperature and what its new enthalpy makes, the one nearer to the last is taken), differences of h
// between corners by chords, k at the last temperatures, until these stay. What is kept is the integral of h, taken as
// linear between vertices. Radiation at boundaries likewise.
//
// Where the density of a gas that flows depends on the temperature (flow.h), h is per mass, and M, L and C are of the
// density, which is known: rho_j in M, the mean of the cell's vertices in the others. MaterialFlow then keeps what is
// constant per mass; what is kept is the integral of rho h, taken as linear between vertices.

/// How the material of a region moves.
enum class Carried {
    with_mesh,  ///< as its interface does: a body, which moves as a whole
    with_flow,  ///< as material_flow has it: at rest but for making way for bodies, or as it is told, or solved for
};

/// The temperature that a region begins with [K].
struct HeatStart {
    double value = 0;
    Quantity profile = {};  // if given, instead
    bool steady = false;    // the steady state that all regions with `steady` have together beside the others
    HeatStart(double number = 0) : value(number) {}  // NOLINT: a number is a start
    HeatStart(Quantity quantity) : profile(std::move(quantity)) {}  // NOLINT
};

struct HeatRegion {
    HeatMaterial material = {};
    Carried carried = Carried::with_flow;
    HeatStart initial = 0;
    Quantity source = {};   // [W/m^3]; empty: none
    Quantity power = {};    // [W] if given, `source` is scaled so that this is its integral over the region
    std::optional<double> held = {};  // [K] kept so everywhere in the region
    std::string name = {};  // for messages; empty: by its number
};

/// Heat that a surface gives to what is beyond it: coefficient (T - ambient) + emissivity sigma (T^4 - ambient^4),
/// per area. What is empty is none.
struct HeatExchange {
    Quantity coefficient = {};  // [W/(m^2 K)]
    Quantity emissivity = {};   // [-] 0 to 1
    Quantity ambient = {};      // [K] needed with either
};

struct HeatFace {
    enum class Kind { insulated, value, flux, exchange } kind = Kind::insulated;
    Quantity quantity = {};  // the value [K], or the flux into the domain [W/m^2]
    HeatExchange exchange = {};
    Quantity power = {};     // [W] if given, the flux is scaled so that this comes in
};

/// What happens at the surface of a body, besides conduction through it.
struct HeatSurface {
    Quantity flux = {};   // [W/m^2] set free there
    std::vector<double> at_vertices = {};  // [W/m^2] more of it, at each vertex of the surface, in order
    Quantity power = {};  // [W] if given, the flux is scaled so that this is set free
    HeatExchange exchange = {};
};

struct HeatOptions {
    std::vector<HeatRegion> regions;        // region 0 (the surroundings), 1, ...
    std::array<HeatFace, 6> faces = {};     // x min, x max, y min, y max, z min, z max
    std::vector<HeatSurface> surfaces = {}; // of bodies 1, 2, ...; fewer: none of the others
    std::string key = "heat";               // of what messages speak
};

/// What messages call a region, "heat.region.droplet", a body's surface, "heat.surface.droplet", and a face of the box,
/// "heat.face.z_min".
[[nodiscard]] std::string region_key(const HeatOptions& options, std::size_t region);
[[nodiscard]] std::string surface_key(const HeatOptions& options, std::size_t region);
[[nodiscard]] std::string face_key(const HeatOptions& options, std::size_t face);

/// Throws CaseError, naming the key below `heat`, if a material is not positive (at any temperature of a table), an
/// initial value not finite, solidus not below liquidus, a face without its quantity, or a region of the mesh without
/// its material.
void check_heat(const HeatOptions& options, const Mesh& mesh);

/// Are enthalpies multiples of the temperature in all regions? Then a transfer of the temperature, weighted by
/// `capacities`, keeps the energy; else the enthalpies are to be carried.
[[nodiscard]] bool proportional(const HeatOptions& options);
/// Of each region [J/(m^3 K)], where they are.
[[nodiscard]] std::vector<double> capacities(const HeatOptions& options);

/// Is the steady state of the regions that begin with one unique? Where the domain is in one piece it is if anything in it
/// says how warm it is: a region that begins otherwise, a face with values, a surface or face that exchanges heat.
[[nodiscard]] bool has_steady_state(const HeatOptions& options);

/// "temperature" [K], as each region begins; a body's at its surface. Throws as step_heat where it is a steady state, and
/// CaseError if there is none or more than one, in any piece of the domain.
[[nodiscard]] NodalField initial_temperature(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options);
/// Where no region begins with a steady state.
[[nodiscard]] NodalField initial_temperature(const Mesh& mesh, const HeatOptions& options);

/// The heat that leaves a body through its surface in a step, in the mean over the step, positive out of it.
/// `total` * dt is, to the solver's tolerance, what the body's energy fell by and what sources, the surface itself, faces of the
/// box and expansion brought.
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
/// before it, of values at faces and of what surfaces exchange heat with; none (infinite) on the side to which sources
/// or fluxes act.
struct HeatExtremes {
    Extreme least, most;
    double lower = 0, upper = 0;  // [K]
};

/// Where the energy of a step came from [J]. What is not there is zero.
struct HeatBalance {
    double before = 0, after = 0;      // the energy at its begin and end
    std::array<double, 6> faces = {};  // in through each face
    std::vector<double> surfaces;      // set free at the surface of body 1, 2, ..., less what it gave away
    std::vector<double> sources;       // in each region
    std::vector<double> held;          // brought to keep each region as it is held
    std::vector<double> expansion;     // with the material of each region by which its volume changes

    [[nodiscard]] double brought() const;
    [[nodiscard]] double error() const { return after - before - brought(); }
};

struct HeatReport {
    int iterations = 0;            // for the temperature
    int passes = 0;                // systems solved: several where something is not linear, or bounds were broken
    std::size_t diffused = 0;      // vertices whose cells had to be of low order
    double error = 0;              // [-] of the solution, as solver.h has it: the backward error by vertices
    int potential_iterations = 0;  // for the flow that makes way for the bodies
    std::vector<SurfaceFlux> surfaces;  // of bodies 1, 2, ...
    HeatExtremes extremes = {};
    HeatBalance balance = {};
};

/// Takes the temperature from t [s] on `before` to t + dt on `current`: the same connectivity. At a vertex of
/// several faces with values, the first of them holds; a region that is held comes before them. All ranks call it
/// together with the same arguments, and all get the whole field. The solver's options are -ksp_type, -ksp_rtol,
/// -pc_type and so on. Throws CaseError as check_heat, or if dt is not positive, a quantity not finite or a power
/// without a place to go; SolverError if the solver does not converge, or what is not linear does not settle;
/// Interrupted if the watch of the ranks says so. Then `temperature` is untouched.
HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     NodalField& temperature, double t, double dt);

/// The same in a flow that is known, as `material_flow` gives it for the regions that are `with_flow`. At faces of the box it
/// brings in what is there: the face's value, or else the temperature that the face had at the step's begin. Where the step
/// is not linear, a guess of the temperature at its end saves passes.
HeatReport step_heat(const Ranks& ranks, const Mesh& before, const Mesh& current, const HeatOptions& options,
                     const MaterialFlow& flow, NodalField& temperature, double t, double dt,
                     const Array<Vertex, double>& guess = {});

/// The regions whose material moves like that.
[[nodiscard]] std::vector<Region> regions_that(Carried move, const HeatOptions& options);

/// A region whose density is known at its vertices [kg/m^3] (MaterialFlow): its enthalpy is that times the one per mass.
struct KnownDensity {
    Region region = {};  // none
    Array<Vertex, double> values = {};
};

/// Brings temperatures that a transfer left beyond `least` and `most` [K] back to them, and what this takes comes from
/// vertices around (bounded.h): the energy stays. Where enthalpies are proportional. All ranks call it together.
void keep_within(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, double least, double most,
                 Array<Vertex, double>& temperature);

/// The same of enthalpies per volume of each region, back to what they are at `least` and `most` [K].
void keep_within(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, double least, double most,
                 std::vector<Array<Vertex, double>>& enthalpies, const KnownDensity& known = {});

/// The energy [J], of all regions or of one: the integral of the enthalpy.
[[nodiscard]] double energy(const Mesh& mesh, const HeatOptions& options, const Array<Vertex, double>& temperature,
                            Region only = {}, const KnownDensity& known = {});

/// The enthalpy of each region [J/m^3] at its vertices; elsewhere zero.
[[nodiscard]] std::vector<Array<Vertex, double>> enthalpies(const Mesh& mesh, const HeatOptions& options,
                                                            const Array<Vertex, double>& temperature,
                                                            const KnownDensity& known = {});
/// The energy that these hold [J].
[[nodiscard]] double energy_of(const Mesh& mesh, const std::vector<Array<Vertex, double>>& enthalpies);
/// The temperature that these enthalpies make: at an interface the one with which both sides together hold what they
/// do. Vertices without cells keep what `temperature` has.
void temperature_of(const Mesh& mesh, const HeatOptions& options, const std::vector<Array<Vertex, double>>& enthalpies,
                    Array<Vertex, double>& temperature, const KnownDensity& known = {});

}  // namespace kropla
