#include "motion/contact.h"

#include "motion/facing.h"
#include "motion/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace kropla {
namespace {

SixVector both(const Vec3& a, const Vec3& b) { return {a.x, a.y, a.z, b.x, b.y, b.z}; }
double product(const SixVector& a, const SixVector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
    return sum;
}
void add(SixVector& to, double factor, const SixVector& what) {
    for (std::size_t i = 0; i < 6; ++i) to[i] += factor * what[i];
}
SixVector difference(SixVector a, const SixVector& b) {
    add(a, -1, b);
    return a;
}
SixVector motion_at_begin(const RigidStep& step) { return both(step.begin().velocity, step.begin().spin); }

/// One of two that face each other: a free body.
struct Side {
    std::size_t free = 0;  // among the free bodies
    SixVector along = {};  // by it a force along the normal acts on the body, and its velocity on the gap
};

struct Contact {
    ContactPair who;
    Facing facing = {};
    std::vector<Side> sides = {};  // one or two
    std::vector<SixVector> gained = {};  // [1/kg] of rate by a unit of force, per free body
    double mobility = 0;        // [1/kg] rate of the gap's rate by a unit of force
    double met = 0;             // [m/s] rate of the gap by what goes as it is told, at the end of the step
    double before = 0;          // [m/s] rate of the gap at the step's begin
    double begin_gap = 0;       // [m] then
    double force = 0;           // [N] that pushes, in the mean over the step
    double leap = 0;            // [N] that would make the leap of the velocity, in a step
    bool touches = false;
};

/// Contacts and rates at which all equations hold that Newton's method has.
class Problem {
public:
    Problem(const Domain& domain, const ContactOptions& options, double viscosity, const FreeSteps& bodies,
            const JointResponse& response, double t, double dt, const std::set<ContactPair>& touched)
        : domain_(domain), options_(options), viscosity_(viscosity), bodies_(bodies), response_(response), t_(t), dt_(dt),
          touched_(touched) {}

    /// Of what is left of the equations now.
    Contacts::Solution solve() {
        for (const bool of_flow : {true, false}) {
            start(of_flow);
            if (iterate()) break;
        }
        Contacts::Solution found{rates_, leaps_, {}};
        for (const Contact& c : contacts_)
            if (c.force != 0) found.contacts.push_back({c.who, c.facing.on_a, c.force * c.facing.normal, c.touches});
        return found;
    }

    [[nodiscard]] std::vector<double> least_gaps() {
        tried_.clear();
        for (const auto& [body, step] : bodies_) tried_.push_back(step);
        std::vector<double> gaps(domain_.bodies.size(), 0.0);
        for (const auto& [body, step] : bodies_) gaps[body] = std::numeric_limits<double>::infinity();
        const auto note = [&](std::size_t body, double gap) {
            if (free_of(body)) gaps[body] = std::min(gaps[body], gap);
        };
        for_each_pair([&](const ContactPair& who) {
            const double gap = facing_of(who).gap;
            note(who.body, gap);
            if (who.wall < 0) note(who.other, gap);
        });
        return gaps;
    }

private:
    /// Without contacts; `of_flow`: with the response of the flow as it was learnt.
    void start(bool of_flow) {
        of_flow_ = of_flow;
        leaps_.clear();
        contacts_.clear();
        std::vector<SixVector> left;
        for (const auto& [body, step] : bodies_) {
            left.push_back(step.left());
            leaps_.push_back(step.leap());
        }
        without_ = response_.solved_for(bodies_, left, of_flow);
        for (std::size_t i = 0; i < bodies_.size(); ++i) add(without_[i], 1, bodies_[i].second.rate());
        rates_ = without_;
    }

    /// Until bodies stay where they are; false if the response of the flow is none: it would pull what is pushed.
    bool iterate() {
        constexpr int rounds = 50;
        constexpr double stays = 1e-9;  // [-] of the reach
        for (int round = 0; round < rounds; ++round) {
            place_bodies();
            find_new();
            for (Contact& contact : contacts_) {
                aim(contact);
                if (contact.mobility < 0) return false;
            }
            const std::vector<SixVector> rates = rates_, leaps = leaps_;
            relax_all();
            double moved = 0;
            for (std::size_t i = 0; i < rates_.size(); ++i) {
                const double radius = outer_radius(domain_.bodies[bodies_[i].first].shape);
                for (std::size_t k = 0; k < 6; ++k)
                    moved = std::max(moved, (k < 3 ? 1 : radius) * std::abs(0.5 * dt_ * (dt_ * (rates_[i][k] - rates[i][k]) +
                                                                                         leaps_[i][k] - leaps[i][k])));
            }
            if (moved <= stays * options_.reach) break;
        }
        return true;
    }

    void place_bodies() {
        tried_.clear();
        for (std::size_t i = 0; i < bodies_.size(); ++i) {
            tried_.push_back(bodies_[i].second);
            tried_.back().go(rates_[i], leaps_[i]);
        }
    }

    [[nodiscard]] std::optional<std::size_t> free_of(std::size_t body) const {
        const auto found = std::ranges::find(bodies_, body, [](const auto& b) { return b.first; });
        if (found == bodies_.end()) return std::nullopt;
        return static_cast<std::size_t>(found - bodies_.begin());
    }

    [[nodiscard]] Shape shape_of(std::size_t body, bool at_begin) const {
        const Body& moving = domain_.bodies[body];
        const auto free = free_of(body);
        if (!free) return shape_at(moving, at_begin ? t_ : t_ + dt_);
        return placed(moving.shape, at_begin ? tried_[*free].begin().pose : tried_[*free].pose());
    }
    [[nodiscard]] Facing facing_of(const ContactPair& who, bool at_begin = false) const {
        const Shape a = shape_of(who.body, at_begin);
        return who.wall >= 0 ? facing_wall(a, domain_.box, who.wall) : facing(a, shape_of(who.other, at_begin));
    }

    /// Bodies that deform are left to the mesh: where they are is known to that alone.
    template <class Visit>
    void for_each_pair(const Visit& visit) const {
        for (const auto& [body, step] : bodies_) {
            for (int wall = 0; wall < 6; ++wall) visit(ContactPair{.body = body, .wall = wall});
            for (std::size_t other = 0; other < domain_.bodies.size(); ++other)
                if (other != body && (other > body || !free_of(other)) && !domain_.bodies[other].deformation)
                    visit(ContactPair{.body = body, .other = other});
        }
    }

    /// Contacts where bodies are near each other that were not before.
    void find_new() {
        for_each_pair([&](const ContactPair& who) {
            if (std::ranges::find(contacts_, who, &Contact::who) != contacts_.end()) return;
            if (who.wall < 0 && least_gap_between(shape_of(who.body, false), shape_of(who.other, false)) > options_.reach)
                return;
            if (!touched_.contains(who) && facing_of(who).gap > options_.reach) return;
            contacts_.push_back({.who = who});
        });
    }

    [[nodiscard]] Side side_of(std::size_t free, const Vec3& place, const Vec3& normal) const {
        const RigidStep& step = tried_[free];
        Side side{.free = free, .along = both(normal, cross(place - step.velocity(t_ + dt_).centre, normal))};
        for (std::size_t i = 0; i < 6; ++i) side.along[i] *= step.freedom()[i];
        return side;
    }

    /// Where and along what the two face each other now.
    void aim(Contact& contact) {
        contact.facing = facing_of(contact.who);
        contact.begin_gap = facing_of(contact.who, true).gap;
        contact.sides.clear();
        const Vec3& n = contact.facing.normal;
        contact.sides.push_back(side_of(*free_of(contact.who.body), contact.facing.on_a, n));
        contact.met = contact.before = 0;
        if (contact.who.wall < 0) {
            if (const auto free = free_of(contact.who.other)) {
                contact.sides.push_back(side_of(*free, contact.facing.on_b, -n));
            } else {
                constexpr double within = 0.01;  // [-] of the step: motions may have no meaning before the run
                const auto told = [&](double t) {
                    const RigidVelocity v = velocity_of(domain_.bodies[contact.who.other], t, dt_);
                    return -dot(n, v.velocity + cross(v.spin, contact.facing.on_b - v.centre));
                };
                contact.met = told(t_ + dt_);
                contact.before = told(t_ + within * dt_);
            }
        }
        std::vector<SixVector> force(bodies_.size(), SixVector{});
        for (const Side& side : contact.sides) force[side.free] = side.along;
        contact.gained = response_.solved_for(bodies_, force, of_flow_);
        contact.mobility = 0;
        for (const Side& side : contact.sides) {
            contact.mobility += product(side.along, contact.gained[side.free]);
            contact.before += product(side.along, motion_at_begin(bodies_[side.free].second));
        }
    }

    [[nodiscard]] double rate_at_end(const Contact& contact) const {
        double rate = contact.met;
        for (const Side& side : contact.sides)
            rate += product(side.along, motion_at_begin(bodies_[side.free].second)) +
                    dt_ * product(side.along, rates_[side.free]);
        return rate;
    }
    [[nodiscard]] double gap_at_end(const Contact& contact) const {
        double gap = contact.facing.gap;
        for (const Side& side : contact.sides)
            gap += 0.5 * dt_ * (dt_ * product(side.along, difference(rates_[side.free], tried_[side.free].rate())) +
                                product(side.along, difference(leaps_[side.free], tried_[side.free].leap())));
        return gap;
    }

    /// The rates that the forces so far make.
    void sum_up() {
        rates_ = without_;
        std::ranges::fill(leaps_, SixVector{});
        for (const Contact& contact : contacts_) push(contact, contact.force, contact.leap);
    }

    void push(const Contact& contact, double force, double leap) {
        for (std::size_t i = 0; i < rates_.size(); ++i) {
            add(rates_[i], force, contact.gained[i]);
            add(leaps_[i], dt_ * leap, contact.gained[i]);
        }
    }

    /// Projected Gauss-Seidel.
    void relax_all() {
        constexpr int sweeps = 2000;
        constexpr double rounding = 1e-13;  // [-] of the largest force
        sum_up();
        for (int sweep = 0; sweep < sweeps; ++sweep) {
            double changed = 0, largest = 0;
            for (Contact& contact : contacts_) {
                changed = std::max(changed, relax(contact));
                largest = std::max({largest, std::abs(contact.force), std::abs(contact.leap)});
            }
            if (changed <= rounding * largest) break;
        }
    }

    /// The force and the leap at which the contact's laws hold, as all else stays. Returns by how much they changed [N].
    double relax(Contact& contact) {
        if (!(contact.mobility > 0)) return 0;  // both are held along the normal
        const double per_force = dt_ * contact.mobility;
        const double rate = rate_at_end(contact), alone = rate - per_force * contact.force;
        const double gap = gap_at_end(contact) - 0.5 * dt_ * per_force * contact.leap;
        const auto gap_if = [&](double end) { return gap + 0.5 * dt_ * (end - rate); };
        const double slowed = lubricated(contact, alone, per_force, gap_if);
        double end = slowed, leap = 0;
        contact.touches = touched_.contains(contact.who) || gap_if(slowed) < options_.gap;
        if (contact.touches) {
            const double back = rebound(contact, alone);
            contact.touches = back > slowed;
            if (contact.touches) {
                end = back;
                leap = (gap_after(contact, back) - gap_if(back)) / (0.5 * dt_ * per_force);
            }
        }
        const double force = (end - alone) / per_force;
        const double force_change = force - contact.force, leap_change = leap - contact.leap;
        push(contact, force_change, leap_change);
        contact.force = force;
        contact.leap = leap;
        return std::max(std::abs(force_change), std::abs(leap_change));
    }

    /// The rate of the gap at the step's end [m/s], where without the force of lubrication it were `alone`: between that and
    /// zero, by halving.
    template <class Gap>
    [[nodiscard]] double lubricated(const Contact& contact, double alone, double per_force, const Gap& gap_if) const {
        if (!options_.lubrication) return alone;
        const auto too_large = [&](double part) {
            const double gap = std::max(gap_if(part * alone), options_.gap);
            return part * (1 + per_force * unresolved_resistance(viscosity_, contact.facing.squeezed, gap, options_.reach)) > 1;
        };
        if (!too_large(1)) return alone;
        double low = 0, high = 1;
        for (double middle = 0.5; middle > low && middle < high; middle = (low + high) / 2)
            (too_large(middle) ? high : low) = middle;
        return high * alone;
    }

    /// The rate of the gap after the touch: none, where it is no more than what forces make in two steps.
    [[nodiscard]] double rebound(const Contact& contact, double alone) const {
        constexpr double at_rest = 2;  // [-] of what a step makes of the rate
        const double came = -contact.before;
        if (!(came > at_rest * std::abs(alone - contact.before))) return 0;
        return options_.restitution * came;
    }
    /// The gap at the end of a step with a touch, from which it goes back [m].
    [[nodiscard]] double gap_after(const Contact& contact, double back) const {
        if (back == 0) return options_.gap;
        const double until = std::clamp((contact.begin_gap - options_.gap) / -contact.before, 0.0, dt_);
        return options_.gap + back * (dt_ - until);
    }

    const Domain& domain_;
    const ContactOptions& options_;
    double viscosity_;
    const FreeSteps& bodies_;
    const JointResponse& response_;
    double t_, dt_;
    bool of_flow_ = true;  // with the response as it was learnt
    const std::set<ContactPair>& touched_;
    std::vector<SixVector> without_, rates_, leaps_;  // per free body: rates without contacts; as found so far
    std::vector<RigidStep> tried_;             // bodies at what was found in the round before
    std::vector<Contact> contacts_;
};

}  // namespace

double unresolved_resistance(double viscosity, double squeezed, double gap, double reach) {
    return gap < reach ? 6 * std::numbers::pi * viscosity * squeezed * (1 / gap - 1 / reach) : 0;
}

Contacts::Contacts(const Domain& domain, const ContactOptions& options, double viscosity, FreeSteps& bodies, double t, double dt)
    : domain_(domain), options_(options), viscosity_(viscosity), bodies_(bodies), t_(t), dt_(dt),
      response_(domain, bodies) {}

void Contacts::guess() {
    ContactOptions of_touch = options_;
    of_touch.lubrication = false;  // the rate of the step before knows of it
    found_ = Problem(domain_, of_touch, viscosity_, bodies_, response_, t_, dt_, touched_).solve();
    if (found_.contacts.empty()) return;
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].second.go(found_.rates[i], found_.leaps[i]);
}

double Contacts::settle() {
    response_.learn(bodies_);
    found_ = Problem(domain_, options_, viscosity_, bodies_, response_, t_, dt_, touched_).solve();
    std::vector<SixVector> changes;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const RigidStep& step = bodies_[i].second;
        changes.push_back(difference(found_.rates[i], step.rate()));
        add(changes.back(), 1 / dt_, difference(found_.leaps[i], step.leap()));
    }
    const std::vector<SixVector> left = response_.taken(bodies_, changes, true);
    double missed = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const auto& [body, step] = bodies_[i];
        double pushed = 0;
        for (const ContactForce& contact : found_.contacts)
            if (contact.who.body == body || (contact.who.wall < 0 && contact.who.other == body)) pushed += norm(contact.force);
        missed = std::max(missed, step.share(left[i], pushed));
    }
    return missed;
}

void Contacts::improve() {
    for (const ContactForce& contact : found_.contacts)
        if (contact.touches) touched_.insert(contact.who);
    response_.remember(bodies_, found_.rates, found_.leaps);
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].second.go(found_.rates[i], found_.leaps[i]);
}

ContactReport Contacts::report() const {
    ContactReport report{found_.contacts, Problem(domain_, options_, viscosity_, bodies_, response_, t_, dt_, touched_).least_gaps(),
                         std::vector<Vec3>(domain_.bodies.size())};
    for (const ContactForce& contact : found_.contacts) {
        report.forces[contact.who.body] += contact.force;
        if (contact.who.wall < 0) report.forces[contact.who.other] -= contact.force;
    }
    return report;
}

}  // namespace kropla
