#include <kropla/adapt/attempt.h>

#include "adapt/mesh_step.h"

#include <stdexcept>
#include <utility>

namespace kropla {

AttemptRight::AttemptRight(std::shared_ptr<MeshStep> step) : step_(std::move(step)) {
    if (!step_) throw std::logic_error("an attempt at a step of a moving mesh that was moved from");
    if (step_->under_way()) throw std::logic_error("a moving mesh has one attempt under way at a time");
    step_->begin_attempt();
}

AttemptRight::~AttemptRight() {
    if (step_) step_->end_attempt();
}

MeshStep& AttemptRight::step() const {
    if (!step_) throw std::logic_error("a stage of a step was handed on already");
    return *step_;
}

namespace {

/// Does a part of the step. What an exception leaves of it is not looked at again.
template <class Deed>
void perform(const AttemptRight& right, Deed deed) {
    MeshStep& step = right.step();
    try {
        deed(step);
    } catch (...) {
        step.drop();
        throw;
    }
}

}  // namespace

Attempt::Attempt(MovingMesh& moving) : right_(moving.step_) {
    perform(right_, [](MeshStep& step) {
        step.begin_step();
        step.refine();
    });
}
const Mesh& Attempt::reference() const { return right_.step().reference(); }
const Mesh& Attempt::before() const { return right_.step().before(); }
const Changes& Attempt::refined() const { return right_.step().statistics().refined; }

MovedAttempt::MovedAttempt(Attempt&& attempt, double end, std::span<const BodyPlace> places,
                           std::span<const BodyCourse> courses)
    : right_(std::move(attempt.right_)) {
    perform(right_, [end, places, courses](MeshStep& step) {
        if (!(end > step.time())) throw std::logic_error("a step ends after it begins");
        step.aim_at(end);
        step.correct(places, courses);
        step.move_boundary();
        step.optimise();
    });
}
double MovedAttempt::start() const { return right_.step().time(); }
double MovedAttempt::end() const { return right_.step().target_time(); }
const Mesh& MovedAttempt::before() const { return right_.step().before(); }
const Mesh& MovedAttempt::current() const { return right_.step().current(); }
std::optional<Refusal> MovedAttempt::refusal() const { return right_.step().refusal(); }
void MovedAttempt::move_again(std::span<const BodyPlace> places, std::span<const BodyCourse> courses) {
    perform(right_, [places, courses](MeshStep& step) {
        step.correct(places, courses);
        step.move_boundary();
        step.optimise();
    });
}

RemeshedAttempt::RemeshedAttempt(MovedAttempt&& attempt) : right_(std::move(attempt.right_)) {
    perform(right_, [](MeshStep& step) {
        if (step.refusal()) throw std::logic_error("a step that is to be refused is accepted");
        step.remesh();
    });
}
const Mesh& RemeshedAttempt::before() const { return right_.step().before(); }
const Mesh& RemeshedAttempt::current() const { return right_.step().current(); }
const Changes& RemeshedAttempt::remeshed() const { return right_.step().statistics().remeshed; }
const StepStatistics& RemeshedAttempt::statistics() const { return right_.step().statistics(); }

MovedAttempt move_bodies(Attempt&& attempt, double end, std::span<const BodyPlace> places,
                         std::span<const BodyCourse> courses) {
    return {std::move(attempt), end, places, courses};
}

void refuse(MovedAttempt&& attempt) {
    const MovedAttempt ended = std::move(attempt);
    ended.right_.step().refuse();
}

RemeshedAttempt remesh(MovedAttempt&& attempt) { return RemeshedAttempt(std::move(attempt)); }

StepStatistics accept(RemeshedAttempt&& attempt) {
    RemeshedAttempt ended = std::move(attempt);
    perform(ended.right_, [](MeshStep& step) { step.accept(); });
    return ended.right_.step().statistics();
}

}  // namespace kropla
