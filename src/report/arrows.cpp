#include "report/arrows.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace kropla {
namespace {

double cross2(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

Vec3 velocity_at(const CutCorner& corner, const Array<Vertex, Vec3>& velocity) {
    return (1 - corner.share) * velocity[corner.a] + corner.share * velocity[corner.b];
}

/// The velocity at a place of the polygon, linear in the triangles of a fan; nothing outside.
std::optional<Vec3> velocity_at(const CutPolygon& polygon, Point2 p, const Array<Vertex, Vec3>& velocity) {
    const CutCorner& first = polygon.corners[0];
    for (std::size_t i = 2; i < static_cast<std::size_t>(polygon.size); ++i) {
        const CutCorner &second = polygon.corners[i - 1], &third = polygon.corners[i];
        const double at_first = cross2(p, second.place, third.place),
                     at_second = cross2(p, third.place, first.place),
                     at_third = cross2(p, first.place, second.place);
        const double sum = at_first + at_second + at_third;
        if (std::min({at_first, at_second, at_third}) < 0 || !(sum > 0)) continue;
        return (at_first / sum) * velocity_at(first, velocity) +
               (at_second / sum) * velocity_at(second, velocity) +
               (at_third / sum) * velocity_at(third, velocity);
    }
    return {};
}

/// The places within the box around a polygon, as far as it is in the window.
std::vector<Point2> places_around(const CutPolygon& polygon, const CutWindow& window, double spacing) {
    Point2 min = polygon.corners[0].place, max = min;
    for (const CutCorner& corner : corners(polygon)) {
        min = {std::min(min.x, corner.place.x), std::min(min.y, corner.place.y)};
        max = {std::max(max.x, corner.place.x), std::max(max.y, corner.place.y)};
    }
    min = {std::max(min.x, window.min.x), std::max(min.y, window.min.y)};
    max = {std::min(max.x, window.max.x), std::min(max.y, window.max.y)};
    std::vector<Point2> places;
    for (double row = std::ceil(min.y / spacing); row * spacing <= max.y; ++row) {
        const double shift = std::fmod(std::abs(row), 2) == 0 ? 0 : 0.5;
        for (double column = std::ceil(min.x / spacing - shift); (column + shift) * spacing <= max.x;
             ++column)
            places.push_back({(column + shift) * spacing, row * spacing});
    }
    return places;
}

bool is_inside(const CutPolygon& polygon, Point2 p) {
    const auto all = corners(polygon);
    for (std::size_t i = 0; i < all.size(); ++i)
        if (cross2(all[i].place, all[(i + 1) % all.size()].place, p) < 0) return false;
    return true;
}

bool reaches_into(const Arrow& arrow, std::span<const CutPolygon> solids) {
    const double half = arrow.length / 2;
    const Point2 forth = {half * arrow.direction.x, half * arrow.direction.y};
    const Point2 tip = {arrow.place.x + forth.x, arrow.place.y + forth.y},
                 tail = {arrow.place.x - forth.x, arrow.place.y - forth.y};
    return std::ranges::any_of(solids, [&](const CutPolygon& polygon) {
        return is_inside(polygon, tip) || is_inside(polygon, tail);
    });
}

}  // namespace

std::vector<Arrow> arrows(std::span<const CutPolygon> cut, std::span<const CutPolygon> solids,
                          const CutPlane& plane, const Array<Vertex, Vec3>& velocity,
                          const ArrowOptions& options) {
    std::vector<Arrow> all;
    for (const CutPolygon& polygon : cut)
        for (const Point2 place : places_around(polygon, options.window, options.spacing)) {
            const std::optional<Vec3> known = velocity_at(polygon, place, velocity);
            if (!known) continue;
            const Point2 flow = {dot(*known, plane.right), dot(*known, plane.up)};
            const double speed = std::hypot(flow.x, flow.y);
            if (!(speed > 0)) continue;
            const Arrow arrow = {
                place, {flow.x / speed, flow.y / speed}, options.spacing * std::sqrt(speed / options.most)};
            if (!reaches_into(arrow, solids)) all.push_back(arrow);
        }
    return all;
}

}  // namespace kropla
