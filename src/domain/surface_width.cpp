// How wide what a closed surface of triangles bounds is, and what it leaves open.

#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {

double TriangulatedSurface::across(const Vec3& x, bool inside, double most) const {
    constexpr int steps = 60;         // each next to doubles the way, until the other side is near
    constexpr double first = 1e-3;    // [-] of the most
    constexpr double arrived = 1e-2;  // [-] of the way
    if (!inside && reached_ != 0) return std::numeric_limits<double>::infinity();  // the way may be out of the box
    const NearestPlace start = tree_.nearest(x);
    const Vec3 normal = outwards(start) / norm(outwards(start));
    const Vec3 direction = inside ? -normal : normal;
    double way = first * most;
    for (int step = 0; step < steps && way < most; ++step) {
        const Vec3 place = start.point + way * direction;
        if (inside && extent_.squared_distance(place) > 0) break;  // through a face of the box
        const double room = signed_distance(place) * (inside ? -1 : 1);
        if (room <= arrived * way) return way;
        way += room;
    }
    return std::numeric_limits<double>::infinity();
}

double TriangulatedSurface::touching_ball(const Vec3& x, bool inside, double most) const {
    constexpr int rounds = 100;  // each brings the ball to a point that was within it
    constexpr double rounding = 1e-9;
    const NearestPlace at = tree_.nearest(x);
    const Vec3 normal = outwards(at) / norm(outwards(at)), direction = inside ? -normal : normal;
    double radius = most;
    for (int round = 0; round < rounds; ++round) {
        double smaller = radius;
        for (const Vec3& point : tree_.corners(tree_.nearest(at.point + radius * direction).triangle)) {
            const double depth = dot(point - at.point, direction);
            const double way = norm(point - at.point);
            if (way > rounding * most && depth > rounding * way) smaller = std::min(smaller, way * way / (2 * depth));
        }
        if (smaller >= radius * (1 - rounding)) break;
        radius = smaller;
    }
    return radius;
}

}  // namespace kropla
