#pragma once

#include <kropla/adapt/moving_mesh.h>

namespace kropla {

// One step of a moving mesh, stage by stage (the paper's 2.1 to 2.6), each by a type that allows only the next:
//
//     Attempt attempt(moving);                                      // 2.1, 2.2
//     MovedAttempt moved = move_bodies(std::move(attempt), t + dt); // 2.3, 2.4
//     if (moved.refusal()) return refuse(std::move(moved));         // and try again, or with a shorter dt
//     ...                                                           // 2.5: solve on moved.before(), moved.current()
//     RemeshedAttempt remeshed = remesh(std::move(moved));          // 2.6
//     StepStatistics done = accept(std::move(remeshed));
//
// A stage that goes out of scope without the next one, by an exception or not, leaves the moving mesh as it was, bit for
// bit. A moving mesh has one attempt under way at most; to begin another, or to use a stage that was handed on, throws
// std::logic_error.

/// The right to the one attempt that a moving mesh may have under way.
class AttemptRight {
public:
    explicit AttemptRight(std::shared_ptr<MeshStep> step);
    AttemptRight(AttemptRight&&) noexcept = default;
    AttemptRight& operator=(AttemptRight&&) = delete;
    AttemptRight(const AttemptRight&) = delete;
    AttemptRight& operator=(const AttemptRight&) = delete;
    ~AttemptRight();

    [[nodiscard]] MeshStep& step() const;  ///< throws std::logic_error if it was handed on

private:
    std::shared_ptr<MeshStep> step_;
};

/// Stages 2.1 and 2.2: the current mesh is a copy of the reference, remeshed where the attempts that were refused since
/// the last accepted step got stuck.
class Attempt {
public:
    explicit Attempt(MovingMesh& moving);

    [[nodiscard]] const Mesh& reference() const;
    /// The mesh of the step at its beginning. Fields are to be carried from reference() to it.
    [[nodiscard]] const Mesh& before() const;
    [[nodiscard]] const Changes& refined() const;  ///< from reference() to before(); empty at a first attempt

private:
    friend class MovedAttempt;
    AttemptRight right_;
};

/// Stages 2.3 and 2.4: bodies are at the end of their motions, their surroundings have followed.
class MovedAttempt {
public:
    [[nodiscard]] double start() const;  ///< [s] of the step
    [[nodiscard]] double end() const;
    /// One connectivity, two sets of places.
    [[nodiscard]] const Mesh& before() const;
    [[nodiscard]] const Mesh& current() const;
    /// Empty if the bodies arrived and every cell meets the floors, all along its way.
    [[nodiscard]] std::optional<Refusal> refusal() const;
    /// Does 2.3 and 2.4 again, with these bodies there, or deformed so; the others stay where they were. If the step is
    /// accepted, motions go on from there; deformations are told for this step alone. Throws std::logic_error if there is
    /// no such body, or if one is told a course that moves rigidly.
    void move_again(std::span<const BodyPlace> places, std::span<const BodyCourse> courses = {});

private:
    friend class RemeshedAttempt;
    friend MovedAttempt move_bodies(Attempt&& attempt, double end, std::span<const BodyPlace> places,
                                    std::span<const BodyCourse> courses);
    friend void refuse(MovedAttempt&& attempt);
    MovedAttempt(Attempt&& attempt, double end, std::span<const BodyPlace> places, std::span<const BodyCourse> courses);
    AttemptRight right_;
};

/// Stage 2.6, up to what cannot be taken back: the current mesh is remeshed where needed.
class RemeshedAttempt {
public:
    /// The mesh at the end of the step, not yet remeshed, and remeshed: fields are to be carried to it.
    [[nodiscard]] const Mesh& before() const;
    [[nodiscard]] const Mesh& current() const;
    [[nodiscard]] const Changes& remeshed() const;  ///< from before() to current()
    [[nodiscard]] const StepStatistics& statistics() const;

private:
    friend RemeshedAttempt remesh(MovedAttempt&& attempt);
    friend StepStatistics accept(RemeshedAttempt&& attempt);
    explicit RemeshedAttempt(MovedAttempt&& attempt);
    AttemptRight right_;
};

/// Takes the bodies to where they are at `end` [s]: these to their places or on their courses, as `move_again` does, all others as their
/// motions say. Throws std::logic_error if that is not after the step's start.
[[nodiscard]] MovedAttempt move_bodies(Attempt&& attempt, double end, std::span<const BodyPlace> places = {},
                                       std::span<const BodyCourse> courses = {});
/// Ends the attempt; if a tet stopped it, the next one will be remeshed where it got stuck.
void refuse(MovedAttempt&& attempt);
/// Throws std::logic_error if the attempt is to be refused.
[[nodiscard]] RemeshedAttempt remesh(MovedAttempt&& attempt);
/// The current mesh becomes the reference; the time is the end of the step.
StepStatistics accept(RemeshedAttempt&& attempt);

}  // namespace kropla
