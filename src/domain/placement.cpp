// May the bodies stand where they stand?

#include <kropla/base/error.h>
#include "domain/approach.h"
#include <kropla/domain/domain.h>
#include "domain/thin_places.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace kropla {

namespace {

/// "its lowest z is -0.00012 m, the box begins at 0 m"
std::string overstep(const Box& box, const Bounds& held, int wall) {
    const int axis = wall / 2;
    const bool low = wall % 2 == 0;
    return std::string("its ") + (low ? "lowest " : "highest ") + "xyz"[axis] + " is " +
           metres(low ? held.min[axis] : held.max[axis]) + ", the box " +
           (low ? "begins at " + metres(box.min[axis]) : "ends at " + metres(box.max[axis]));
}

Approach nearest_wall(const Box& box, const Shape& shape, const Bounds& held, std::size_t body, double t) {
    Approach nearest{body, -1, 0, std::numeric_limits<double>::infinity(), t};
    for (int wall = 0; wall < 6; ++wall) {
        const double gap = wall_gap(box, shape, held, wall);
        if (gap >= nearest.gap) continue;
        nearest.gap = gap;
        nearest.wall = wall;
    }
    return nearest;
}

void lower(SizeLimit& limit, double most, const std::string& why) {
    if (most < limit.most) limit = {most, why};
}

void lower_by_gap(SizeLimit& limit, const Domain& domain, const Approach& approach, double least_gap) {
    if (approach.gap == 0) throw DomainError(in_words(domain, approach));
    lower(limit, size_for_gap(domain, approach, least_gap), in_words(domain, approach) + ", too close");
}

std::string in_words(const ThinPlaces::Width& narrow) {
    const std::string width = metres(narrow.across);
    switch (narrow.kind) {
        case ThinPlaces::Kind::body: return "is " + width + " thick";
        case ThinPlaces::Kind::slot: return "leaves open " + width;
        case ThinPlaces::Kind::edges: return "has sharp edges " + width + " from each other";
        case ThinPlaces::Kind::edge_at_face: return "has a sharp edge " + width + " from a face of the box that cuts it";
    }
    return {};
}

/// A body, or a slot in it, that is thinner than that many of the least sizes cannot be meshed; nor can edges that are nearer.
void check_thickness(const Domain& domain, const Snapshot& at, double least_width) {
    constexpr double doubtful = 0.1;  // [of the least size] so much smaller ones beside large ones are not always meshed
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        if (!at.shapes[body].surface) continue;
        const double least = std::min(least_size(at.size), surface_size(at, body));
        const ThinPlaces::Width narrowest = thin_places_of(at, body)->narrowest();
        if (narrowest.across >= least_width * least) continue;
        const Vec3 place = at.shapes[body].centre + rotated(at.shapes[body].orientation, narrowest.at);
        const bool is_thin = narrowest.kind == ThinPlaces::Kind::body || narrowest.kind == ThinPlaces::Kind::slot;
        const double would_do = gap_share * narrowest.across;
        throw DomainError(named(domain.bodies[body]) + " " + in_words(narrowest) + " at " + place_words(place) + ", too " +
                          (is_thin ? "thin" : "near") + " for size.least = " + metres(least) + "; at most " +
                          metres(rounded_down(would_do)) + (would_do > doubtful * least ? " would do" : " might do"));
    }
}

}  // namespace

double doubtful_gap(double max_aspect_ratio) {
    // Of the tet on an equilateral triangle of edge 1 with its top at the height h above the middle.
    const auto ratio = [](double h) {
        const double circumradius = (1.0 / 3 + h * h) / (2 * h), base = std::sqrt(3.0) / 4;
        const double inradius = base * h / (base + 1.5 * std::sqrt(h * h + 1.0 / 12));
        return circumradius / inradius;
    };
    double low = 1e-6, high = std::sqrt(2.0 / 3);  // that of the regular tet
    for (int halving = 0; halving < 60; ++halving) {
        const double middle = (low + high) / 2;
        (ratio(middle) > max_aspect_ratio ? low : high) = middle;
    }
    return high;
}

SizeLimit surface_limit(const Domain& domain, double t, double least_gap) {
    SizeLimit limit{std::numeric_limits<double>::infinity(), ""};
    const Snapshot at = snapshot(domain, t);
    std::vector<Bounds> held;
    double out = 0;  // most that two polyhedra stand out, together
    for (std::size_t i = 0; i < at.shapes.size(); ++i) {
        const Shape& shape = at.shapes[i];
        assert(is_finite(shape.centre) && shape.semi_axes.x > 0 && shape.semi_axes.y > 0 &&
               shape.semi_axes.z > 0);
        held.push_back(bounds(shape));
        const Approach wall = nearest_wall(domain.box, shape, held.back(), i, t);
        if (!(wall.gap >= 0))
            throw DomainError(named(domain.bodies[i]) + " is not inside the box: " +
                              overstep(domain.box, held.back(), wall.wall));
        if (wall.wall >= 0) lower_by_gap(limit, domain, wall, least_gap);
        out = std::max(out, 2 * outward_shift(domain.bodies[i].shape, asked_size(domain, i)));
        if (at.walls)
            lower_by_gap(limit, domain, {i, fixed_walls, 0, gap_between(shape, *at.walls), t}, least_gap);
        const double radius = least_curvature_radius(shape);
        lower(limit, radius * (domain.size.surface / asked_size(domain, i)),
              named(domain.bodies[i]) + " is curved with a radius of " + metres(radius) + ", too little");
    }
    for (const auto& [a, b] : pairs_within(held, least_gap * domain.size.surface + out))
        lower_by_gap(limit, domain, {a, -1, b, gap_between(at.shapes[a], at.shapes[b]), t}, least_gap);
    return limit;
}

std::string too_coarse(const SizeLimit& limit, double surface_size) {
    return limit.why + " for size.surface = " + metres(surface_size) + "; at most " +
           metres(rounded_down(limit.most)) + " would do";
}

void check_placement(const Domain& domain, double t, double least_gap) {
    assert(domain.size.surface > 0 && domain.size.far >= domain.size.surface && domain.size.growth >= 0);
    const SizeLimit limit = surface_limit(domain, t, least_gap);
    if (limit.most < domain.size.surface) throw DomainError(too_coarse(limit, domain.size.surface));
    check_thickness(domain, snapshot(domain, t), least_gap);
}

}  // namespace kropla
