#pragma once

#include <kropla/domain/words.h>

#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace kropla {

/// The bodies at one time of their way.
struct Instant {
    double time = 0;  // [s]
    std::vector<Pose> poses;
    std::vector<Shape> shapes;
};
/// Throws DomainError if a motion is not a finite number.
[[nodiscard]] Instant instant(const Domain& domain, double time);
/// At most how far a point of the body's surface goes, straight, from one pose to the other [m].
[[nodiscard]] double way_between(const Shape& shape, const Pose& a, const Pose& b);

/// From the side of the body that looks to the face of the box, 0 ... 5, to that face; negative outside [m].
[[nodiscard]] double wall_gap(const Box& box, const Bounds& held, int wall);
/// Of a shape within these bounds; infinite at a face that it reaches through.
[[nodiscard]] double wall_gap(const Box& box, const Shape& shape, const Bounds& held, int wall);
/// Of the two, or of the body and the wall, at `time` [s]; not positive where they touch [m].
[[nodiscard]] double gap_at(const Domain& domain, const Approach& approach, double time);
/// The body nearest to the place, and the wall or other body that is nearest to the place then, with their
/// gap; nothing without bodies.
[[nodiscard]] std::optional<Approach> approach_at(const Snapshot& at, const Vec3& place, double time);
/// How much room these two leave at the place: its distance to the one and to the other [m].
[[nodiscard]] double width_at(const Snapshot& at, const Approach& approach, const Vec3& place);
/// How far the polyhedra of the bodies beside the gap stand out of their shapes, together (`outward_shift`)
/// [m].
[[nodiscard]] double stand_out(const Domain& domain, const Approach& approach);
/// The largest size.surface (sizes of bodies' own in proportion) of which `in_sizes` fit into the gap beside the polyhedra [m]; `stand_out` grows
/// with its square.
[[nodiscard]] double size_for_gap(const Domain& domain, const Approach& approach, double in_sizes);
/// The pairs (a before b) whose bounds come within `near` [m] of each other, found by a sweep along x
/// [Baraff 1992]: what is far apart costs nothing.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> pairs_within(std::span<const Bounds> held,
                                                                            double near);

/// Follows bodies along their way and keeps of each pair, and of each body and wall, where they are nearest.
/// A gap is only looked at again when the bodies may have come nearer since than they ever were.
class Approaches {
public:
    /// Of what comes nearer than `near` [m].
    Approaches(const Domain& domain, double near) : domain_(domain), near_(near) {}

    /// The next time on the way. Throws DomainError if a body is out of the box, or in another.
    void look(const Instant& now);
    /// The nearest of each pair, found between the times that were looked at to rounding; the least gap
    /// first. Throws as `look`.
    [[nodiscard]] std::vector<Approach> nearest() const;

private:
    struct Seen {
        Approach best;              // so far
        std::size_t sample = 0;     // at which it was so
        double gap = 0;             // [m] when it was last looked at
        double travelled = 0;       // [m] by both until then
    };
    void look_at_wall(const Instant& now, std::size_t body, const Bounds& held, int wall);
    void look_at_fixed_walls(const Instant& now, std::size_t body);
    void look_at_pair(const Instant& now, std::size_t a, std::size_t b);
    void note(Seen& seen, double gap, double time) const;
    [[nodiscard]] Approach narrowed(const Seen& seen) const;

    const Domain& domain_;
    double near_;
    Instant last_;
    std::vector<double> times_;      // looked at
    std::vector<double> travelled_;  // per body [m]
    std::unordered_map<std::size_t, Seen> pairs_, walls_, fixed_walls_;
};

}  // namespace kropla
