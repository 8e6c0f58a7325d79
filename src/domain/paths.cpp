// May the bodies go where they go?
//
// A path is a function that can only be asked. It is asked at so many times that what lasts as long as a
// share of a step cannot pass between them, each chosen at random within its share, so that no period of the
// path can hide in theirs [stratified sampling]; and between two of them by bisection where the middle is not
// where the ends would have it. A bisection that ends at the rounding of t and still sees the body elsewhere
// has found a jump; one that is steep ends before.

#include "domain/paths.h"

#include <kropla/base/error.h>
#include "base/random.h"
#include "domain/approach.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace kropla {

namespace {

constexpr int most_strata = 64;       // of a step; each is looked at within and in its middle
constexpr int least_strata = 2;
constexpr double strata_in_all = 1e5;  // bodies times steps times strata: some tenths of a second
constexpr int most_in_stratum = 250;   // looks; a jump is found in 60
constexpr double looks_in_all = 16;    // times the strata there are
constexpr double predicted_to = 0.05;  // surface sizes
constexpr double longest_way = 0.5;    // surface sizes between two looks
constexpr double jump = 0.1;  // surface sizes; less is what rounding in a formula's constants may leave
constexpr double leap = 10;            // surface sizes in one step: by measurement, 4 are gone and 6 are not
constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();  // of the end

/// How far the middle of a way is from where its ends would have it [m].
double unpredicted(const Shape& shape, const Pose& a, const Pose& middle, const Pose& b) {
    Pose mean{0.5 * (a.displacement + b.displacement), {}};
    for (std::size_t i = 0; i < 3; ++i)
        mean.rotation.axes[i] = 0.5 * (a.rotation.axes[i] + b.rotation.axes[i]);
    return way_between(shape, mean, middle);
}

/// [degrees]
double angle_between(const Rotation& a, const Rotation& b) {
    double trace = 0;
    for (std::size_t i = 0; i < 3; ++i) trace += dot(a.axes[i], b.axes[i]);
    return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0)) * 180 / std::numbers::pi;
}

void refuse_jump(const Body& body, const Pose& before, const Pose& after, double time) {
    const double way = distance(before.displacement, after.displacement);
    const bool turns = way < way_between(body.shape, before, after) - way;
    throw DomainError(
        named(body) + ": motion " +
        (turns ? "turns it by " + written(angle_between(before.rotation, after.rotation), "degrees")
               : "makes it jump by " + metres(way)) +
        " at t = " + time_words(time) + "; a path must not leap");
}

class Look {
public:
    Look(const Domain& domain, const PathOptions& options)
        : domain_(domain), options_(options), size_(domain.size.surface), approaches_(domain, options.near),
          too_fast_(domain.bodies.size(), 0) {}

    PathLook result() {
        const std::vector<double> times = times_to_look_at();
        looks_left_ = looks_in_all * static_cast<double>(times.size());
        Instant before = instant(domain_, times.front());
        approaches_.look(before);
        for (std::size_t i = 1; i < times.size(); ++i) {
            heed(options_.watch, "looking at the paths",
                 static_cast<double>(i) / static_cast<double>(times.size()));
            left_here_ = static_cast<int>(std::min<double>(most_in_stratum, looks_left_));
            Instant after = instant(domain_, times[i]);
            between(before, after);
            before = std::move(after);
        }
        PathLook found{approaches_.nearest(), {}};
        for (std::size_t body = 0; body < too_fast_.size(); ++body)
            if (too_fast_[body] != 0) found.too_fast.push_back(body);
        return found;
    }

private:
    [[nodiscard]] std::vector<double> times_to_look_at() const;
    [[nodiscard]] bool is_seen(std::size_t body, const Instant& a, const Instant& middle,
                               const Instant& b) const;
    void between(const Instant& a, const Instant& b);
    void refuse_leaps(const Instant& a, const Instant& b) const;
    void refuse_jumps(const Instant& a, const Instant& b) const;

    const Domain& domain_;
    const PathOptions& options_;
    double size_;  // [m]
    Approaches approaches_;
    std::vector<char> too_fast_;  // per body
    double looks_left_ = 0;
    int left_here_ = 0;
};

/// In order, each once: the ends of the steps, one time in each stratum of a step, and those asked for.
std::vector<double> Look::times_to_look_at() const {
    const double start = options_.start, whole = options_.end - start;
    const double shares = static_cast<double>(options_.steps) *
                          static_cast<double>(std::max<std::size_t>(1, domain_.bodies.size()));
    const int strata =
        static_cast<int>(std::clamp<double>(strata_in_all / shares, least_strata, most_strata));
    std::vector<double> times = {options_.end};
    Random random;
    for (int step = 0; step < options_.steps; ++step) {
        times.push_back(start + whole * step / options_.steps);
        for (int k = 0; k < strata; ++k)
            times.push_back(start + whole * ((step + (k + random.uniform()) / strata) / options_.steps));
    }
    for (double time : options_.also_at)
        if (time > start && time < options_.end) times.push_back(time);
    std::ranges::sort(times);
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

/// Whether the body's way from a to b is known well enough.
bool Look::is_seen(std::size_t body, const Instant& a, const Instant& middle, const Instant& b) const {
    const Shape& shape = domain_.bodies[body].shape;
    return way_between(shape, a.poses[body], b.poses[body]) <= longest_way * size_ &&
           unpredicted(shape, a.poses[body], middle.poses[body], b.poses[body]) <= predicted_to * size_;
}

/// Looks at what is after `a`, up to `b`.
void Look::between(const Instant& a, const Instant& b) {
    if (b.time - a.time <= rounding * std::max(std::abs(options_.start), std::abs(options_.end))) {
        refuse_jumps(a, b);
        return approaches_.look(b);
    }
    const Instant middle = instant(domain_, a.time + (b.time - a.time) / 2);
    --left_here_;
    --looks_left_;
    bool seen = true;
    for (std::size_t body = 0; body < domain_.bodies.size() && (seen || left_here_ <= 0); ++body) {
        if (is_seen(body, a, middle, b)) continue;
        seen = false;
        if (left_here_ <= 0) too_fast_[body] = 1;
    }
    if (seen || left_here_ <= 0) {
        approaches_.look(middle);
        return approaches_.look(b);
    }
    between(a, middle);
    between(middle, b);
    const double width = b.time - a.time;
    if (width <= options_.shortest && 2 * width > options_.shortest) refuse_leaps(a, b);
}

void Look::refuse_leaps(const Instant& a, const Instant& b) const {
    for (std::size_t body = 0; body < domain_.bodies.size(); ++body) {
        const double way = way_between(domain_.bodies[body].shape, a.poses[body], b.poses[body]);
        if (way <= leap * size_) continue;
        throw DomainError(named(domain_.bodies[body]) + ": motion takes its surface " + metres(way) +
                          " far within " + written(b.time - a.time, "s") + " at t = " + time_words(b.time) +
                          ", more than the shortest step can follow; more time.steps help");
    }
}

void Look::refuse_jumps(const Instant& a, const Instant& b) const {
    for (std::size_t body = 0; body < domain_.bodies.size(); ++body)
        if (way_between(domain_.bodies[body].shape, a.poses[body], b.poses[body]) > jump * size_)
            refuse_jump(domain_.bodies[body], a.poses[body], b.poses[body], b.time);
}

}  // namespace

PathLook look_at_paths(const Domain& domain, const PathOptions& options) {
    assert(options.start < options.end && options.steps >= 1);
    return Look(domain, options).result();
}

}  // namespace kropla
