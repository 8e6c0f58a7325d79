#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/fields.h>
#include <kropla/simulate/material.h>
#include <kropla/simulate/petsc.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kropla {

// The incompressible Navier-Stokes equations on a moving mesh, material by region:
//     rho (du/dt + (u - w) . grad u) = div(-p + mu (grad u + grad u^T)) + rho g + f,    div u = 0,
// du/dt at a vertex that moves with the mesh's velocity w, in the non-conservative form, which keeps a
// uniform flow on any moving mesh. Velocity and pressure are linear in tets, and linear along and across
// columns in prisms, stabilised by the residual: SUPG, PSPG and grad-div (flow_cell.cpp). Density, viscosity
// and the stabilisation's times are of one region each; at interfaces of liquids and gases the velocity is
// continuous, and the pressure is once per side, so that it may jump. Surface tension acts there (tension.h).
// The surface of a liquid goes with the flow: where the mesh has it elsewhere at the step's end, the tension is that
// of the place where the flow takes it, in linear terms, and the report says where that is.
//
// A gas whose density depends on the temperature expands where it is heated, at the pressure that is around: slowly
// against sound, which is left out. In place of div u = 0 comes
//     d rho/dt + div(rho u) = 0,    in weak form  dm_i/dt - integral(rho (u - w).grad phi_i) + what passes faces = 0,
// m_i = integral(rho phi_i) the mass of a vertex (flow_mass.h). What all vertices gain in a step is what came in through
// faces. In a step the density changes evenly, so that the velocity this makes is of first order in time. The viscous
// stress of div u is left to the pressure, which then is not the one of thermodynamics by that much.
//   [Rehm, Baum 1978] The equations of motion for thermally driven, buoyant flows. J. Res. Nat. Bur. Stand. 83.
//
// As the mesh moves and is remade from step to step, nothing but the state at the step's begin is used: a
// step of the second order is two stages of the method SDIRK2, gamma = 1 - 1/sqrt 2, which is L-stable and
// ends at its last stage,
//   [Alexander 1977] Diagonally implicit Runge-Kutta methods for stiff O.D.E.'s. SIAM J. Numer. Anal. 14.
// Each stage is a step of backward Euler of length gamma dt on the mesh at its time, between the two of the
// step:
//     (u1 - u0) / (gamma dt)  at t + gamma dt,     u* = u0 + (1 - gamma)/gamma (u1 - u0),
//     (u - u*) / (gamma dt)   at t + dt.
// Where a velocity g is given, u* = g(t + dt) - gamma dt g'(t + dt) is prescribed, not u1 = g(t + gamma dt):
// the rate of the last stage then is g', and the pressure, which depends on it, is of second order too.

/// Velocity per direction at a place [m] and a time [s]; what is empty is zero.
using VectorQuantity = std::array<Quantity, 3>;

/// A velocity [m/s] at a place [m] and a time [s].
using VectorField = std::function<Vec3(const Vec3& place, double t)>;

struct FlowRegion {
    Property density = 1;    // [kg/m^3] of the temperature only if nothing else flows
    Property viscosity = 1;  // [Pa s]
    VectorQuantity force = {};  // [N/m^3]
};

/// The velocity of a body that moves as a whole.
struct RigidVelocity {
    Vec3 centre;    // [m]
    Vec3 velocity;  // [m/s] of the centre
    Vec3 spin;      // [rad/s]
};

struct FlowFace {
    enum class Kind {
        wall,      ///< no slip
        slip,      ///< the normal velocity is zero, and the shear stress
        velocity,  ///< given
        open,      ///< mu du/dn - p n = -pressure n; where it flows in, as from rest: less rho/2 u_n^2
    } kind = Kind::wall;
    VectorQuantity velocity = {};  // [m/s] of a face with a velocity
    Quantity pressure = {};        // [Pa] of an open face; empty: zero
};

enum class FlowScheme {
    second_order,  ///< SDIRK2
    first_order,   ///< backward Euler: for a few steps after a start, or towards a steady state
    steady,  ///< no rates, and a mesh that rests: what lasts with the surfaces' present velocities
};

/// The tension of a surface between liquids or gases [N/m], of the temperature there.
using Tension = std::optional<Property>;

/// How the surface of a liquid ends on each face of the box: at this angle in the liquid [degrees] its line rests, at others it
/// moves along the face, if that lets it slip; none: the line is pinned, and has the velocity of the face if one is given.
using ContactAngles = std::array<std::optional<double>, 6>;

struct FlowOptions {
    // Of region 0, 1, ...: a liquid or gas, or nothing: a solid body.
    std::vector<std::optional<FlowRegion>> regions;
    // Velocities of regions 1, 2, ..., and instead of them those of their surfaces at each place, if these do not move as a
    // whole. Of bodies with neither: the mesh's, (x1 - x0) / dt, of first order in time where a body accelerates.
    std::vector<std::function<RigidVelocity(double t)>> bodies = {};
    std::vector<VectorField> surfaces = {};
    std::vector<Tension> tension = {};     // of the surfaces of regions 1, 2, ... that are liquid, and
    std::vector<ContactAngles> contact = {};  // of those that reach through faces
    Vec3 gravity = {};                     // [m/s^2]
    bool convection = true;                // false: Stokes
    std::array<FlowFace, 6> faces = {};    // x min, x max, y min, y max, z min, z max
    FlowScheme scheme = FlowScheme::second_order;
    double tolerance = 1e-3;  // [-] of the first residual, of either stage: where Newton's method ends
    int most_passes = 20;     // of it
    std::string key = "flow";  // of what messages speak
};

struct FlowState {
    Array<Vertex, Vec3> velocity;    // [m/s]; zero in solid bodies, but for their surface
    Array<Vertex, double> pressure;  // [Pa]; zero in them; where two regions meet, that of the lower number
    // [kg/m^3] where it depends on the temperature: what is there, and not what the temperature would make of it, so that
    // mass is kept from step to step. Empty at a start: the temperature's at the step's end.
    Array<Vertex, double> density = {};
    // [Pa] of regions 1, 2, ..., where more than one flows: the pressure at their vertices, where they meet a region of a
    // lower number on their side. Empty: as `pressure`.
    std::vector<Array<Vertex, double>> within = {};
};

/// What a flow does to a solid body: consistent, the residual of the momentum rows at the body's surface.
struct BodyForce {
    Region body;
    Vec3 centre;       // [m] that of its volume, or of its velocity if that is given
    Vec3 force = {};   // [N]
    Vec3 torque = {};  // [N m] about the centre
    double flux = 0;   // [m^3/s] that its surface takes in, with the velocities there
};

/// What passes a face of the box at a vertex.
struct FaceMass {
    Vertex vertex;
    std::size_t face;
    double rate;  // [kg/s] out of the box, in the mean over the step
};

/// Where the flow takes the surface of a liquid in a step.
struct SurfaceCourse {
    Region body;
    std::vector<std::array<Vertex, 3>> facets;  // normals out of the body
    std::vector<Vertex> vertices;       // ascending
    std::vector<Vec3> displacement;     // [m] of what is there at the step's begin
    double area = 0;                    // [m^2] at its end
    std::vector<Vec3> free = {};        // as LiquidSurface::free
};

/// Of what flows, at the end of a step [J].
struct FlowEnergy {
    double kinetic = 0;
    double surface = 0;  // tension times area, less tension times the angle's cosine times the wetted area of faces
    double gravity = 0;  // against the origin of coordinates
};

struct FlowReport {
    int iterations = 0;  // of the linear solver
    int passes = 0;      // of Newton's method, of all stages
    double error = 0;    // [-] what is left of the first residual
    std::vector<BodyForce> bodies = {};    // of solid ones
    std::vector<SurfaceCourse> surfaces = {};  // of liquid ones
    FlowEnergy energy = {};
    double dissipated = 0;  // [J] in the step, by viscosity
    Vec3 momentum = {};        // [kg m/s] of all that flows, at the step's end
    // [kg m/s] gained in the step, and neither by forces nor with what passes faces: as the form is not conservative, of the
    // order of the cells' and the step's error. Zero in Stokes flow and in a steady one.
    Vec3 momentum_error = {};
    std::array<double, 6> face_flux = {};  // [m^3/s] out through each face
    // [N] on each face; nothing where it is open. Where faces meet, what acts on vertices is of the face
    // across that direction, else of both: of shear a share of the cells' size goes to faces beside.
    std::array<Vec3, 6> face_force = {};
    double net_flux = 0;  // [m^3/s] out of everything: zero but for the shape of what is given, by facets; or what expands
    std::vector<FaceMass> through = {};  // where the density depends on the temperature
    double mass_error = 0;  // [kg] gained in the step, and not through faces; zero but for the solution
    double largest_courant = 0;  // [-] heights of a cell that the flow crosses in the step
};

/// Throws CaseError, naming the key below `flow`, if a density or viscosity is not positive, gravity is not
/// finite, a density depends on the temperature and no face is open or more than one region flows, or the mesh has
/// other regions.
void check_flow(const FlowOptions& options, const Mesh& mesh);

/// At rest, without pressure.
[[nodiscard]] FlowState still_flow(const Mesh& mesh);

/// Takes the flow from t [s] on `before` to t + dt on `current`: the same connectivity. `temperature` [K] at
/// the end of the step may be empty where no property depends on it. Without an open face the mean of the
/// pressure is zero. Boundary of patches from 6 on that is no layer's is
/// a wall. Where faces meet, a wall holds, unless what is given passes a face there: then what of it goes along the
/// wall, so that all that is given comes in; then the first one with a velocity, then slip. Where the surface of a body
/// that moves ends on a wall or slips along a face, only what of its velocity goes along that counts. All ranks
/// call it together with the same arguments, and all get the whole state. The solver's options have the
/// prefix flow_: -flow_ksp_type, -flow_pc_type. Throws CaseError as check_flow, or if dt is not positive, a
/// quantity not finite or what flows in has no way out; SolverError if the solver or Newton's method does not
/// converge; Interrupted if the watch of the ranks says so. Then `state` is untouched.
FlowReport step_flow(const Ranks& ranks, const Mesh& before, const Mesh& current, const FlowOptions& options,
                     FlowState& state, double t, double dt, const Array<Vertex, double>& temperature = {});

}  // namespace kropla
