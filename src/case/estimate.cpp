// How many tets a size field asks for. A perfect tet of edge h has the volume h^3 / (6 sqrt 2); the integral
// of its inverse over the box is the count. Near a body the size changes faster than a grid can see, so there
// the grid takes the size no closer than one of its own cells, and what is left out on either side of the
// surface is added in closed form: area times the integral of 1/h^3 over the distance.
#include "case/case.h"
#include "case/local_size.h"
#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

constexpr int cells_across = 32;  // grid cells along the longest side of the box: off by some percent

double size_at(const SizeField& size, double distance) {
    return std::min(size.far, size.surface + size.growth * distance);
}

/// The size field of a body about this place of its surface: it may be finer than others', or than elsewhere.
SizeField size_of(const Snapshot& at, std::size_t body, const Vec3& x) {
    return {surface_size(at, body, x), at.size.growth, at.size.far};
}

/// The places of the body's surface that stand for all of it.
std::vector<Vec3> places_of(const Snapshot& at, std::size_t body) {
    return has_local_size(at, body) ? places_on(at.shapes[body]) : std::vector{at.shapes[body].centre};
}

/// The target size at `x`, no closer to a body than `cell`.
double coarse_size(const Snapshot& at, const Vec3& x, double cell) {
    double least = at.size.far;
    for (std::size_t body = 0; body < at.shapes.size(); ++body) {
        const double distance = std::abs(signed_distance(at.shapes[body], x));
        least = std::min(least, size_at(size_of(at, body, x), std::max(cell, distance)));
    }
    return least;
}

double per_volume(double edge) { return 6 * std::numbers::sqrt2 / (edge * edge * edge); }

/// The area: of an ellipsoid to 1 percent (Knud Thomsen's formula, p = 1.6075).
double area(const Shape& shape) {
    if (shape.surface) return shape.surface->area();
    const Vec3 s = shape.semi_axes;
    const double p = 1.6075;
    const double mean = (std::pow(s.x * s.y, p) + std::pow(s.x * s.z, p) + std::pow(s.y * s.z, p)) / 3;
    return 4 * std::numbers::pi * std::pow(mean, 1 / p);
}

/// The integral of 1/h^3 from the surface to `depth`, with h growing linearly up to `far`, above its value
/// there.
double excess(const SizeField& size, double depth) {
    const double edge = size_at(size, depth);
    const double grown = size.growth * depth <= size.far - size.surface
                             ? depth
                             : (size.far - size.surface) / size.growth;  // where h reaches far
    const double s = size.surface;
    const double integral = grown * (s + edge) / (2 * s * s * edge * edge);
    return integral - grown / (edge * edge * edge);
}

}  // namespace

double estimate_tets(const Domain& domain) {
    Snapshot at = snapshot(domain, 0);
    at.size.far = largest_size(at.box, at.size);
    const Vec3 span = at.box.max - at.box.min;
    const double cell = std::max({span.x, span.y, span.z}) / cells_across;
    const auto count = [&](double length) { return std::max(1, static_cast<int>(std::ceil(length / cell))); };
    const int nx = count(span.x), ny = count(span.y), nz = count(span.z);
    double sum = 0;
    for (int i = 0; i < nx; ++i) {
        for (int j = 0; j < ny; ++j) {
            for (int k = 0; k < nz; ++k) {
                const Vec3 x = at.box.min + Vec3{(i + 0.5) / nx * span.x, (j + 0.5) / ny * span.y,
                                                 (k + 0.5) / nz * span.z};
                sum += per_volume(coarse_size(at, x, cell));
            }
        }
    }
    double tets = sum * span.x * span.y * span.z / (static_cast<double>(nx) * ny * nz);
    for (std::size_t i = 0; i < at.shapes.size(); ++i) {
        const Shape& body = at.shapes[i];
        const double inside = std::min({cell, body.semi_axes.x, body.semi_axes.y, body.semi_axes.z});
        const std::vector<Vec3> places = places_of(at, i);
        for (const Vec3& x : places) {
            const SizeField size = size_of(at, i, x);
            tets += area(body) / static_cast<double>(places.size()) * (excess(size, cell) + excess(size, inside)) * per_volume(1);
        }
    }
    return tets;
}

}  // namespace kropla
