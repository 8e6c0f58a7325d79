#pragma once

#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>
#include <kropla/simulate/flow.h>

#include <array>
#include <optional>

namespace kropla {

// A body that goes where forces take it, with six degrees of freedom,
//     m dV/dt = F + m g,    d(I spin)/dt = T,
// V the velocity of its centroid, F and T what the flow does to it, in the mean over a step. In a step V and spin change
// evenly, so that the body's surface has a velocity that goes on from that of the step before, and a mean velocity that
// takes it just where it stands at the end: the change is what is solved for.
//
// F itself depends on that change, by the fluid that has to be moved along: in light bodies more than by their own mass.
// Solved for by Newton's method, with the response of F that Broyden's method learns, from step to step: any ratio of
// densities, as for a solution of both together.
//   [Broyden 1965] A class of methods for solving nonlinear simultaneous equations. Math. Comp. 19.
//   [Causin, Gerbeau, Nobile 2005] Added-mass effect in the design of partitioned algorithms for fluid-structure problems.
//     CMAME 194: why fixed-point iterations fail for light bodies.

/// Force and torque, or velocity and spin, or their rates.
using SixVector = std::array<double, 6>;
using SixMatrix = std::array<SixVector, 6>;
/// The x of a x = b; a is not singular.
[[nodiscard]] SixVector solved(SixMatrix a, SixVector b);

/// What a body is told at the start.
struct FreeMotion {
    double density = 1;            // [kg/m^3]
    Vec3 velocity = {}, spin = {};  // [m/s], [rad/s] at the start
    SixVector free = {1, 1, 1, 1, 1, 1};  // zero along and about the axes along and about which it is held
};

/// What goes on from step to step, besides the mesh.
struct FreeState {
    Pose pose;                    // of the body's shape
    Vec3 velocity, spin;          // [m/s], [rad/s]
    SixVector rate = {};          // of both, in the last step [m/s^2], [rad/s^2]
    SixMatrix response = {};      // of force and torque to the rate: minus their derivative [kg], [kg m], [kg m^2]
    bool knows_response = false;  // none before the first step
};

/// A body of a mesh, as it is weighed.
struct Weighed {
    double mass = 0;    // [kg]
    Vec3 centre;        // [m] of mass
    std::array<Vec3, 3> inertia = {};  // [kg m^2] about it, rows
};
[[nodiscard]] Weighed weighed(const Mesh& mesh, Region body, double density);

/// A step of one body: what is tried for its rate until the flow agrees.
class RigidStep {
public:
    /// From t [s] on, for dt; `shape` is where the body's shape has its centre then [m]. `fluid_density` and
    /// `fluid_viscosity` are of what is around: for a first guess of the response.
    RigidStep(const FreeMotion& motion, const FreeState& state, const Weighed& body, const Vec3& shape_centre,
              const Vec3& gravity, double t, double dt);

    void guess_response(double fluid_density, double fluid_viscosity);

    /// At any time of the step.
    [[nodiscard]] RigidVelocity velocity(double t) const;
    /// At its end.
    [[nodiscard]] Pose pose() const;
    /// How the body goes on if the step is accepted.
    [[nodiscard]] FreeState end() const;

    /// Takes what the flow did to the body, in the mean over the step; returns by how much the rate that is tried misses
    /// the equations: of all that acts, a share.
    double take(const Vec3& force, const Vec3& torque);
    /// Tries the rate that what is known leads to.
    void improve();

    // Of what else than the flow acts, contact.h knows: it asks for the equations, and says what to try.

    /// What is left of them at the rate that is tried, without contacts [N], [N m].
    [[nodiscard]] const SixVector& left() const { return missing_; }
    /// By how much a change of the rate lessens that: inertia, and the response of the flow or not.
    [[nodiscard]] SixMatrix resistance(bool of_flow = true) const;
    [[nodiscard]] const SixVector& rate() const { return rate_; }
    [[nodiscard]] const SixVector& leap() const { return leap_; }
    [[nodiscard]] const FreeState& begin() const { return state_; }
    /// One along and about axes along and about which it is free, else zero.
    [[nodiscard]] const SixVector& freedom() const { return motion_.free; }
    /// A force with its torque as a share of all that acts; `contact` [N] is what contacts do.
    [[nodiscard]] double share(const SixVector& wrench, double contact) const;
    /// Tries a rate, and a leap of the velocity at the step's begin, which is gone again at its end: bodies that touch go
    /// otherwise than evenly. Nothing is learnt from that but by others, who may tell what they `know` of the response.
    void go(const SixVector& rate, const SixVector& leap);
    void know(const SixMatrix& response) { state_.response = response; }
    [[nodiscard]] double length() const;  // [m] of the size of the body
    [[nodiscard]] double dt() const { return dt_; }

private:
    [[nodiscard]] double scaled(const SixVector& wrench, double acting) const;
    [[nodiscard]] SixVector missing(const Vec3& force, const Vec3& torque) const;

    FreeMotion motion_;
    FreeState state_;
    Weighed body_;
    Vec3 shape_centre_, gravity_;
    double t_, dt_;
    SixVector rate_;
    SixVector leap_ = {};   // [m/s], [rad/s] at the begin
    bool leaps_ = false;    // else `leap_` is zero
    double acting_ = 0;     // [N] in all, of the flow and gravity
    std::optional<SixVector> last_rate_;   // tried before
    SixVector last_missing_ = {}, missing_ = {};
};

/// The flow around bodies that go as they are told: the velocities of their motions.
[[nodiscard]] RigidVelocity velocity_of(const Body& body, double t, double dt);

}  // namespace kropla
