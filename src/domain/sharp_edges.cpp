// Sharp edges of triangulated surfaces, by the angle between triangles, as in generate/creases.cpp [Botsch, Kobbelt 2004].

#include "domain/sharp_edges.h"

#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

namespace kropla {
namespace {

struct Edge {
    int a, b;
    Vec3 normal;                                            // of its first triangle
    double bend = std::numeric_limits<double>::infinity();  // [rad] to that of the second; infinite if it has none
    unsigned along = 0;
};

/// To the faces across which axis the triangle is nearly parallel, a bit each.
unsigned faces_along(const Vec3& normal) {
    constexpr double parallel = 0.94;  // cosine of 20 degrees, as in thin_places.cpp
    unsigned faces = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(normal[axis]) > parallel * norm(normal)) faces |= 3u << 2 * axis;
    return faces;
}

std::vector<Edge> edges_of(const TriangulatedSurface& surface) {
    struct Side {
        int a, b;
        std::size_t triangle;
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < surface.triangles().size(); ++t)
        for (std::size_t i = 0; i < 3; ++i) {
            const int a = surface.triangles()[t][i], b = surface.triangles()[t][(i + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), t});
        }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.a, s.b, s.triangle); });
    std::vector<Edge> edges;
    for (const auto& [a, b, t] : sides) {
        const Corners corners = surface.tree().corners(t);
        const Vec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (edges.empty() || edges.back().a != a || edges.back().b != b) edges.push_back({a, b, normal});
        else edges.back().bend = angle_between(edges.back().normal, normal);
        edges.back().along |= faces_along(normal);
    }
    return edges;
}

/// Which of a set of things are connected.
class Joined {
public:
    explicit Joined(std::size_t count) : of_(count) { std::iota(of_.begin(), of_.end(), 0); }
    int of(int i) {
        while (of_[at(i)] != i) i = of_[at(i)] = of_[at(of_[at(i)])];
        return i;
    }
    void join(int i, int j) { of_[at(of(i))] = of(j); }

private:
    static std::size_t at(int i) { return static_cast<std::size_t>(i); }
    std::vector<int> of_;
};

/// The faces of the box that a place of a cut surface is on.
unsigned faces_at(const TriangulatedSurface& surface, const Vec3& x) {
    unsigned faces = 0;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        if (x[axis] == (face % 2 == 0 ? surface.extent().min : surface.extent().max)[axis]) faces |= 1u << face;
    }
    return faces & surface.reached();
}

}  // namespace

SharpEdges::SharpEdges(const TriangulatedSurface& surface) {
    std::vector<Edge> edges = edges_of(surface);
    std::erase_if(edges, [](const Edge& e) { return !(e.bend > sharp); });
    const auto place = [&](int point) { return surface.points()[static_cast<std::size_t>(point)]; };
    std::map<int, std::vector<std::size_t>> at;  // of points, the edges there
    for (std::size_t e = 0; e < edges.size(); ++e)
        for (const int point : {edges[e].a, edges[e].b}) at[point].push_back(e);
    Joined joined(edges.size());
    std::set<int> corners;
    for (const auto& edges_at : at) {
        const int point = edges_at.first;
        const std::vector<std::size_t>& there = edges_at.second;
        const auto along = [&](std::size_t e) { return place(edges[e].a == point ? edges[e].b : edges[e].a) - place(point); };
        if (there.size() == 2 && angle_between(along(there[0]), -along(there[1])) < sharp) {
            joined.join(static_cast<int>(there[0]), static_cast<int>(there[1]));
        } else {
            corners.insert(point);
        }
    }
    std::map<int, int> course_of;  // what is joined
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto [known, is_new] = course_of.emplace(joined.of(static_cast<int>(e)), static_cast<int>(courses.size()));
        if (is_new) courses.emplace_back();
        segments.push_back({place(edges[e].a), place(edges[e].b), known->second});
        Course& course = courses[static_cast<std::size_t>(known->second)];
        for (const int point : {edges[e].a, edges[e].b}) {
            if (corners.contains(point)) course.corners.push_back(point);
            course.faces |= faces_at(surface, place(point)) | edges[e].along;
        }
    }
    std::map<int, unsigned> faces_at_corner;
    for (const Course& course : courses)
        for (const int corner : course.corners) faces_at_corner[corner] |= course.faces;
    for (Course& course : courses)
        for (const int corner : course.corners) course.faces |= faces_at_corner[corner];
}

bool SharpEdges::meet(int one, int other) const {
    if (one == other) return true;
    const auto& of_one = courses[static_cast<std::size_t>(one)].corners;
    const auto& of_other = courses[static_cast<std::size_t>(other)].corners;
    return std::ranges::any_of(of_one, [&](int corner) { return std::ranges::find(of_other, corner) != of_other.end(); });
}

}  // namespace kropla
