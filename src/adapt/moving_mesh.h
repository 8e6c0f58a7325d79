#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/adapt/refusal.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace kropla {

/// What a step did to the mesh, for reports.
struct StepStatistics {
    Changes refined;     // (2.2), before the motion
    Changes optimised;   // (2.4), along with it
    Changes remeshed;    // (2.6), after it
    int legs = 0;        // into which the motion was cut
    bool redone = false; // whether 2.6 was taken back and done again, without passing the floor on its way
    int cells_touched = 0;
};

class MeshStep;

/// Where a body really is, against its start.
struct BodyPlace {
    std::size_t body;  // its number in the domain
    Pose pose;
};

/// How a body that deforms really goes in a step.
struct BodyCourse {
    std::size_t body;
    Deformation deformation;
};

/// A mesh that follows its bodies: the reference mesh, which nothing changes but an attempt that is accepted
/// (attempt.h), and what is kept from step to step so that a step costs no more than what it changes.
class MovingMesh {
public:
    /// `mesh` is the mesh of `domain` at time `t` [s], whoever made it: of each body the cells, its surface where the
    /// body stands; patches 0 ... 5 on the faces of the box that bear their numbers.
    /// Bodies that a solver has moved otherwise than their motions say stand at `places`, and go on from there.
    /// Throws DomainError, naming body or facet and place, if that is not so, or if `verify` finds a fault.
    MovingMesh(Domain domain, Mesh mesh, double t, const AdaptOptions& options = {},
               std::span<const BodyPlace> places = {});
    MovingMesh(const MovingMesh& other);  ///< without the attempt that `other` may have under way
    MovingMesh(MovingMesh&&) noexcept = default;
    MovingMesh& operator=(const MovingMesh& other);
    MovingMesh& operator=(MovingMesh&&) noexcept = default;
    ~MovingMesh() = default;

    [[nodiscard]] const Mesh& reference() const;
    [[nodiscard]] double time() const;  ///< of the reference [s]
    /// What was asked for; the motion of a body that a solver has moved otherwise starts from where it really is.
    [[nodiscard]] const Domain& domain() const;

private:
    friend class Attempt;
    std::shared_ptr<MeshStep> step_;
};

}  // namespace kropla
