// Bodies in place, distances and the size field.

#include "domain/domain.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {

double thickness(const LayerOptions& layer) {
    double sum = 0, height = layer.first_height;
    for (int k = 0; k < layer.count; ++k, height *= layer.growth) sum += height;
    return sum;
}

Shape shape_at(const Body& body, double t) { return placed(body.shape, body.motion(t)); }

Snapshot snapshot(const Domain& domain, double t) {
    Snapshot at{domain.box, domain.size, {}};
    for (const Body& body : domain.bodies) {
        at.shapes.push_back(shape_at(body, t));
        at.layers.push_back(body.layer);
    }
    return at;
}

double distance_to_bodies(const Snapshot& at, const Vec3& x) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Shape& shape : at.shapes) nearest = std::min(nearest, std::abs(signed_distance(shape, x)));
    return nearest;
}

double target_size(const Snapshot& at, const Vec3& x) {
    // Without growth, infinity * 0 would not be a number.
    const double rise = at.size.growth > 0 ? at.size.growth * distance_to_bodies(at, x) : 0;
    return at.shapes.empty() ? at.size.far : std::min(at.size.far, at.size.surface + rise);
}

}  // namespace kropla
