// May the bodies stand where they stand, and go where they go?

#include "base/error.h"
#include "domain/domain.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <optional>

namespace kropla {

namespace {

std::string written(double value, const char* unit) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3g %s", value, unit);
    return text;
}
std::string metres(double value) { return written(value, "m"); }

/// `value` > 0 with two digits, rounded down: what is advised shall really do.
double rounded_down(double value) {
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::floor(value / digit) * digit;
}

std::string named(const Body& body) { return "body \"" + body.name + "\""; }

/// "... too close for size.surface = 0.0002 m; at most 4.1e-05 m would do"
std::string size_advice(double surface_size, double would_do) {
    return " for size.surface = " + metres(surface_size) + "; at most " + metres(rounded_down(would_do)) +
           " would do";
}

/// A side of a body and the face of the box towards which it looks.
struct WallGap {
    int axis;
    bool at_min;
    double body, wall;  // coordinate along the axis [m]
    [[nodiscard]] double gap() const { return at_min ? body - wall : wall - body; }
};

WallGap narrowest_wall_gap(const Box& box, const Shape& shape) {
    const Bounds held = bounds(shape);
    std::optional<WallGap> narrowest;
    for (int axis = 0; axis < 3; ++axis) {
        for (const WallGap& w : {WallGap{axis, true, held.min[axis], box.min[axis]},
                                 WallGap{axis, false, held.max[axis], box.max[axis]}}) {
            if (!narrowest || w.gap() < narrowest->gap()) narrowest = w;
        }
    }
    return *narrowest;
}

/// "its lowest z is -0.00012 m, the box begins at 0 m"
std::string overstep(const WallGap& w) {
    return std::string("its ") + (w.at_min ? "lowest " : "highest ") + "xyz"[w.axis] + " is " +
           metres(w.body) + ", the box " + (w.at_min ? "begins" : "ends") + " at " + metres(w.wall);
}

void check_curvature(const Body& body, const Shape& shape, double surface_size) {
    const double least_radius = least_curvature_radius(shape);
    if (surface_size <= least_radius) return;
    throw DomainError(named(body) + " is curved with a radius of " + metres(least_radius) + ", too little" +
                      size_advice(surface_size, least_radius));
}

/// The gap that is needed beside bodies [m]: `least_gap` surface sizes between their polyhedra.
struct NeededGap {
    double least_gap;     // [sizes]
    double surface_size;  // [m]
    double shift;         // [m] how far the polyhedra stand out of the shapes, together

    [[nodiscard]] double width() const { return least_gap * surface_size + shift; }
    /// The largest surface size for which `gap` would do; the shift grows with its square.
    [[nodiscard]] double size_for(double gap) const {
        const double per_square = shift / (surface_size * surface_size);
        return 2 * gap / (least_gap + std::sqrt(least_gap * least_gap + 4 * per_square * gap));
    }
};

void check_wall_gap(const Body& body, const Shape& shape, const Box& box, const NeededGap& needed) {
    const WallGap w = narrowest_wall_gap(box, shape);
    if (w.gap() < 0) throw DomainError(named(body) + " is not inside the box: " + overstep(w));
    if (w.gap() >= needed.width()) return;
    const std::string wall = std::string("the wall ") + "xyz"[w.axis] + (w.at_min ? " min" : " max");
    if (w.gap() == 0) throw DomainError(named(body) + " touches " + wall);
    throw DomainError(named(body) + " is " + metres(w.gap()) + " from " + wall + ", too close" +
                      size_advice(needed.surface_size, needed.size_for(w.gap())));
}

void check_gap(const Body& a, const Body& b, double gap, const NeededGap& needed) {
    if (gap >= needed.width() && gap > 0) return;
    const std::string both = named(a) + " and " + named(b);
    if (gap == 0) throw DomainError(both + " overlap");
    throw DomainError(both + " are " + metres(gap) + " apart, too close" +
                      size_advice(needed.surface_size, needed.size_for(gap)));
}

bool is_finite(const Pose& pose) {
    return kropla::is_finite(pose.displacement) &&
           std::ranges::all_of(pose.rotation.axes, [](const Vec3& axis) { return kropla::is_finite(axis); });
}

std::vector<Shape> shapes_on_path(const Domain& domain, double t) {
    std::vector<Shape> shapes;
    for (const Body& body : domain.bodies) {
        const Pose pose = body.motion(t);
        if (!is_finite(pose))
            throw DomainError(named(body) + ": motion is not a number at t = " + written(t, "s"));
        shapes.push_back(placed(body.shape, pose));
        const WallGap w = narrowest_wall_gap(domain.box, shapes.back());
        if (w.gap() < 0)
            throw DomainError(named(body) + ": motion takes it out of the box at t = " + written(t, "s") +
                              ": " + overstep(w));
    }
    return shapes;
}

}  // namespace

void check_placement(const Domain& domain, double t, double least_gap) {
    assert(domain.size.surface > 0 && domain.size.far >= domain.size.surface && domain.size.growth >= 0);
    const Snapshot at = snapshot(domain, t);
    std::vector<double> shifts;
    for (std::size_t i = 0; i < at.shapes.size(); ++i) {
        assert(is_finite(at.shapes[i].centre) && at.shapes[i].semi_axes.x > 0 &&
               at.shapes[i].semi_axes.y > 0 && at.shapes[i].semi_axes.z > 0);
        check_curvature(domain.bodies[i], at.shapes[i], domain.size.surface);
        shifts.push_back(outward_shift(at.shapes[i], domain.size.surface));
        check_wall_gap(domain.bodies[i], at.shapes[i], domain.box,
                       {least_gap, domain.size.surface, shifts[i]});
        for (std::size_t j = 0; j < i; ++j)
            check_gap(domain.bodies[j], domain.bodies[i], gap_between(at.shapes[j], at.shapes[i]),
                      {least_gap, domain.size.surface, shifts[i] + shifts[j]});
    }
}

void check_paths(const Domain& domain, double start, double end, int samples, const Watch* watch) {
    assert(samples >= 2);
    for (int k = 0; k < samples; ++k) {
        heed(watch);
        const double t = start + (end - start) * k / (samples - 1);
        const std::vector<Shape> shapes = shapes_on_path(domain, t);
        for (std::size_t i = 0; i < shapes.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (gap_between(shapes[j], shapes[i]) == 0)
                    throw DomainError(named(domain.bodies[j]) + " and " + named(domain.bodies[i]) +
                                      ": motion takes them into each other at t = " + written(t, "s"));
    }
}

}  // namespace kropla
