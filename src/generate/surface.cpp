// Triangulated surfaces of ellipsoids.
//
// As many points as the area asks for are scattered by relaxed dart throwing [McCool, Fiume 1992,
// "Hierarchical Poisson disk sampling distributions"] and joined by the hull of them all; then the skin is
// relaxed (skin.cpp), and at last scaled: a polyhedron inscribed in an ellipsoid lacks a part of its volume,
// and a similar one keeps the shapes of all triangles.

#include "base/random.h"
#include <kropla/generate/generate.h>
#include "generate/resample.h"
#include "generate/sampling.h"
#include "generate/skin.h"
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace kropla {

namespace {

/// How much the unit sphere's surface is stretched in its point `n` where it becomes the ellipsoid's [m^2].
double stretch(const Vec3& a, const Vec3& n) {
    return norm({a.y * a.z * n.x, a.x * a.z * n.y, a.x * a.y * n.z});
}

/// The place of the shape's surface that the point `n` of the unit sphere becomes.
Vec3 place_of(const Shape& shape, const Vec3& n) {
    const Vec3& a = shape.semi_axes;
    return shape.centre + rotated(shape.orientation, {a.x * n.x, a.y * n.y, a.z * n.z});
}

/// How many surfaces of triangles of the largest size have as many triangles: with one size, the area [m^2]. By the midpoint
/// rule on bands of equal height; for axes of 10 : 1, right to 0.1 %.
double area_of_largest(const Shape& shape, const SurfaceSize& size) {
    constexpr int bands = 100, steps = 100;
    double sum = 0;
    for (int i = 0; i < bands; ++i)
        for (int k = 0; k < steps; ++k) {
            const double z = (2 * i + 1.0) / bands - 1, r = std::sqrt(1 - z * z);
            const double turn = 2 * std::numbers::pi * (k + 0.5) / steps;
            const Vec3 n = {r * std::cos(turn), r * std::sin(turn), z};
            const double finer = size.local ? size.most / size.local(place_of(shape, n)) : 1;
            sum += stretch(shape.semi_axes, n) * finer * finer;
        }
    return 4 * std::numbers::pi * sum / (bands * steps);
}

/// A random point of the surface, evenly by area.
Vec3 random_surface_point(const Shape& shape, Random& random) {
    const Vec3& a = shape.semi_axes;
    const double most = std::max({a.y * a.z, a.x * a.z, a.x * a.y});
    for (;;) {
        const double z = random.uniform(-1, 1), turn = 2 * std::numbers::pi * random.uniform();
        const double r = std::sqrt(1 - z * z);
        const Vec3 n = {r * std::cos(turn), r * std::sin(turn), z};
        if (random.uniform() * most <= stretch(a, n))
            return place_of(shape, n);
    }
}

/// `count` points of the surface as far apart as darts will have it, by the size where they are: the distance kept falls
/// with each failure. Places are drawn evenly by area; where sizes are small, more darts find room.
std::vector<Vec3> scatter(const Shape& shape, int count, const SurfaceSize& size, Random& random, const Watch* watch) {
    const double fall = 1 - 0.02 / count;  // per failure: some ten darts are thrown per point
    std::vector<Vec3> points;
    PointGrid taken;
    for (double apart = size.most; static_cast<int>(points.size()) < count;) {
        heed(watch);
        const Vec3 x = random_surface_point(shape, random);
        const double here = size(x);
        if (taken.any_within(x, apart * (here / size.most), 0.5 * here, 2 * here)) {
            apart *= fall;
        } else {
            taken.insert(x, here);
            points.push_back(x);
        }
    }
    return points;
}

/// The hull of points on the surface: with a point inside among them, all tets stand on it and none is flat.
Surface hull(const std::vector<Vec3>& points, const Vec3& inside, const Watch* watch) {
    std::vector<Vec3> all = {inside};
    all.insert(all.end(), points.begin(), points.end());
    const Triangulation filled = triangulate(all, watch);
    Surface surface{points, {}};
    for (Tet t : filled.tets.indices())
        for (std::size_t i = 0; i < 4; ++i) {
            if (filled.neighbour[t][i].exists()) continue;
            const auto corner = [&](std::size_t k) {
                return filled.tets[t][static_cast<std::size_t>(tet_facets[i][k])].value - 1;
            };
            surface.triangles.push_back({corner(0), corner(1), corner(2)});
        }
    return surface;
}

}  // namespace

double enclosed_volume(const Surface& surface, const Vec3& inside) {
    double sum = 0, lost = 0;
    for (const auto& [i, j, k] : surface.triangles) {
        const auto place = [&](int p) { return surface.points[static_cast<std::size_t>(p)] - inside; };
        const double part = determinant(place(i), place(j), place(k)) / 6, next = sum + part;
        lost += std::abs(sum) >= std::abs(part) ? (sum - next) + part : (part - next) + sum;
        sum = next;
    }
    return sum + lost;
}

void give_volume(Surface& surface, const Shape& shape) {
    const double factor = std::cbrt(volume(shape) / enclosed_volume(surface, shape.centre));
    for (Vec3& x : surface.points) x = shape.centre + factor * (x - shape.centre);
}

std::vector<Added> refine_surface(Surface& surface, const std::vector<std::size_t>& triangles, const Shape& shape) {
    if (shape.surface) return refine(surface, triangles, shape);
    const Shape on_wall = through(shape, surface.points.front());
    Skin skin = make_skin(surface, on_wall.centre);
    const Skin before = skin;
    std::vector<Added> all;
    for (std::size_t i : triangles) {
        const Triangle triangle(i);
        if (skin.triangles[triangle] != before.triangles[triangle])
            continue;  // split from across an edge of it
        const Vertex added = split_longest_edge(skin, on_wall, triangle);
        all.push_back({skin.points[added], distance(skin.points[added], skin.points[skin.triangles[triangle][0]])});
    }
    flip_edges(skin);
    surface = surface_of(skin);
    give_volume(surface, shape);
    return all;
}

Surface triangulate_surface(const Shape& shape, const SurfaceSize& size, std::uint64_t seed, const Watch* watch) {
    if (shape.surface) return resampled(shape, size, watch);
    assert(size.most > 0 && size.most <= least_curvature_radius(shape));
    // Equilateral triangles of edge h have 0.866 h^2 of area per vertex.
    const double wanted = area_of_largest(shape, size) / (std::sqrt(0.75) * size.most * size.most);
    Random random{seed};
    const std::vector<Vec3> points = scatter(shape, static_cast<int>(std::lround(wanted)), size, random, watch);
    Skin skin = make_skin(hull(points, shape.centre, watch), shape.centre);
    relax_skin(skin, shape, size, watch);
    Surface surface = surface_of(skin);
    give_volume(surface, shape);
    return surface;
}

}  // namespace kropla
