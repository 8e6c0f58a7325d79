#pragma once

#include "motion/joint_response.h"
#include <kropla/domain/domain.h>

#include <cstddef>
#include <set>
#include <vector>

namespace kropla {

// Free bodies that come nearer to each other, to a body that goes as it is told or to a face of the box than the mesh can
// resolve. Two things act along the normal n of a gap g between a body and what it faces, without friction:
//
// Below the reach g0 of the mesh, what it does not resolve of the flow that is squeezed out,
//     F = -6 pi mu a^2 (1/g - 1/g0) v_n,
// the difference of the leading force of lubrication, v_n the rate of g at the end of the step, a^2 as facing.h has it. It
// is stiff, and holds for the gap and the velocity at the end of the step.
//
// Where the gap would be below the least one at the step's end, an impulse that only pushes and makes v_n there -e times
// that before, e the restitution; zero where that is no more than what forces make in a step or two: the body rests. The
// gap then is where the touch and the way back put it. As the velocity cannot go there evenly, it leaps at the
// step's begin. A second multiplier sees to that, so that momentum is not concerned.
//   [Moreau 1988] Unilateral contact and dry friction in finite freedom dynamics. In: Nonsmooth mechanics and applications.
//   [Acary 2013] Projected event-capturing time-stepping schemes for nonsmooth mechanical systems with unilateral contact
//     and Coulomb's friction. CMAME 256: velocities and places both, by two multipliers.
//
// All of it is solved for with the rates of all bodies that are concerned, by the equations that Newton's method has for
// them (RigidStep): projected Gauss-Seidel over the contacts, the places where bodies face each other found anew until
// nothing moves any more.

struct ContactOptions {
    bool lubrication = true;
    double restitution = 0;  // [-] 0 to 1
    double gap = 0;          // [m] at which surfaces touch, below the reach
    double reach = 0;        // [m] from this gap on the mesh resolves the flow
};

/// [N s/m] What the mesh does not resolve of the resistance of a gap; none from `reach` on. `squeezed` is that of Facing.
[[nodiscard]] double unresolved_resistance(double viscosity, double squeezed, double gap, double reach);

/// A pair: a free body, and another or a wall.
struct ContactPair {
    std::size_t body = 0;   // of the domain
    int wall = -1;          // the face of the box, 0 ... 5; -1: it is another body
    std::size_t other = 0;  // that body
    auto operator<=>(const ContactPair&) const = default;
};
/// What acts between the two in a step.
struct ContactForce {
    ContactPair who;
    Vec3 place;          // [m] on the body's surface
    Vec3 force;          // [N] on the body, in the mean over the step; on the other the opposite
    bool touches = false;  // else lubrication alone
};
struct ContactReport {
    std::vector<ContactForce> contacts;
    std::vector<double> gaps;  // [m] per body of the domain: the least at the end of the step; of those that are free
    std::vector<Vec3> forces;  // [N] per body of the domain
};

/// What contacts do in a step from t [s] on for dt. Domain and bodies outlive it.
class Contacts {
public:
    Contacts(const Domain& domain, const ContactOptions& options, double viscosity, FreeSteps& bodies, double t, double dt);

    /// Before anything is known of forces: lets the rates that are tried first heed what is in the way.
    void guess();
    /// After each body has taken what the flow did to it: finds what contacts do then. Returns by how much the rates that
    /// are tried miss all of it, as RigidStep::take.
    [[nodiscard]] double settle();
    /// Tries the rates that were found.
    void improve();
    [[nodiscard]] ContactReport report() const;

    /// What is solved for.
    struct Solution {
        std::vector<SixVector> rates, leaps;  // per free body
        std::vector<ContactForce> contacts;   // those with a force
    };

private:
    const Domain& domain_;
    ContactOptions options_;
    double viscosity_;
    FreeSteps& bodies_;
    double t_, dt_;
    JointResponse response_;
    std::set<ContactPair> touched_;  // in this step: in question until it is over, so that rounds come to an end
    Solution found_;
};

}  // namespace kropla
