// Room for layers: a function of where the shapes stand, not of what was before.
//
// Distances to planes and convex bodies change by at most one metre per metre, and so does their minimum:
// heights that are a share of them are graded without any smoothing.

#include "domain/layer_room.h"

#include "domain/body_tree.h"
#include "domain/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

const LayerOptions* layer_at_side(const Snapshot& at, std::size_t body, bool inside) {
    if (body >= at.layers.size() || !at.layers[body]) return nullptr;
    const LayerOptions& layer = *at.layers[body];
    return (inside ? has_inside(layer) : has_outside(layer)) ? &layer : nullptr;
}

Gap nearest_gap(const Snapshot& at, std::size_t body, const Vec3& x, double beyond) {
    // Of the gap, there is as much less room as the polyhedra stand out into it.
    const auto out = [&](std::size_t i) {
        return at.tree ? at.tree->outward[i] : outward_shift(at.shapes[i], asked_size(at, i));
    };
    const double own = out(body);
    Gap least{infinity, beyond, -1, body};
    const auto look_at = [&](double gap, double room, int wall, std::size_t other) {
        if (room < least.room) least = {gap, room, wall, other};
        return room;
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const double gap = side == 0 ? x[axis] - at.box.min[axis] : at.box.max[axis] - x[axis];
            look_at(gap, share_of_gap * (gap - own), 2 * axis + side, body);
        }
    if (at.walls) {
        const double gap = std::sqrt(at.walls->nearest(x).squared_distance);
        look_at(gap, share_of_gap * (gap - own), fixed_walls, body);
    }
    const auto at_least = [&](double d) {  // room beside bodies whose boxes are so far
        if (d == 0) return -infinity;
        const double gap = d - own - at.tree->most_outward;
        return gap * (gap > 0 ? share_between_layers : share_of_gap);
    };
    least_of_bodies(at, x, least.room, at_least, [&](std::size_t other) {
        if (other == body) return infinity;
        const double gap = signed_distance(at.shapes[other], x);
        const double share = layer_at_side(at, other, false) ? share_between_layers : share_of_gap;
        return look_at(gap, share * (gap - own - out(other)), -1, other);
    });
    return least;
}

double layer_thickness(const Snapshot& at, std::size_t body, bool inside, const Vec3& x) {
    const LayerOptions* layer = layer_at_side(at, body, inside);
    if (!layer) return 0;
    const double most = thickness(*layer);
    const double room = inside ? share_inside * thickness_at(at.shapes[body], x) / 2 : nearest_gap(at, body, x, most).room;
    return std::clamp(room, 0.0, most);
}

double distance_to_shells(const Snapshot& at, const DistancesFrom& distances) {
    return least_of_bodies(at, distances.place(), infinity, [&](double d) { return d - at.tree->most_thickness; },
                           [&](std::size_t body) {
                               const double from_wall = distances(body);
                               const bool inside = from_wall < 0;
                               if (!layer_at_side(at, body, inside)) return std::abs(from_wall);
                               const Vec3 on_wall = closest_point(at.shapes[body], distances.place());
                               return std::abs(from_wall) - layer_thickness(at, body, inside, on_wall);
                           });
}

double distance_to_shells(const Snapshot& at, const Vec3& x) { return distance_to_shells(at, DistancesFrom(at, x)); }

}  // namespace kropla
