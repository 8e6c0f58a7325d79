// Closed surfaces of triangles.
//
// Whether a point is inside is told by the pseudonormal of what is nearest to it, weighted by angles at a corner
// [Baerentzen, Aanaes 2005, "Signed distance computation using the angle weighted pseudonormal"]: right for every
// closed surface, convex or not, also where an edge or a corner is nearest. What part of a triangle is nearest is told
// once, with the nearest place, so that both agree. Of a surface that ends on faces of a box, the normals at its rim are those
// of the surface and its mirror image together, which is closed there: their parts across the face cancel.

#include "domain/triangulated_surface.h"
#include "domain/thin_places.h"

#include <kropla/base/error.h>
#include <kropla/domain/words.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <mutex>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

namespace kropla {

struct FoundThinPlaces {
    struct Of {
        double least, most;  // [m]
        std::shared_ptr<const ThinPlaces> places;
    };
    std::mutex busy;
    std::vector<Of> known;
};

namespace {

using Triangle = std::array<int, 3>;

constexpr std::size_t next(std::size_t corner) { return (corner + 1) % 3; }

/// Triangles that are looked at before they become a surface.
struct Draft {
    std::span<const Vec3> points;
    std::span<Triangle> triangles;

    [[nodiscard]] const Vec3& corner(std::size_t t, std::size_t i) const { return points[as_size(triangles[t][i])]; }
    [[nodiscard]] Corners corners(std::size_t t) const { return {corner(t, 0), corner(t, 1), corner(t, 2)}; }
};

Vec3 twice_area(const Corners& t) { return cross(t[1] - t[0], t[2] - t[0]); }

[[noreturn]] void refuse(const std::string& what, std::vector<std::size_t> triangles = {}) {
    throw SurfaceError("the surface " + what, std::move(triangles));
}

/// Faults of one kind, of which the first is told and all are counted.
struct Faults {
    std::string first;
    std::size_t count = 0;
    std::vector<std::size_t> triangles;  // that have them

    void add(std::initializer_list<std::size_t> at, const auto& in_words) {
        if (count++ == 0) first = in_words();
        triangles.insert(triangles.end(), at);
    }
    /// `kind` as in "edges".
    void refuse_any(const std::string& kind) const {
        if (count == 0) return;
        refuse(first + (count > 1 ? "; of such " + kind + " there are " + std::to_string(count) : ""), triangles);
    }
};

std::string triangle_words(const Draft& d, std::size_t t) {
    const auto [a, b, c] = d.corners(t);
    return "triangle " + std::to_string(t) + " at " + place_words((a + b + c) / 3);
}
std::string point_words(const Draft& d, int point) {
    return "point " + std::to_string(point) + " at " + place_words(d.points[as_size(point)]);
}
std::string edge_words(const Draft& d, int a, int b) {
    return "the edge from " + point_words(d, a) + " to " + point_words(d, b);
}

/// May rounding of the corners' coordinates be all that the triangle's height is?
bool is_flat(const Corners& t) {
    double largest = 0, longest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(t[i][axis]));
        longest = std::max(longest, distance(t[i], t[next(i)]));
    }
    return !(norm(twice_area(t)) > 4 * std::numeric_limits<double>::epsilon() * largest * longest);
}

void check_values(const Draft& d) {
    if (d.triangles.empty()) refuse("has no triangles");
    for (std::size_t i = 0; i < d.points.size(); ++i)
        if (!is_finite(d.points[i])) refuse("has a point that is not finite: point " + std::to_string(i));
    for (std::size_t t = 0; t < d.triangles.size(); ++t) {
        for (int corner : d.triangles[t])
            if (corner < 0 || as_size(corner) >= d.points.size())
                refuse("has a triangle " + std::to_string(t) + " with a point " + std::to_string(corner) +
                       ", which does not exist: there are " + std::to_string(d.points.size()));
    }
    Faults flat;
    for (std::size_t t = 0; t < d.triangles.size(); ++t)
        if (is_flat(d.corners(t)))
            flat.add({t}, [&] { return "has a triangle of no area: " + triangle_words(d, t); });
    flat.refuse_any("triangles");
}

/// Per triangle and edge, from corner i to the next, the triangle beyond and its edge.
struct Beyond {
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::size_t triangle = none, edge = 0;
    [[nodiscard]] bool exists() const { return triangle != none; }
};
using Neighbours = std::vector<std::array<Beyond, 3>>;

/// The faces of the box on which both points lie, as bits, of those of each point; none of a surface that is to be closed.
unsigned faces_of_edge(std::span<const unsigned> faces, int a, int b) {
    return faces.empty() ? 0 : faces[as_size(a)] & faces[as_size(b)];
}

/// Edges on a face of the box may be open.
Neighbours neighbours(const Draft& d, std::span<const unsigned> faces) {
    struct Side {
        int low, high;
        std::size_t triangle, edge;
        bool rising;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < d.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const int a = d.triangles[t][i], b = d.triangles[t][next(i)];
            sides.push_back({std::min(a, b), std::max(a, b), t, i, a < b});
        }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(std::pair(s.low, s.high), s.triangle); });
    Neighbours beyond(d.triangles.size());
    Faults open, many, turned;
    for (std::size_t i = 0, end = 0; i < sides.size(); i = end) {
        while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
        const Side& one = sides[i];
        const auto edge = [&] { return edge_words(d, one.low, one.high); };
        if (end - i == 1) {
            if (faces_of_edge(faces, one.low, one.high) != 0) continue;
            open.add({one.triangle}, [&] {
                return "is not closed: " + edge() + " has but one triangle, " + std::to_string(one.triangle);
            });
            continue;
        }
        const Side& other = sides[i + 1];
        if (end - i > 2) {
            many.add({}, [&] { return "is not a manifold: " + edge() + " has " + std::to_string(end - i) + " triangles"; });
            for (std::size_t k = i; k < end; ++k) many.triangles.push_back(sides[k].triangle);
        } else if (one.rising == other.rising) {
            turned.add({one.triangle, other.triangle}, [&] {
                return "has triangles that are turned against each other: " + std::to_string(one.triangle) + " and " +
                       std::to_string(other.triangle) + " at " + edge();
            });
        }
        beyond[one.triangle][one.edge] = {other.triangle, other.edge};
        beyond[other.triangle][other.edge] = {one.triangle, one.edge};
    }
    for (const Faults& faults : {open, many}) faults.refuse_any("edges");
    turned.refuse_any("edges");
    return beyond;
}

/// The triangles around each point are one ring.
void check_rings(const Draft& d, const Neighbours& beyond) {
    std::vector<std::size_t> corners_at(d.points.size(), 0);
    std::vector<char> is_known(d.points.size(), 0);
    Faults touching;
    for (const Triangle& triangle : d.triangles)
        for (int point : triangle) ++corners_at[as_size(point)];
    for (std::size_t t = 0; t < d.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const int point = d.triangles[t][i];
            if (std::exchange(is_known[as_size(point)], 1) != 0) continue;
            std::size_t around = 0;
            Beyond here{t, i};  // the edge that begins at the point
            do {
                const Beyond there = beyond[here.triangle][here.edge];
                here = {there.triangle, next(there.edge)};
                ++around;
            } while (here.triangle != t);
            if (around != corners_at[as_size(point)])
                touching.add({t}, [&] { return "touches itself at " + point_words(d, point); });
        }
    touching.refuse_any("points");
}

/// Per triangle, the number of the connected part it is of.
std::vector<std::size_t> parts_of(const Neighbours& beyond) {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::size_t> part(beyond.size(), none), reached;
    std::size_t parts = 0;
    for (std::size_t first = 0; first < beyond.size(); ++first) {
        if (part[first] != none) continue;
        part[first] = parts;
        reached = {first};
        while (!reached.empty()) {
            const std::size_t t = reached.back();
            reached.pop_back();
            for (const Beyond& b : beyond[t])
                if (b.exists() && std::exchange(part[b.triangle], parts) == none) reached.push_back(b.triangle);
        }
        ++parts;
    }
    return part;
}

bool share_a_corner(const Triangle& a, const Triangle& b) {
    return std::ranges::any_of(a, [&](int corner) { return std::ranges::find(b, corner) != b.end(); });
}

void check_crossings(const Draft& d) {
    std::vector<Extent> boxes;
    for (std::size_t t = 0; t < d.triangles.size(); ++t) boxes.push_back(extent(d.corners(t)));
    const BoxTree tree(boxes);
    Faults cuts;
    for (std::size_t t = 0; t < d.triangles.size(); ++t)
        tree.any(boxes[t], [&](std::size_t other) {
            if (other <= t || share_a_corner(d.triangles[t], d.triangles[other])) return false;
            if (!meet(d.corners(t), d.corners(other))) return false;
            cuts.add({t, other}, [&] {
                const char* how = pierce(d.corners(t), d.corners(other)) ? "cuts itself: " : "cuts or touches itself: ";
                return how + triangle_words(d, t) + " and " + triangle_words(d, other);
            });
            return false;
        });
    cuts.refuse_any("pairs");
}

/// Six times the volume below the triangle, seen from `origin`.
double volume_below(const Corners& t, const Vec3& origin) {
    return determinant(t[0] - origin, t[1] - origin, t[2] - origin);
}

/// A connected part: its triangles, and the box that just holds it.
struct Part {
    std::vector<std::size_t> triangles;
    Extent held;
};
std::vector<Part> parts_with(const Draft& d, const std::vector<std::size_t>& part, std::size_t count) {
    std::vector<Part> parts(count);
    for (std::size_t t = 0; t < part.size(); ++t) {
        parts[part[t]].triangles.push_back(t);
        for (const Vec3& x : d.corners(t)) parts[part[t]].held.take_in(x);
    }
    return parts;
}

/// How often a part goes round `x`, which is not on it: 1 or -1 inside, 0 outside [Van Oosterom, Strackee 1983].
int winding(const Draft& d, const Part& part, const Vec3& x) {
    if (part.held.squared_distance(x) > 0) return 0;
    double angle = 0;
    for (std::size_t t : part.triangles) {
        const Vec3 a = d.corner(t, 0) - x, b = d.corner(t, 1) - x, c = d.corner(t, 2) - x;
        const double u = norm(a), v = norm(b), w = norm(c);
        angle += 2 * std::atan2(determinant(a, b, c), u * v * w + dot(a, b) * w + dot(b, c) * u + dot(c, a) * v);
    }
    return static_cast<int>(std::lround(angle / (4 * std::numbers::pi)));
}

/// The first triangle of each part.
std::vector<std::size_t> first_of_parts(const std::vector<std::size_t>& part) {
    std::vector<std::size_t> first;
    for (std::size_t t = 0; t < part.size(); ++t)
        if (part[t] == first.size()) first.push_back(t);
    return first;
}

/// Turns all round if what they bound is inside out, and returns whether. Then each place is inside once, or outside.
bool turn_out(const Draft& d, const std::vector<std::size_t>& part) {
    const std::vector<std::size_t> first = first_of_parts(part);
    std::vector<double> volume(first.size(), 0);
    for (std::size_t t = 0; t < part.size(); ++t)
        volume[part[t]] += volume_below(d.corners(t), d.corner(first[part[t]], 0));
    const bool turned = std::accumulate(volume.begin(), volume.end(), 0.0) < 0;
    if (turned) {
        for (Triangle& triangle : d.triangles) std::swap(triangle[1], triangle[2]);
        for (double& v : volume) v = -v;
    }
    const std::vector<Part> parts = parts_with(d, part, first.size());
    for (std::size_t p = 0; p < first.size(); ++p) {
        int around = 0;
        for (std::size_t other = 0; other < first.size(); ++other)
            if (other != p) around += winding(d, parts[other], d.corner(first[p], 0));
        if (around == (volume[p] > 0 ? 0 : 1)) continue;
        refuse("has a part that " + std::string(volume[p] > 0 ? "lies within another" : "is inside out") +
               ": that of " + triangle_words(d, first[p]), {first[p]});
    }
    return turned;
}

}  // namespace

TriangulatedSurface::TriangulatedSurface(std::vector<Vec3> points, std::vector<Triangle> triangles)
    : tree_(std::move(points), std::move(triangles)), edge_normal_(this->triangles().size()),
      corner_normal_(this->points().size()) {
    const Vec3 origin = tree_.corners(0)[0];
    Vec3 moment;
    for (std::size_t t = 0; t < this->triangles().size(); ++t) {
        const Corners corners = tree_.corners(t);
        const Vec3 normal = twice_area(corners);
        const double below = volume_below(corners, origin);
        inside_normal_.push_back(normalised(normal));
        area_ += norm(normal) / 2;
        volume_ += below / 6;
        moment += below / 24 * (corners[0] + corners[1] + corners[2] - 3 * origin);
        for (std::size_t i = 0; i < 3; ++i) {
            extent_.take_in(corners[i]);
            farthest_ = std::max(farthest_, norm(corners[i]));
            corner_normal_[as_size(this->triangles()[t][i])] +=
                angle_between(corners[next(i)] - corners[i], corners[next(next(i))] - corners[i]) * inside_normal_[t];
        }
    }
    centroid_ = origin + moment / volume_;
    thin_ = std::make_shared<FoundThinPlaces>();
}

const Vec3& TriangulatedSurface::outwards(const NearestPlace& at) const {
    const auto part = static_cast<std::size_t>(at.part);
    if (part == 0) return inside_normal_[at.triangle];
    if (part <= 3) return edge_normal_[at.triangle][part - 1];
    return corner_normal_[as_size(triangles()[at.triangle][part - 4])];
}

double TriangulatedSurface::signed_distance(const Vec3& x, const NearestPlace& nearest) const {
    const double far = std::sqrt(nearest.squared_distance);
    return dot(x - nearest.point, outwards(nearest)) < 0 ? -far : far;
}

std::shared_ptr<const ThinPlaces> TriangulatedSurface::thin_places(double least, double most) const {
    const std::lock_guard alone(thin_->busy);
    for (const auto& of : thin_->known)
        if (of.least == least && of.most == most) return of.places;
    thin_->known.push_back({least, most, std::make_shared<const ThinPlaces>(*this, least, most)});
    return thin_->known.back().places;
}

namespace {

/// What an open surface bounds together with the faces of the box, on which its points lie as told.
struct Content {
    double volume = 0;
    Vec3 moment;  // about the origin
};

/// An axis with at most one open face across it, or -1.
int axis_of_content(unsigned open) {
    for (int axis = 0; axis < 3; ++axis)
        if ((open >> (2 * axis) & 3u) != 3u) return axis;
    return -1;
}

/// By the flux of (x - face) e through the surface, e an axis of the box with at most one open face across it: there the
/// flux is zero, and along the other faces too [Gauss]. Exact, as the middles of edges integrate quadratic functions. The
/// face opposite is not open: if it is in the body, the flux there is the box's volume, which is more than what was found.
Content content_of_open(const Draft& d, const Bounds& box, unsigned open) {
    const int axis = axis_of_content(open);
    if (axis < 0) refuse("is open at both faces of the box along all three axes");
    const double face = (open >> (2 * axis + 1) & 1u) != 0 ? box.max[axis] : box.min[axis];
    Content content;
    for (std::size_t t = 0; t < d.triangles.size(); ++t) {
        const Corners c = d.corners(t);
        const double flux = twice_area(c)[axis] / 2;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 x = 0.5 * (c[i] + c[next(i)]);
            const double height = x[axis] - face, part = flux / 3 * height;
            content.volume += part;
            for (int k = 0; k < 3; ++k) content.moment[k] += part * (k == axis ? face + height / 2 : x[k]);
        }
    }
    if (content.volume >= 0) return content;
    const Vec3 width = box.max - box.min;
    const double all = width.x * width.y * width.z;
    content.volume += all;
    content.moment += all / 2 * (box.min + box.max);
    return content;
}

/// The faces at which edges are open, as bits.
unsigned open_faces(const Draft& d, const Neighbours& beyond, std::span<const unsigned> faces) {
    unsigned open = 0;
    for (std::size_t t = 0; t < d.triangles.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            if (!beyond[t][i].exists()) open |= faces_of_edge(faces, d.triangles[t][i], d.triangles[t][next(i)]);
    return open;
}

/// Without what of it is across these faces.
Vec3 along_faces(Vec3 normal, unsigned faces) {
    for (int axis = 0; axis < 3; ++axis)
        if ((faces >> (2 * axis) & 3u) != 0) normal[axis] = 0;
    return normal;
}

std::vector<unsigned> faces_of_points(std::span<const Vec3> points, const Bounds& box) {
    std::vector<unsigned> faces(points.size(), 0);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            if (points[i][axis] == box.min[axis]) faces[i] |= 1u << (2 * axis);
            if (points[i][axis] == box.max[axis]) faces[i] |= 2u << (2 * axis);
        }
    return faces;
}

/// The middle of the volume, or of what comes near it where this vanishes.
Vec3 centroid_of(const Draft& d) {
    const Vec3 origin = d.corner(0, 0);
    double volume = 0;
    Vec3 moment;
    for (std::size_t t = 0; t < d.triangles.size(); ++t) {
        const Corners c = d.corners(t);
        const double below = volume_below(c, origin);
        volume += below;
        moment += below / 4 * (c[0] + c[1] + c[2] - 3 * origin);
    }
    return volume > 0 ? origin + moment / volume : origin;
}

}  // namespace

TriangulatedSurface TriangulatedSurface::joined(std::vector<Vec3> points, std::vector<Triangle> triangles,
                                                bool is_checked, std::span<const unsigned> faces) {
    const Draft draft{points, triangles};
    if (is_checked) check_values(draft);
    const Neighbours beyond = neighbours(draft, faces);
    if (is_checked) {
        check_rings(draft, beyond);
        check_crossings(draft);
    }
    const std::vector<std::size_t> part = parts_of(beyond), first = first_of_parts(part);
    const bool turned = is_checked && turn_out(draft, part);
    TriangulatedSurface surface(std::move(points), std::move(triangles));
    for (std::size_t t : first) surface.point_of_parts_.push_back(surface.tree_.corners(t)[0]);
    for (std::size_t t = 0; t < beyond.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {  // turned round, edge 0 is edge 2
            const Vec3& normal = surface.inside_normal_[t];
            const Triangle& corners = surface.triangles()[t];
            surface.edge_normal_[t][turned ? 2 - i : i] =
                beyond[t][i].exists() ? normal + surface.inside_normal_[beyond[t][i].triangle]
                                      : along_faces(normal, faces_of_edge(faces, corners[i], corners[next(i)]));
        }
    for (std::size_t i = 0; i < faces.size(); ++i)
        surface.corner_normal_[i] = along_faces(surface.corner_normal_[i], faces[i]);
    return surface;
}

void TriangulatedSurface::ends_on(const Bounds& box, unsigned open, double volume) {
    volume_ = volume;
    centroid_ = {};
    reached_ = open;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const double plane = face % 2 == 0 ? box.min[axis] : box.max[axis];
        Vec3 middle = 0.5 * (box.min + box.max);
        middle[axis] = plane;
        if ((open >> face & 1u) == 0 && !(signed_distance(middle) < 0)) continue;
        reached_ |= 1u << face;
        extent_.min[axis] = std::min(extent_.min[axis], plane);
        extent_.max[axis] = std::max(extent_.max[axis], plane);
    }
}

TriangulatedSurface make_surface(std::vector<Vec3> points, std::vector<Triangle> triangles) {
    return TriangulatedSurface::joined(std::move(points), std::move(triangles), true);
}

Shape shape_of_facets(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles, const Bounds* box) {
    const Draft draft{points, triangles};
    const std::vector<unsigned> faces = box ? faces_of_points(points, *box) : std::vector<unsigned>{};
    const bool may_be_open = std::ranges::any_of(faces, [](unsigned of) { return of != 0; });
    const unsigned open = may_be_open ? open_faces(draft, neighbours(draft, faces), faces) : 0;
    const Content content = open != 0 ? content_of_open(draft, *box, open) : Content{};
    const Vec3 centre = open == 0 ? centroid_of(draft) : content.moment / content.volume;
    for (Vec3& x : points) x -= centre;
    TriangulatedSurface surface =
        TriangulatedSurface::joined(std::move(points), std::move(triangles), false, open != 0 ? faces : std::span<const unsigned>{});
    if (open != 0) surface.ends_on({box->min - centre, box->max - centre}, open, content.volume);
    return shape_within(std::move(surface), centre);
}

}  // namespace kropla
