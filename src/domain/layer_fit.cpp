// Do the layers fit where the bodies stand at the start?

#include <kropla/base/error.h>
#include "domain/approach.h"
#include "domain/layer_room.h"
#include <kropla/mesh/prisms.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kropla {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// "; the largest layer that fits is 3.3e-05 m thick: layer.first_height of at most 5.3e-06 m, or ..."
std::string advice(const LayerOptions& layer, double room) {
    if (!std::isfinite(room)) return "";
    if (!(room > 0)) return "; none fits: a smaller size.surface may do, or bodies farther apart";
    std::string text = "; the largest layer that fits is " + metres(rounded_down(room)) + " thick";
    const double height = layer.first_height * (room / thickness(layer)),
                 growth = fitting_growth(layer, room);  // below 1 it is no advice
    if (height > 0) text += ", by layer.first_height of at most " + metres(rounded_down(height));
    if (layer.count > 1 && growth >= 1)
        text += (height > 0 ? " or" : ", by") + std::string(" layer.growth of at most ") +
                written(rounded_down(growth));
    return text;
}

struct Nearby {
    double gap;   // [m]
    double room;  // [m] for a layer as it was asked for
    double both;  // [m] how thick the layers in the gap would be together
    std::string name;
};

std::vector<Nearby> nearby(const Domain& domain, const Snapshot& at, std::size_t body) {
    const double own = thickness(*at.layers[body]);
    const auto out = [&](std::size_t i) { return outward_shift(at.shapes[i], asked_size(at, i)); };
    const Bounds held = bounds(at.shapes[body]);
    std::vector<Nearby> found;
    for (int wall = 0; wall < 6; ++wall) {
        const double gap = wall_gap(at.box, held, wall);
        found.push_back({gap, share_of_gap * (gap - out(body)), own, wall_name(wall)});
    }
    if (at.walls) {
        const double gap = gap_between(at.shapes[body], *at.walls);
        found.push_back({gap, share_of_gap * (gap - out(body)), own, wall_name(fixed_walls)});
    }
    for (std::size_t other = 0; other < at.shapes.size(); ++other) {
        if (other == body) continue;
        const double gap = gap_between(at.shapes[body], at.shapes[other]);
        const LayerOptions* theirs = layer_at_side(at, other, false);
        found.push_back({gap, (gap - out(body) - out(other)) * (theirs ? share_between_layers : share_of_gap),
                         own + (theirs ? thickness(*theirs) : 0),
                         named(domain.bodies[other])});
    }
    return found;
}

std::string its_layer(const Body& body) { return named(body) + ": its layer"; }

void check_values(const Body& body, double widest) {
    const LayerOptions& layer = *body.layer;
    if (layer.count < 1) throw DomainError(its_layer(body) + " has no prisms: layer.count is below 1");
    if (!(layer.first_height > 0) || !std::isfinite(layer.first_height))
        throw DomainError(its_layer(body) + " needs a positive layer.first_height, got " +
                          metres(layer.first_height) + advice({1, widest, 1}, widest));
    if (!(layer.growth > 0) || !std::isfinite(layer.growth))
        throw DomainError(its_layer(body) + " needs a positive layer.growth, got " +
                          written(layer.growth));
    if (!std::isfinite(thickness(layer)))
        throw DomainError(its_layer(body) + " overflows: its thickness is not a number" +
                          advice(layer, widest));
}

/// The room of a layer outside, and of one inside, as the body stands.
double outer_room(const Domain& domain, const Snapshot& at, std::size_t body) {
    double room = at.box.max.x - at.box.min.x;
    for (const Nearby& n : nearby(domain, at, body)) room = std::min(room, n.room);
    return room;
}
double inner_room(const Shape& shape) { return share_inside * least_curvature_radius(shape); }

void check_outside(const Domain& domain, const Snapshot& at, std::size_t body) {
    const LayerOptions& layer = *at.layers[body];
    for (const Nearby& n : nearby(domain, at, body)) {
        const std::string gap = "the gap of " + metres(n.gap) + " to " + n.name;
        if (n.gap < least_gap(layer))
            throw DomainError(its_layer(domain.bodies[body]) + " has no room: " + gap +
                              " is below layer.min_gap = " + metres(least_gap(layer)));
        if (n.both > n.gap)
            throw DomainError(its_layer(domain.bodies[body]) + " is " + metres(thickness(layer)) +
                              " thick, too much for " + gap + advice(layer, outer_room(domain, at, body)));
    }
}

void check_inside(const Body& body, const Shape& shape) {
    if (thickness(*body.layer) <= least_curvature_radius(shape)) return;
    throw DomainError(its_layer(body) + " inside is " + metres(thickness(*body.layer)) +
                      " thick, too much for a body that is curved with a radius of " +
                      metres(least_curvature_radius(shape)) + advice(*body.layer, inner_room(shape)));
}

}  // namespace

double fitting_growth(LayerOptions layer, double room) {
    if (!(layer.first_height > 0) || layer.first_height > room) return 0;
    // The last prism alone is below the room.
    double fits = 0, too_much = std::pow(room / layer.first_height, 1.0 / std::max(1, layer.count - 1));
    for (int i = 0; i < 60; ++i) {
        layer.growth = (fits + too_much) / 2;
        (thickness(layer) <= room ? fits : too_much) = layer.growth;
    }
    return fits;
}

double room_for_layer(const Domain& domain, std::size_t body, double t) {
    const Snapshot at = snapshot(domain, t);
    const LayerOptions& layer = *at.layers.at(body);
    const double inner = has_inside(layer) ? inner_room(at.shapes[body]) : infinity;
    return has_outside(layer) ? std::min(inner, outer_room(domain, at, body)) : inner;
}

void check_layers(const Domain& domain, double t) {
    const Snapshot at = snapshot(domain, t);
    int layers = 0;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        const Body& b = domain.bodies[body];
        if (!b.layer) continue;
        check_values(b, room_for_layer(domain, body, t));
        if (has_outside(*b.layer)) check_outside(domain, at, body);
        if (has_inside(*b.layer)) check_inside(b, at.shapes[body]);
        layers += has_outside(*b.layer) + has_inside(*b.layer);
    }
    if (layers > most_layers)
        throw DomainError("there are " + std::to_string(layers) + " layers, a mesh has " +
                          std::to_string(most_layers) + " at most; one on both sides of a body counts twice");
}

}  // namespace kropla
