// How wide what a closed surface of triangles bounds is, and what it leaves open.

#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {

/// By steps as long as there is room [Hart 1996, "Sphere tracing"].
TriangulatedSurface::Opposite TriangulatedSurface::opposite(const Vec3& from, const Vec3& direction, bool inside, double least,
                                                            double most) const {
    constexpr int steps = 60;         // each next to doubles the way, until the other side is near
    constexpr double arrived = 1e-2;  // [-] of the way
    if (!inside && reached_ != 0) return {};  // the way may be out of the box
    double way = least;
    for (int step = 0; step < steps && way < most; ++step) {
        const Vec3 place = from + way * direction;
        if (inside && extent_.squared_distance(place) > 0) return through_face(from, direction);
        const NearestPlace near = tree_.nearest(place);
        const double room = inside ? -signed_distance(place, near) : signed_distance(place, near);
        if (room <= arrived * way) return {way, normalised(outwards(near))};
        way += room;
    }
    return {};
}

/// Where the way from within the body leaves the box.
TriangulatedSurface::Opposite TriangulatedSurface::through_face(const Vec3& from, const Vec3& direction) const {
    Opposite face;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const bool up = direction[axis] > 0;
        const double way = ((up ? extent_.max : extent_.min)[axis] - from[axis]) / direction[axis];
        if (!(way < face.way)) continue;
        face.way = way;
        face.normal = {};
        face.normal[axis] = up ? 1 : -1;
    }
    return face;
}

double TriangulatedSurface::across(const Vec3& x, bool inside, double most) const {
    constexpr double facing = 0.77;  // cosine of 40 degrees: a neck need not be seen at its narrowest
    const NearestPlace start = tree_.nearest(x);
    return width_between(start.point, normalised(outwards(start)), inside, most, facing);
}

double TriangulatedSurface::width_between(const Vec3& x, const Vec3& normal, bool inside, double most, double parallel) const {
    constexpr double least = 1e-6;      // of the most: near an edge sides are near, too
    constexpr double rounding = 1e-6;
    const Vec3 direction = inside ? -normal : normal;
    const Vec3 middle = x + most / 2 * direction;  // of a ball that is free of the surface, mostly
    const bool in_box = !inside || !(extent_.squared_distance(x + most * direction) > 0);
    const NearestPlace touching{x, most / 2 * (most / 2)};
    if (in_box && std::sqrt(tree_.nearest(middle, touching).squared_distance) > most / 2 * (1 - rounding))
        return std::numeric_limits<double>::infinity();
    const Opposite other = opposite(x, direction, inside, least * most, most);
    const bool counts = -dot(other.normal, normal) > parallel && !is_at_edge(x + other.way / 2 * direction, normal, other, inside, most);
    return counts ? other.way : std::numeric_limits<double>::infinity();
}

/// Do both sides of `middle` meet in an edge not farther than `most`? However sharp it is, smaller triangles are no better.
bool TriangulatedSurface::is_at_edge(const Vec3& middle, const Vec3& normal, const Opposite& other, bool inside, double most) const {
    constexpr double almost = 0.6;  // of the way to where it would be: there is room still, if it is no blunt one, nor very round
    const double tilt = norm(normal + other.normal);
    if (!(other.way < most * tilt)) return false;
    const Vec3 to_edge = (inside ? 1 : -1) / tilt * (normal + other.normal);
    return (signed_distance(middle + almost * (other.way / tilt) * to_edge) < 0) == inside;
}

double TriangulatedSurface::radius_at(std::size_t triangle) const {
    const Corners corners = tree_.corners(triangle);
    const Vec3& normal = inside_normal_[triangle];
    const double twice_area = norm(cross(corners[1] - corners[0], corners[2] - corners[0]));
    double radius = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const double bend = 2 * angle_between(normal, edge_normal_[triangle][i]);
        const double height = twice_area / distance(corners[i], corners[(i + 1) % 3]);
        if (bend > 0 && bend <= sharp) radius = std::min(radius, height / bend);
    }
    return radius;
}

double TriangulatedSurface::least_crease() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < triangles().size(); ++t)
        for (const Vec3& at_edge : edge_normal_[t])
            if (const double bend = 2 * angle_between(inside_normal_[t], at_edge); bend > sharp) least = std::min(least, bend);
    return least;
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
