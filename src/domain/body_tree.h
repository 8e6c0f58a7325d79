#pragma once

#include <kropla/domain/domain.h>
#include "mesh/box_tree.h"

namespace kropla {

/// Where the bodies of a snapshot are, so that a question at a place asks only those that may have the answer.
struct BodyTree {
    BoxTree boxes;               // a little wider than what holds each body, so that rounding cannot hide one
    double least_size;           // [m] of all surface sizes
    double most_thickness;       // [m] of all layers
    std::vector<double> outward; // [m] per body: its outward_shift
    double most_outward;         // [m] of all bodies
};

/// The snapshot of the bodies as they stand, to be completed by what follows, in this order.
[[nodiscard]] Snapshot without_tree(const Domain& domain, double t);
/// Sizes on the surface of a body fall where it is thin, if triangles bound it.
void see_thin_places(Snapshot& at, std::size_t body);
/// `local`, if there is one, or the other one, whichever is less.
void make_finer(LocalSize& local, LocalSize other);
/// Makes the tree of the snapshot's shapes, which are not to change any more; none for a few.
void plant_tree(Snapshot& at);

/// The least `value(body)` of all bodies that is below `bound`, else `bound`. `at_least(d)` is not above the value of any
/// body whose box is at the distance d [m] from `x`. The same, to the bit, as if all were asked.
template <class AtLeast, class Value>
double least_of_bodies(const Snapshot& at, const Vec3& x, double bound, const AtLeast& at_least, const Value& value) {
    if (at.tree)
        return at.tree->boxes.least([&](const Extent& box) { return at_least(std::sqrt(box.squared_distance(x))); }, value,
                                    bound);
    for (std::size_t body = 0; body < at.shapes.size(); ++body) bound = std::min(bound, value(body));
    return bound;
}

/// As surface_size, at a point of the surface of a body with a local size.
[[nodiscard]] double size_at_surface(const Snapshot& at, std::size_t body, const Vec3& on_surface);

/// Distances of bodies from one place, each worked out once.
class DistancesFrom {
public:
    DistancesFrom(const Snapshot& at, const Vec3& x) : at_(at), x_(x) {}
    [[nodiscard]] const Vec3& place() const { return x_; }
    /// As signed_distance.
    [[nodiscard]] double operator()(std::size_t body) const { return nearest(body).signed_distance; }
    /// As surface_size.
    [[nodiscard]] double surface_size(std::size_t body) const {
        return has_local_size(at_, body) ? size_at_surface(at_, body, nearest(body).point) : kropla::surface_size(at_, body);
    }

private:
    /// The point only where sizes ask for it.
    [[nodiscard]] SurfacePlace nearest(std::size_t body) const {
        for (std::size_t i = 0; i < count_; ++i)
            if (known_[i].body == body) return known_[i].place;
        const Shape& shape = at_.shapes[body];
        const SurfacePlace place =
            has_local_size(at_, body) ? nearest_on_surface(shape, x_) : SurfacePlace{{}, signed_distance(shape, x_)};
        if (count_ < known_.size()) known_[count_++] = {body, place};
        return place;
    }

    struct Known {
        std::size_t body;
        SurfacePlace place;
    };
    const Snapshot& at_;
    Vec3 x_;
    mutable std::array<Known, 8> known_;
    mutable std::size_t count_ = 0;
};

/// As target_size and distance_to_shells (layer_room.h), by distances that are known.
[[nodiscard]] double target_size(const Snapshot& at, const DistancesFrom& distances);
[[nodiscard]] double distance_to_shells(const Snapshot& at, const DistancesFrom& distances);

}  // namespace kropla
