// Blocks, cylinders and ellipsoids that are cut, as surfaces of triangles.

#include <kropla/domain/solids.h>

#include <kropla/base/error.h>
#include "domain/triangulated_surface.h"
#include <kropla/domain/words.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace kropla {

namespace {

/// [of the box's width] how far what reaches through a face is taken to go on behind it: more than a triangle there.
constexpr double beyond = 0.1;
/// [of the box's width] what ends nearer to a face ends in it.
constexpr double in_face = 1e-9;
/// of a cylinder: the polygon's corners stand out of the circle, and its middles within, by less than 5e-4 radii.
constexpr int sides = 90;
/// [of a side] from ring to ring of the mantle: of long thin triangles good ones are not easily made (generate/resample.h).
constexpr double ring_spacing = 4;

/// A triangle of the block by its corners 0 ... 7, of which bit `axis` tells the side along that axis.
constexpr std::array<std::array<int, 3>, 12> of_block = {{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}}};

/// By how much the end of a cylinder at `end`, whose axis goes on along `outwards`, is to go on so that all of its disc is
/// beyond the faces in which its middle is, or beyond them already; negative where it goes on far behind them.
double going_on(const Box& box, const Vec3& end, const Vec3& outwards, double radius) {
    double most = -std::numeric_limits<double>::infinity();
    for (int face = 0; face < box_faces; ++face) {
        const int axis = face / 2;
        const double width = box.max[axis] - box.min[axis], sign = face % 2 == 0 ? -1 : 1;
        const double past = sign * (end[axis] - (face % 2 == 0 ? box.min[axis] : box.max[axis]));
        const double slope = sign * outwards[axis];
        if (past < -in_face * width || !(slope > 0)) continue;
        const double reach = radius * std::sqrt(std::max(0.0, 1 - slope * slope));
        most = std::max(most, (beyond * width + reach - past) / slope);
    }
    return std::isfinite(most) ? most : 0;
}

/// The unit sphere in triangles, those of an octahedron divided: planes through its centre along the axes go along edges.
class FacetedSphere {
public:
    static constexpr int division = 32;  // of a quarter of a turn

    FacetedSphere() {
        for (const int x : {-1, 1})
            for (const int y : {-1, 1})
                for (const int z : {-1, 1}) add_octant({x, y, z});
    }
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;

private:
    using Step = std::array<int, 3>;  // along the axes, `division` in all

    int point(const Step& octant, const Step& at) {
        const Step signed_at = {octant[0] * at[0], octant[1] * at[1], octant[2] * at[2]};
        const auto [known, is_new] = made_.try_emplace(signed_at, static_cast<int>(points.size()));
        if (is_new) {
            Vec3 x;
            for (int axis = 0; axis < 3; ++axis)
                x[axis] = std::sin(signed_at[as_size(axis)] * std::numbers::pi / (2 * division));  // for even triangles
            points.push_back(normalised(x));
        }
        return known->second;
    }
    void add(const Step& octant, const Step& a, const Step& b, const Step& c) {
        const bool turned = octant[0] * octant[1] * octant[2] < 0;
        triangles.push_back({point(octant, a), point(octant, turned ? c : b), point(octant, turned ? b : c)});
    }
    void add_octant(const Step& octant) {
        for (int i = 0; i < division; ++i)
            for (int k = 0; i + k < division; ++k) {
                const int m = division - 1 - i - k;
                add(octant, {i + 1, k, m}, {i, k + 1, m}, {i, k, m + 1});
                if (m > 0) add(octant, {i, k + 1, m}, {i + 1, k, m}, {i + 1, k + 1, m - 1});
            }
    }

    std::map<Step, int> made_;
};

}  // namespace

Shape cut_ellipsoid(const Box& box, const Shape& ellipsoid) {
    FacetedSphere sphere;
    for (Vec3& x : sphere.points) {
        for (int axis = 0; axis < 3; ++axis) x[axis] *= ellipsoid.semi_axes[axis];
        x = ellipsoid.centre + rotated(ellipsoid.orientation, x);
    }
    Shape cut = cut_by(box, shape_within(std::move(sphere.points), sphere.triangles));
    if (!cut.cut) return ellipsoid;
    cut.resolved = least_curvature_radius(ellipsoid);
    return cut;
}

Shape slab(const Box& box, const Vec3& min, const Vec3& max) {
    Vec3 low = min, high = max;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(min[axis] < max[axis]))
            throw DomainError(std::string("its min is not below its max along ") + "xyz"[axis] + ": " + metres(min[axis]) +
                              " and " + metres(max[axis]));
        const double width = box.max[axis] - box.min[axis];
        if (min[axis] <= box.min[axis] + in_face * width) low[axis] = box.min[axis] - beyond * width;
        if (max[axis] >= box.max[axis] - in_face * width) high[axis] = box.max[axis] + beyond * width;
    }
    std::vector<Vec3> points;
    for (int corner = 0; corner < 8; ++corner)
        points.push_back({(corner & 1) != 0 ? high.x : low.x, (corner & 2) != 0 ? high.y : low.y,
                          (corner & 4) != 0 ? high.z : low.z});
    return cut_by(box, shape_within(std::move(points), {of_block.begin(), of_block.end()}));
}

Shape cylinder(const Box& box, const Vec3& from, const Vec3& to, double radius) {
    if (!(distance(from, to) > 0)) throw DomainError("its two ends are in one place: " + place_words(from));
    const Vec3 along = normalised(to - from);
    const Vec3 start = from - going_on(box, from, -along, radius) * along, end = to + going_on(box, to, along, radius) * along;
    const Vec3 off = std::abs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 u = normalised(cross(along, off)), v = cross(along, u);
    const double turn = 2 * std::numbers::pi / sides;
    const double outer = radius * std::sqrt(turn / std::sin(turn));  // the polygon has the circle's area
    const int rings = 1 + static_cast<int>(std::ceil(distance(start, end) / (ring_spacing * turn * radius)));
    std::vector<Vec3> points = {start, end};
    std::vector<std::array<int, 3>> triangles;
    const auto number = [](int ring, int i) { return 2 + ring * sides + i % sides; };
    for (int ring = 0; ring < rings; ++ring)
        for (int i = 0; i < sides; ++i) {
            const Vec3 out = outer * (std::cos(i * turn) * u + std::sin(i * turn) * v);
            points.push_back(start + static_cast<double>(ring) / (rings - 1) * (end - start) + out);
            if (ring == 0) triangles.push_back({0, number(0, i + 1), number(0, i)});
            else triangles.insert(triangles.end(), {{number(ring - 1, i), number(ring - 1, i + 1), number(ring, i)},
                                                    {number(ring - 1, i + 1), number(ring, i + 1), number(ring, i)}});
            if (ring == rings - 1) triangles.push_back({1, number(ring, i), number(ring, i + 1)});
        }
    Shape shape = cut_by(box, shape_within(std::move(points), triangles));
    shape.resolved = radius;
    return shape;
}

}  // namespace kropla
