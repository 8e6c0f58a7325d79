// Bodies in place, distances and the size field.

#include <kropla/domain/domain.h>

#include "domain/approach.h"
#include "domain/body_tree.h"
#include "domain/thin_places.h"
#include "domain/triangle_tree.h"
#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace kropla {

double thickness(const LayerOptions& layer) {
    double sum = 0, height = layer.first_height;
    for (int k = 0; k < layer.count; ++k, height *= layer.growth) sum += height;
    return sum;
}

Shape shape_at(const Body& body, double t) {
    return body.deformation ? body.shape : placed(body.shape, body.motion(t));
}

namespace {

/// The tree costs a search where one or two distances would do; more bodies than these are worth it.
constexpr std::size_t few_bodies = 2;

std::shared_ptr<const BodyTree> tree_of(const Snapshot& at) {
    constexpr double widened = 1e-9;  // [-] of the box's coordinates and the body's
    if (at.shapes.size() <= few_bodies) return {};
    std::vector<Extent> boxes;
    std::vector<double> outward;
    double least_size = std::numeric_limits<double>::infinity(), most_thickness = 0;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        const Bounds held = bounds(at.shapes[body]);
        const double most = std::max({norm(held.min), norm(held.max), norm(at.box.min), norm(at.box.max)});
        const Vec3 margin = widened * most * Vec3{1, 1, 1};
        boxes.push_back({held.min - margin, held.max + margin});
        outward.push_back(outward_shift(at.shapes[body], asked_size(at, body)));
        const double of_body = surface_size(at, body);
        least_size = std::min(least_size, has_local_size(at, body) ? std::min(of_body, kropla::least_size(at.size)) : of_body);
        if (at.layers[body]) most_thickness = std::max(most_thickness, thickness(*at.layers[body]));
    }
    const double most_outward = *std::ranges::max_element(outward);
    return std::make_shared<const BodyTree>(
        BodyTree{BoxTree(std::move(boxes)), least_size, most_thickness, std::move(outward), most_outward});
}

}  // namespace

void plant_tree(Snapshot& at) { at.tree = tree_of(at); }

Snapshot without_tree(const Domain& domain, double t) {
    Snapshot at{domain.box, domain.size, {}};
    at.walls = domain.walls;
    at.size.growth = std::min(at.size.growth, steepest_growth);
    for (const Body& body : domain.bodies) {
        at.shapes.push_back(shape_at(body, t));
        at.layers.push_back(body.layer);
        at.sizes.push_back(body.size);
        at.local_sizes.push_back(body.size ? body.local_size : domain.size.local);
        if (at.local_sizes.back()) at.local_slope = steepest_growth;
    }
    return at;
}

std::shared_ptr<const ThinPlaces> thin_places_of(const Snapshot& at, std::size_t body) {
    const double most = surface_size(at, body);
    return at.shapes[body].surface->thin_places(std::min(least_size(at.size), most), most);
}

void see_thin_places(Snapshot& at, std::size_t body) {
    const Shape& shape = at.shapes[body];
    if (!shape.surface) return;
    const auto thin = thin_places_of(at, body);
    if (!thin->any()) return;
    const double growth = at.size.growth;
    at.local_slope = std::max(at.local_slope, growth);
    make_finer(at.local_sizes[body], [centre = shape.centre, orientation = shape.orientation, thin, growth](const Vec3& x) {
        return thin->size(rotated_back(orientation, x - centre), growth);
    });
}

void make_finer(LocalSize& local, LocalSize other) {
    if (!local) local = std::move(other);
    else local = [given = local, other = std::move(other)](const Vec3& x) { return std::min(given(x), other(x)); };
}

Snapshot snapshot(const Domain& domain, double t) {
    Snapshot at = without_tree(domain, t);
    for (std::size_t body = 0; body < at.shapes.size(); ++body) see_thin_places(at, body);
    plant_tree(at);
    return at;
}

double distance_to_bodies(const Snapshot& at, const Vec3& x) {
    return least_of_bodies(at, x, std::numeric_limits<double>::infinity(), [](double d) { return d; },
                           [&](std::size_t body) { return std::abs(signed_distance(at.shapes[body], x)); });
}

double asked_size(const Snapshot& at, std::size_t body) {
    return body < at.sizes.size() ? at.sizes[body].value_or(at.size.surface) : at.size.surface;
}

double asked_size(const Domain& domain, std::size_t body) {
    return domain.bodies[body].size.value_or(domain.size.surface);
}

double surface_size(const Snapshot& at, std::size_t body) {
    // On equilateral triangles of edge h a regular tet is 0.272 h / height times as large as a prism: 1.6^3
    // of that is allowed, as the tets found differ by a quarter from regular ones in this, by measurement.
    constexpr double most_per_height = 15;
    if (body >= at.layers.size() || !at.layers[body]) return asked_size(at, body);
    const LayerOptions& layer = *at.layers[body];
    const double top = layer.first_height * std::pow(layer.growth, layer.count - 1);
    return std::min(asked_size(at, body), most_per_height * top);
}

double size_at_surface(const Snapshot& at, std::size_t body, const Vec3& on_surface) {
    return std::min(surface_size(at, body), std::max(least_size(at.size), at.local_sizes[body](on_surface)));
}

double surface_size(const Snapshot& at, std::size_t body, const Vec3& x) {
    return has_local_size(at, body) ? size_at_surface(at, body, closest_point(at.shapes[body], x)) : surface_size(at, body);
}

double outward_shift(const Shape& shape, double size) {
    // On equilateral triangles of edge h, a polyhedron inscribed in a ball of radius r lacks 3 h^2 / (8 r^2) of
    // its volume, and is blown up by a third of that; on an ellipsoid by less, by its least radius of curvature.
    // 0.125 in the limit of fine triangles; more on coarse ones, by measurement.
    constexpr double share = 0.15;
    if (shape.surface) return 0;
    return share * size * (size / least_curvature_radius(shape));
}

double largest_size(const Box& box, const SizeField& size) {
    constexpr double most_in_widths = 1.0;
    const Vec3 width = box.max - box.min;
    return std::min(size.far, most_in_widths * std::min({width.x, width.y, width.z}));
}

namespace {

/// How far a place with this signed distance to the body is from where its size begins to rise: its surface; or the
/// shell inside of it, whose triangles are smaller than those of the wall, while those of a shell outside are larger.
double rising_distance(const Snapshot& at, std::size_t body, double from_wall) {
    const bool in_layered =
        from_wall < 0 && body < at.layers.size() && at.layers[body] && has_inside(*at.layers[body]);
    return in_layered ? std::max(0.0, -from_wall - thickness(*at.layers[body])) : std::abs(from_wall);
}

bool has_layer(const Snapshot& at, std::size_t body) { return body < at.layers.size() && at.layers[body]; }

/// To those that the body does not reach through: at these there is no gap.
double distance_to_walls(const Snapshot& at, const Vec3& x, std::size_t body) {
    double nearest = at.walls ? std::sqrt(at.walls->nearest(x).squared_distance) : std::numeric_limits<double>::infinity();
    const unsigned reached = body < at.shapes.size() ? reached_faces(at.shapes[body]) : 0;
    for (int face = 0; face < box_faces; ++face) {
        const int axis = face / 2;
        if (reaches(reached, face)) continue;
        nearest = std::min(nearest, face % 2 == 0 ? x[axis] - at.box.min[axis] : at.box.max[axis] - x[axis]);
    }
    return std::max(0.0, nearest);
}

/// What is near a place: bodies, and the one that it is in.
struct Surrounded {
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    double nearest = std::numeric_limits<double>::infinity(), next = nearest;  // bodies without layers [m]
    double depth = 0;                                                          // in the body `within` [m]
    std::size_t within = none, beside = none;                                  // beside: the nearest

    void see(const Snapshot& at, std::size_t body, double signed_distance) {
        if (signed_distance < 0) {
            depth = -signed_distance;
            within = body;
        }
        if (has_layer(at, body)) return;
        const double d = std::abs(signed_distance);
        next = std::min(next, std::max(nearest, d));
        if (d < nearest) beside = body;
        nearest = std::min(nearest, d);
    }
};

double gap_width(const Snapshot& at, const Vec3& x, const Surrounded& by) {
    if (by.within == Surrounded::none) return by.nearest + std::min(by.next, distance_to_walls(at, x, by.beside));
    if (has_layer(at, by.within)) return std::numeric_limits<double>::infinity();
    const Vec3 on_surface = closest_point(at.shapes[by.within], x);
    double nearest = distance_to_walls(at, on_surface, by.within);
    for (std::size_t body = 0; body < at.shapes.size(); ++body)
        if (body != by.within && !has_layer(at, body))
            nearest = std::min(nearest, std::max(0.0, signed_distance(at.shapes[body], on_surface)));
    return nearest;
}

}  // namespace

bool has_narrow_gap(const Snapshot& at) {
    if (least_size(at.size) >= at.size.surface) return false;
    const double narrow = narrow_gap * at.size.surface;
    std::vector<std::size_t> bodies;
    std::vector<Bounds> held;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        if (has_layer(at, body)) continue;
        bodies.push_back(body);
        const Bounds& here = held.emplace_back(bounds(at.shapes[body]));
        for (int wall = 0; wall < box_faces; ++wall)
            if (wall_gap(at.box, at.shapes[body], here, wall) < narrow) return true;
        if (at.walls && gap_between(at.shapes[body], *at.walls) < narrow) return true;
    }
    return std::ranges::any_of(pairs_within(held, narrow), [&](const auto& pair) {
        return gap_between(at.shapes[bodies[pair.first]], at.shapes[bodies[pair.second]]) < narrow;
    });
}

std::vector<char> are_in_gaps(const Snapshot& at) {
    std::vector<char> in_gap(at.shapes.size(), 0);
    std::vector<Bounds> held;
    double widest = 0;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        const double narrow = surface_size(at, body) / gap_share;
        const Bounds& here = held.emplace_back(bounds(at.shapes[body]));
        widest = std::max(widest, narrow);
        for (int wall = 0; wall < box_faces; ++wall)
            if (wall_gap(at.box, at.shapes[body], here, wall) < narrow) in_gap[body] = 1;
        if (at.walls && gap_between(at.shapes[body], *at.walls) < narrow) in_gap[body] = 1;
    }
    for (const auto& [a, b] : pairs_within(held, widest)) in_gap[a] = in_gap[b] = 1;
    return in_gap;
}

double gap_width(const Snapshot& at, const Vec3& x) {
    Surrounded by;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) by.see(at, body, signed_distance(at.shapes[body], x));
    return gap_width(at, x, by);
}

namespace {

/// Where gaps are narrow, of what the bodies' sizes are.
double size_in_gap(const Snapshot& at, const Vec3& x, double size) {
    Surrounded by;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) by.see(at, body, signed_distance(at.shapes[body], x));
    if (gap_share * by.nearest >= size + at.size.growth * by.depth) return size;
    return std::min(size, std::max(least_size(at.size), gap_share * gap_width(at, x, by)) + at.size.growth * by.depth);
}

}  // namespace

double target_size(const Snapshot& at, const DistancesFrom& distances) {
    const double size = least_of_bodies(at, distances.place(), largest_size(at.box, at.size),
                           [&](double d) { return at.tree->least_size + at.size.growth * d; },
                           [&](std::size_t body) {
                               const double rise = at.size.growth * rising_distance(at, body, distances(body));
                               return distances.surface_size(body) + rise;
                           });
    return at.narrow ? size_in_gap(at, distances.place(), size) : size;
}

double target_size(const Snapshot& at, const Vec3& x) { return target_size(at, DistancesFrom(at, x)); }

}  // namespace kropla
