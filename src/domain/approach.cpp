// How near bodies come to each other and to the walls on their way.
//
// The sweep is that of [Baraff 1992, "Dynamic Simulation of Non-penetrating Rigid Bodies", 4.1], along one
// axis. Where samples bracket the least gap, golden sections find it [Kiefer 1953].

#include "domain/approach.h"

#include <kropla/base/error.h>
#include "domain/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>

namespace kropla {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_finite(const Pose& pose) {
    return kropla::is_finite(pose.displacement) &&
           std::ranges::all_of(pose.rotation.axes, [](const Vec3& axis) { return kropla::is_finite(axis); });
}

Pose pose_at(const Body& body, double time) {
    const Pose pose = body.motion(time);
    if (!is_finite(pose))
        throw DomainError(named(body) + ": motion is not a number at t = " + time_words(time));
    return pose;
}

void refuse_outside(const Domain& domain, std::size_t body, const Bounds& held, int wall, double time) {
    const int axis = wall / 2;
    const bool low = wall % 2 == 0;
    throw DomainError(named(domain.bodies[body]) + ": motion takes it out of the box at t = " +
                      time_words(time) + ": its " + (low ? "lowest " : "highest ") + "xyz"[axis] + " is " +
                      metres(low ? held.min[axis] : held.max[axis]) + ", the box " +
                      (low ? "begins at " + metres(domain.box.min[axis])
                           : "ends at " + metres(domain.box.max[axis])));
}

void refuse_touching(const Domain& domain, std::size_t body, double time) {
    throw DomainError(named(domain.bodies[body]) + ": motion takes it into the fixed walls at t = " + time_words(time));
}

void refuse_meeting(const Domain& domain, std::size_t a, std::size_t b, double time) {
    throw DomainError(named(domain.bodies[a]) + " and " + named(domain.bodies[b]) +
                      ": motion takes them into each other at t = " + time_words(time));
}

double distance_to(const TriangleTree& walls, const Vec3& x) { return std::sqrt(walls.nearest(x).squared_distance); }

bool apart(const Bounds& a, const Bounds& b, int axis, double near) {
    return a.min[axis] > b.max[axis] + near || b.min[axis] > a.max[axis] + near;
}

}  // namespace

double wall_gap(const Box& box, const Bounds& held, int wall) {
    const int axis = wall / 2;
    return wall % 2 == 0 ? held.min[axis] - box.min[axis] : box.max[axis] - held.max[axis];
}

double wall_gap(const Box& box, const Shape& shape, const Bounds& held, int wall) {
    return reaches(reached_faces(shape), wall) ? infinity : wall_gap(box, held, wall);
}

double gap_at(const Domain& domain, const Approach& pair, double time) {
    const Shape body = placed(domain.bodies[pair.body].shape, pose_at(domain.bodies[pair.body], time));
    if (pair.wall == fixed_walls) return gap_between(body, *domain.walls);
    if (pair.wall >= 0) return wall_gap(domain.box, body, bounds(body), pair.wall);
    const Body& other = domain.bodies[pair.other];
    return gap_between(body, placed(other.shape, pose_at(other, time)));
}

double stand_out(const Domain& domain, const Approach& approach) {
    const auto of = [&](std::size_t body) { return outward_shift(domain.bodies[body].shape, asked_size(domain, body)); };
    return of(approach.body) + (approach.wall < 0 ? of(approach.other) : 0);
}

double size_for_gap(const Domain& domain, const Approach& approach, double in_sizes) {
    double size = asked_size(domain, approach.body);
    if (approach.wall < 0) size = std::max(size, asked_size(domain, approach.other));
    const double per_square = stand_out(domain, approach) / (size * size), in_surface_sizes = domain.size.surface / size;
    // in_sizes * s + per_square * s^2 = gap
    return in_surface_sizes * (2 * approach.gap / (in_sizes + std::sqrt(in_sizes * in_sizes + 4 * per_square * approach.gap)));
}

std::optional<Approach> approach_at(const Snapshot& at, const Vec3& place, double time) {
    if (at.shapes.empty()) return std::nullopt;
    Approach found;
    double nearest = infinity;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        const double away = std::abs(signed_distance(at.shapes[body], place));
        if (away < nearest) found.body = body;
        nearest = std::min(nearest, away);
    }
    nearest = infinity;
    for (int wall = 0; wall < 6; ++wall) {
        const double away = wall_gap(at.box, at.shapes[found.body], {place, place}, wall);
        if (away < nearest) found.wall = wall;
        nearest = std::min(nearest, away);
    }
    if (at.walls) {
        const double away = distance_to(*at.walls, place);
        if (away < nearest) found.wall = fixed_walls;
        nearest = std::min(nearest, away);
    }
    for (std::size_t other = 0; other < at.shapes.size(); ++other) {
        const double away = std::abs(signed_distance(at.shapes[other], place));
        if (other == found.body || away >= nearest) continue;
        nearest = away;
        found.wall = -1;
        found.other = other;
    }
    if (nearest == infinity) return std::nullopt;
    if (found.wall < 0 && found.other < found.body) std::swap(found.body, found.other);
    const Shape& body = at.shapes[found.body];
    found.gap = std::max(0.0, found.wall == fixed_walls ? gap_between(body, *at.walls)
                              : found.wall >= 0         ? wall_gap(at.box, body, bounds(body), found.wall)
                                                        : gap_between(body, at.shapes[found.other]));
    found.time = time;
    return found;
}

double width_at(const Snapshot& at, const Approach& approach, const Vec3& place) {
    const double to_other = approach.wall == fixed_walls ? distance_to(*at.walls, place)
                            : approach.wall >= 0         ? wall_gap(at.box, {place, place}, approach.wall)
                                                 : std::abs(signed_distance(at.shapes[approach.other], place));
    return std::abs(signed_distance(at.shapes[approach.body], place)) + to_other;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_within(std::span<const Bounds> held, double near) {
    std::vector<std::size_t> order(held.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t body) { return std::pair(held[body].min.x, body); });
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Bounds& a = held[order[i]];
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const Bounds& b = held[order[j]];
            if (b.min.x > a.max.x + near) break;
            if (!apart(a, b, 1, near) && !apart(a, b, 2, near))
                pairs.emplace_back(std::minmax(order[i], order[j]));
        }
    }
    return pairs;
}

Instant instant(const Domain& domain, double time) {
    Instant now{time, {}, {}};
    for (const Body& body : domain.bodies) {
        now.poses.push_back(pose_at(body, time));
        now.shapes.push_back(placed(body.shape, now.poses.back()));
    }
    return now;
}

double way_between(const Shape& shape, const Pose& a, const Pose& b) {
    double turned = 0;  // the most that a vector of unit length is changed, but for a factor below sqrt 3
    for (std::size_t i = 0; i < 3; ++i)
        turned = std::max(turned, distance(a.rotation.axes[i], b.rotation.axes[i]));
    return distance(a.displacement, b.displacement) + turned * outer_radius(shape);
}

void Approaches::look(const Instant& now) {
    travelled_.resize(now.poses.size(), 0);
    if (!times_.empty())
        for (std::size_t i = 0; i < now.poses.size(); ++i)
            travelled_[i] += way_between(now.shapes[i], last_.poses[i], now.poses[i]);
    times_.push_back(now.time);
    std::vector<Bounds> held;
    for (const Shape& shape : now.shapes) held.push_back(bounds(shape));
    for (std::size_t body = 0; body < held.size(); ++body)
        for (int wall = 0; wall < 6; ++wall) look_at_wall(now, body, held[body], wall);
    if (domain_.walls)
        for (std::size_t body = 0; body < held.size(); ++body) look_at_fixed_walls(now, body);
    for (const auto& [a, b] : pairs_within(held, near_)) look_at_pair(now, a, b);
    last_ = now;
}

void Approaches::look_at_wall(const Instant& now, std::size_t body, const Bounds& held, int wall) {
    const double gap = wall_gap(domain_.box, now.shapes[body], held, wall);
    if (!(gap >= 0)) refuse_outside(domain_, body, held, wall, now.time);
    if (gap >= near_) return;
    const Seen unseen{{body, wall, 0, infinity, 0}, 0, 0, 0};
    Seen& seen = walls_.try_emplace(6 * body + static_cast<std::size_t>(wall), unseen).first->second;
    note(seen, gap, now.time);
}

void Approaches::note(Seen& seen, double gap, double time) const {
    if (gap >= seen.best.gap) return;
    seen.best.gap = gap;
    seen.best.time = time;
    seen.sample = times_.size() - 1;
}

void Approaches::look_at_fixed_walls(const Instant& now, std::size_t body) {
    const Seen unseen{{body, fixed_walls, 0, infinity, 0}, 0, 0, 0};
    const auto [place, is_new] = fixed_walls_.try_emplace(body, unseen);
    Seen& seen = place->second;
    if (!is_new && seen.gap - (travelled_[body] - seen.travelled) >= std::min(seen.best.gap, near_)) return;
    seen.gap = gap_between(now.shapes[body], *domain_.walls);
    seen.travelled = travelled_[body];
    if (seen.gap == 0) refuse_touching(domain_, body, now.time);
    if (seen.gap < near_) note(seen, seen.gap, now.time);
}

void Approaches::look_at_pair(const Instant& now, std::size_t a, std::size_t b) {
    const Shape &first = now.shapes[a], &second = now.shapes[b];
    const double least = distance(first.centre, second.centre) - outer_radius(first) - outer_radius(second);
    if (least >= near_) return;
    const Seen unseen{{a, -1, b, infinity, 0}, 0, 0, 0};
    const auto [place, is_new] = pairs_.try_emplace(a * now.shapes.size() + b, unseen);
    Seen& seen = place->second;
    const double travelled = travelled_[a] + travelled_[b];
    if (!is_new && seen.gap - (travelled - seen.travelled) >= seen.best.gap) return;
    seen.gap = gap_between(first, second);
    seen.travelled = travelled;
    if (seen.gap == 0) refuse_meeting(domain_, a, b, now.time);
    note(seen, seen.gap, now.time);
}

/// By golden sections between the samples before and after the best one.
Approach Approaches::narrowed(const Seen& seen) const {
    constexpr int sections = 40;  // 0.618^40: to 4e-9 of the way between two samples
    constexpr double golden = 1 / std::numbers::phi;
    Approach best = seen.best;
    double from = times_[seen.sample == 0 ? 0 : seen.sample - 1],
           to = times_[std::min(seen.sample + 1, times_.size() - 1)];
    const auto ask = [&](double time) {
        const double gap = gap_at(domain_, best, time);
        if (gap < best.gap) {
            best.gap = std::max(0.0, gap);
            best.time = time;
        }
        return gap;
    };
    std::array<double, 2> time = {to - golden * (to - from), from + golden * (to - from)};
    std::array<double, 2> gap = {ask(time[0]), ask(time[1])};
    for (int i = 0; i < sections && from < to && best.gap > 0; ++i) {
        const bool left = gap[0] < gap[1];
        (left ? to : from) = left ? time[1] : time[0];
        if (left) {
            time = {to - golden * (to - from), time[0]};
            gap = {ask(time[0]), gap[0]};
        } else {
            time = {time[1], from + golden * (to - from)};
            gap = {gap[1], ask(time[1])};
        }
    }
    return best;
}

std::vector<Approach> Approaches::nearest() const {
    std::vector<Approach> all;
    for (const auto* seen_of : {&walls_, &fixed_walls_, &pairs_})
        for (const auto& [key, seen] : *seen_of) {
            if (seen.best.gap == infinity) continue;  // never near
            all.push_back(narrowed(seen));
            const Approach& found = all.back();
            if (found.gap > 0 || seen.best.gap == 0) continue;
            if (found.wall < 0) refuse_meeting(domain_, found.body, found.other, found.time);
            if (found.wall == fixed_walls) refuse_touching(domain_, found.body, found.time);
            const Bounds held = bounds(shape_at(domain_.bodies[found.body], found.time));
            refuse_outside(domain_, found.body, held, found.wall, found.time);
        }
    std::ranges::sort(all, {}, [](const Approach& a) { return std::tuple(a.gap, a.body, a.wall, a.other); });
    return all;
}

}  // namespace kropla
