// Triangles split along the planes of the box's faces, one plane after the other: a triangle across one becomes the parts of
// its polygon on either side. Where an edge meets the plane is told once per edge, from its lower point, so that the parts
// fit; the coordinate across the plane is the plane's own, exactly.

#include "domain/cut.h"

#include <kropla/base/error.h>
#include <kropla/domain/solids.h>
#include <kropla/domain/words.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

namespace kropla {

namespace {

/// Are all the points in the box, or on its faces?
bool is_in(const Bounds& box, const Corners& triangle) {
    return std::ranges::all_of(triangle, [&](const Vec3& x) {
        for (int axis = 0; axis < 3; ++axis)
            if (x[axis] < box.min[axis] || x[axis] > box.max[axis]) return false;
        return true;
    });
}

/// [of the box's width] points nearer to a plane are put on it.
constexpr double on_plane = 1e-9;

using Triangle = std::array<int, 3>;

struct Triangles {
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
};

double plane_of(const Bounds& box, int face) { return face % 2 == 0 ? box.min[face / 2] : box.max[face / 2]; }

/// A point that is all but in a plane is put there.
void snap(Vec3& x, const Bounds& box) {
    for (int face = 0; face < box_faces; ++face) {
        const int axis = face / 2;
        const double plane = plane_of(box, face);
        if (std::abs(x[axis] - plane) <= on_plane * (box.max[axis] - box.min[axis])) x[axis] = plane;
    }
}

bool touches_face(const Bounds& box, const Corners& triangle) {
    return std::ranges::any_of(triangle, [&](const Vec3& x) {
        for (int face = 0; face < box_faces; ++face)
            if (x[face / 2] == plane_of(box, face)) return true;
        return false;
    });
}

Vec3 normal_of(const Corners& c) { return normalised(cross(c[1] - c[0], c[2] - c[0])); }

/// Splits triangles along the plane of one face.
class Splitting {
public:
    Splitting(Triangles& of, const Bounds& box, int face)
        : of_(of), box_(box), axis_(face / 2), plane_(plane_of(box, face)) {}

    void split() {
        std::vector<Triangle> parts;
        for (const Triangle& t : of_.triangles) split(t, parts);
        of_.triangles = std::move(parts);
    }

private:
    [[nodiscard]] int side(int point) const {
        const double away = of_.points[as_size(point)][axis_] - plane_;
        return away < 0 ? -1 : away > 0 ? 1 : 0;
    }
    int point_on_plane(int a, int b) {
        const auto [low, high] = std::minmax(a, b);
        const auto [known, is_new] = made_.try_emplace({low, high}, static_cast<int>(of_.points.size()));
        if (!is_new) return known->second;
        const Vec3 &p = of_.points[as_size(low)], &q = of_.points[as_size(high)];
        Vec3 x = p + (plane_ - p[axis_]) / (q[axis_] - p[axis_]) * (q - p);
        snap(x, box_);
        x[axis_] = plane_;
        of_.points.push_back(x);
        return known->second;
    }
    void split(const Triangle& t, std::vector<Triangle>& parts) {
        for (int which : {-1, 1}) {
            std::vector<int> polygon;
            bool has_area = false;
            for (std::size_t i = 0; i < 3; ++i) {
                const int a = t[i], b = t[(i + 1) % 3], at = side(a);
                has_area |= at == which;
                if (at == which || at == 0) polygon.push_back(a);
                if (at * side(b) < 0) polygon.push_back(point_on_plane(a, b));
            }
            if (has_area) add(polygon, parts);
        }
    }
    /// A triangle, or a quadrangle, by its shorter diagonal.
    void add(const std::vector<int>& p, std::vector<Triangle>& parts) const {
        if (p.size() == 3) {
            parts.push_back({p[0], p[1], p[2]});
            return;
        }
        const auto length = [&](std::size_t i, std::size_t k) {
            return distance(of_.points[as_size(p[i])], of_.points[as_size(p[k])]);
        };
        const std::size_t first = length(0, 2) <= length(1, 3) ? 0 : 1;
        parts.push_back({p[first], p[first + 1], p[first + 2]});
        parts.push_back({p[first], p[first + 2], p[(first + 3) % 4]});
    }

    Triangles& of_;
    const Bounds& box_;
    int axis_;
    double plane_;
    std::map<std::pair<int, int>, int> made_;
};

/// The surface with its points where `place` has them.
template <class Place>
Triangles in_place(const TriangulatedSurface& surface, const Bounds& box, const Place& place) {
    Triangles of;
    for (const Vec3& x : surface.points()) of.points.push_back(place(x));
    of.triangles.assign(surface.triangles().begin(), surface.triangles().end());
    for (Vec3& x : of.points) snap(x, box);
    return of;
}

/// Splits what is on both sides of the box's faces. Is any of it beyond one?
bool split_at_faces(Triangles& all, const Bounds& box) {
    const auto is_beyond = [&](int face) {
        return std::ranges::any_of(all.points, [&](const Vec3& x) {
            const double away = x[face / 2] - plane_of(box, face);
            return face % 2 == 0 ? away < 0 : away > 0;
        });
    };
    bool is_cut = false;
    for (int face = 0; face < box_faces; ++face) {
        if (!is_beyond(face)) continue;
        is_cut = true;
        Splitting(all, box, face).split();
    }
    return is_cut;
}

std::vector<std::array<int, 2>> lines_of(const Triangles& of, const Bounds& box) {
    std::vector<std::array<int, 2>> lines;
    for (const Triangle& t : of.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto [low, high] = std::minmax({t[i], t[(i + 1) % 3]});
            for (int face = 0; face < box_faces; ++face)
                if (of.points[as_size(low)][face / 2] == plane_of(box, face) &&
                    of.points[as_size(high)][face / 2] == plane_of(box, face))
                    lines.push_back({low, high});
        }
    std::ranges::sort(lines);
    lines.erase(std::unique(lines.begin(), lines.end()), lines.end());
    return lines;
}

}  // namespace

PartInBox part_in(const Bounds& box, std::span<const Vec3> points, std::span<const std::array<int, 3>> triangles) {
    PartInBox part{{}, {}, std::vector<int>(points.size(), -1)};
    for (const Triangle& t : triangles) {
        const auto place = [&](std::size_t i) { return points[as_size(t[i])]; };
        if (!is_in(box, {place(0), place(1), place(2)})) continue;
        Triangle& kept = part.triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            int& n = part.number[as_size(t[i])];
            if (n < 0) {
                n = static_cast<int>(part.points.size());
                part.points.push_back(place(i));
            }
            kept[i] = n;
        }
    }
    return part;
}

std::optional<TriangleOnFace> triangle_on_face(const Bounds& box, std::span<const Vec3> points,
                                               std::span<const Triangle> triangles) {
    for (int face = 0; face < box_faces; ++face)
        for (std::size_t t = 0; t < triangles.size(); ++t)
            if (std::ranges::all_of(triangles[t], [&](int p) { return points[as_size(p)][face / 2] == plane_of(box, face); }))
                return TriangleOnFace{t, face};
    return std::nullopt;
}

Shape cut_by(const Box& box, const Shape& shape) {
    const Bounds within{box.min, box.max};
    Triangles all = in_place(*shape.surface, within, [&](const Vec3& x) { return shape.centre + rotated(shape.orientation, x); });
    if (!split_at_faces(all, within)) return shape;
    if (const auto lies = triangle_on_face(within, all.points, all.triangles))
        throw DomainError("a part of its surface lies in " + wall_name(lies->face) + ", at " +
                          place_words(all.points[as_size(all.triangles[lies->triangle][0])]) +
                          "; it is to end before, or to reach through");
    PartInBox part = part_in(within, all.points, all.triangles);
    if (part.triangles.empty()) throw DomainError("nothing of its surface is in the box");
    Shape cut = shape_of_facets(std::move(part.points), std::move(part.triangles), &within);
    const auto lines = lines_of(all, within);
    cut.cut = std::make_shared<const CutSurface>(
        CutSurface{make_surface(std::move(all.points), std::move(all.triangles)), lines, within});
    return cut;
}

Body keep_edges(Body body) {
    constexpr double part = 0.8;  // of a crease's angle, to which it may be bent
    const Shape& shape = body.shape;
    if (!shape.surface) return body;
    const double least = (shape.cut ? shape.cut->whole : *shape.surface).least_crease();
    body.sharp = std::max(blunt, std::cos(std::min(part * least, std::numbers::pi)));
    return body;
}

Body cut_body(Body body) {
    if (reached_faces(body.shape) == 0 || body.deformation) return body;
    body = keep_edges(std::move(body));
    body.deformation = [motion = body.motion, centre = body.shape.centre](const Vec3& x, double t0, double t1) {
        const Pose from = motion(t0), to = motion(t1);
        if (from.displacement == to.displacement && from.rotation.axes == to.rotation.axes) return x;
        const Vec3 in_body = rotated_back(from.rotation, x - centre - from.displacement);
        return centre + to.displacement + rotated(to.rotation, in_body);
    };
    body.motion = [](double) { return Pose{}; };
    return body;
}

StandsInBox stands_in_box(const Body& body, double t) {
    const CutSurface& cut = *body.shape.cut;
    Triangles all = in_place(cut.whole, cut.box, [&](const Vec3& x) { return body.deformation(x, 0, t); });
    (void)split_at_faces(all, cut.box);
    const PartInBox part = part_in(cut.box, all.points, all.triangles);
    StandsInBox stands{0, !part.triangles.empty()};
    for (const Vec3& x : part.points)
        for (int face = 0; face < box_faces; ++face)
            if (x[face / 2] == plane_of(cut.box, face)) stands.faces |= 1u << face;
    for (const Vec3& x : all.points)
        for (int face = 0; face < box_faces; ++face) {
            const double plane = plane_of(cut.box, face);
            if (face % 2 == 0 ? x[face / 2] < plane : x[face / 2] > plane) stands.beyond |= 1u << face;
        }
    return stands;
}

void check_upright(const Body& body, double t) {
    constexpr double upright = 1e-6;  // [-] cosine of the angle between surface and face
    const CutSurface& cut = *body.shape.cut;
    for (std::size_t i = 0; i < cut.whole.triangles().size(); ++i) {
        const Corners c = cut.whole.tree().corners(i);
        if (!is_in(cut.box, c) || !touches_face(cut.box, c)) continue;
        Corners moved;
        std::ranges::transform(c, moved.begin(), [&](const Vec3& x) { return body.deformation(x, 0, t); });
        const Vec3 before = normal_of(c), after = normal_of(moved);
        for (int face = 0; face < box_faces; ++face) {
            const int axis = face / 2;
            const double width = cut.box.max[axis] - cut.box.min[axis];
            if (std::max(std::abs(before[axis]), std::abs(after[axis])) <= upright) continue;
            for (std::size_t corner = 0; corner < c.size(); ++corner)
                if (const Vec3& x = c[corner];
                    x[axis] == plane_of(cut.box, face) && std::abs(moved[corner][axis] - x[axis]) > on_plane * width)
                    throw DomainError(named(body) + ": at t = " + time_words(t) + " its motion takes it through " +
                                      wall_name(face) + ", on which it does not stand upright at " + place_words(x) +
                                      ": a motion along that wall would do, or one with kind = \"field\"");
        }
    }
}

}  // namespace kropla
