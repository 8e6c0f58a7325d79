// What points keep from the boundaries.

#include "generate/clearance.h"

#include "domain/body_tree.h"
#include "domain/layer_room.h"
#include "generate/box.h"

#include <algorithm>

namespace kropla {

SizeAndClearance size_and_clearance(const Snapshot& at, const Vec3& x) {
    const DistancesFrom distances(at, x);
    const double size = target_size(at, distances);
    return {size, std::min(distance_to_walls(at.box, x) - clearance_at_walls * size,
                           distance_to_shells(at, distances) - clearance_at_bodies * size)};
}

double clearance(const Snapshot& at, const Vec3& x) { return size_and_clearance(at, x).clearance; }

double clearance_on_face(const Snapshot& at, Patch patch, const Vec3& x) {
    Box widened = at.box;  // so that the face itself does not count
    const int axis = patch.value / 2;
    const double width = at.box.max[axis] - at.box.min[axis];
    widened.min[axis] -= at.size.far + width;
    widened.max[axis] += at.size.far + width;
    const double size = target_size(at, x);
    double beyond = distance_to_walls(widened, x) - clearance_at_walls * size;
    for (std::size_t body = 0; body < at.shapes.size(); ++body)
        if (reaches(reached_faces(at.shapes[body]), patch.value))
            beyond = std::min(beyond, std::abs(signed_distance(at.shapes[body], x)) -
                                          clearance_across * surface_size(at, body, x));
    return beyond;
}

double clearance_slope(const Snapshot& at) {
    const bool layered = std::ranges::any_of(at.layers, [](const auto& layer) { return layer.has_value(); });
    return 1 + std::max(clearance_at_walls, clearance_at_bodies) * size_slope(at) +
           (layered ? share_of_gap : 0);
}

}  // namespace kropla
