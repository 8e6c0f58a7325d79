#include "app/liquid_bodies.h"

#include "domain/triangle_tree.h"
#include "simulate/cells.h"
#include "simulate/tension.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace kropla {
namespace {

constexpr double arrived_share = 1e-4;  // [-] of how far the surface goes against the body: what counts for nothing, and
constexpr double near_share = 0.05;     // [-] of it, or
constexpr double near_edges = 2e-3;     // [-] of an edge of the surface: what is linear
constexpr double of_way = 1e-6;         // [-] of how far it goes at all: what is that against it

/// A surface that goes on evenly, by a displacement at each of its vertices.
class GoingSurface {
public:
    GoingSurface(const SurfaceCourse& surface, const Array<Vertex, Vec3>& begin, const std::vector<Vec3>& displacement,
                 double t, double dt)
        : tree_(points(surface, begin), triangles(surface)), displacement_(displacement), t_(t), dt_(dt) {}

    /// Where a place that is on it at t0, or near it, is at t1: as the nearest one on it.
    [[nodiscard]] Vec3 taken(const Vec3& x, double t0, double t1) const {
        const double done = (t0 - t_) / dt_;
        Vec3 at_begin = x;
        if (done != 0) at_begin -= done * displacement_near(x - done * displacement_near(x));
        return x + (t1 - t0) / dt_ * displacement_near(at_begin);
    }

private:
    static std::vector<Vec3> points(const SurfaceCourse& surface, const Array<Vertex, Vec3>& begin) {
        std::vector<Vec3> points;
        for (Vertex v : surface.vertices) points.push_back(begin[v]);
        return points;
    }
    static std::vector<std::array<int, 3>> triangles(const SurfaceCourse& surface) {
        std::vector<std::array<int, 3>> triangles;
        for (const auto& facet : surface.facets) {
            auto& corners = triangles.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
                corners[i] = static_cast<int>(place_of(surface.vertices, facet[i]));
        }
        return triangles;
    }

    [[nodiscard]] Vec3 displacement_near(const Vec3& x) const {
        const NearestPlace place = tree_.nearest(x);
        const Corners corners = tree_.corners(place.triangle);
        const Vec3 area = cross(corners[1] - corners[0], corners[2] - corners[0]);
        Vec3 sum;
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 of_corner = cross(corners[(i + 1) % 3] - place.point, corners[(i + 2) % 3] - place.point);
            const auto vertex = static_cast<std::size_t>(tree_.triangles()[place.triangle][i]);
            sum += dot(of_corner, area) / squared_norm(area) * displacement_[vertex];
        }
        return sum;
    }

    TriangleTree tree_;
    std::vector<Vec3> displacement_;  // [m] of its points, until
    double t_, dt_;
};

/// How far the centre of what the surface holds goes with it: the integral of x (d.n), by the volume.
Vec3 way_of_centre(const SurfaceCourse& surface, const Array<Vertex, Vec3>& place) {
    const Vec3 origin = place[surface.vertices.front()];
    Vec3 sum, centre;
    double swept = 0, volume = 0;
    for (const auto& facet : surface.facets) {
        std::array<Vec3, 3> x, d;
        for (std::size_t i = 0; i < 3; ++i) {
            x[i] = place[facet[i]] - origin;
            d[i] = surface.displacement[place_of(surface.vertices, facet[i])];
        }
        const Vec3 area = 0.5 * cross(x[1] - x[0], x[2] - x[0]), all = x[0] + x[1] + x[2];
        for (std::size_t i = 0; i < 3; ++i) {
            sum += dot(d[i], area) / 12 * (x[i] + all);
            swept += dot(d[i], area) / 3;
        }
        const double part = dot(x[0], cross(x[1], x[2])) / 6;
        volume += part;
        centre += part / 4 * all;
    }
    return (sum - swept / volume * centre) / volume;
}

/// The mean length of its edges [m].
double edge_of(const SurfaceCourse& surface) {
    constexpr double of_equilateral = 2.309;  // squared, by the area
    return std::sqrt(of_equilateral * surface.area / static_cast<double>(surface.facets.size()));
}

/// As the body goes along its surface: one that ends on faces of the box stands there.
Vec3 way_of_whole(const SurfaceCourse& surface, const Array<Vertex, Vec3>& place) {
    return surface.free.empty() ? way_of_centre(surface, place) : Vec3{};
}

/// Along which its vertices go as the flow does; on faces of the box along these.
std::vector<Vec3> normals_of(const SurfaceCourse& surface, const Array<Vertex, Vec3>& position) {
    return along_faces(surface_normals(surface.facets, surface.vertices, position), surface.free);
}

/// Along the normals as the flow goes, along the surface as the body.
BodyCourse course_of(const SurfaceCourse& surface, const Array<Vertex, Vec3>& begin, const std::vector<Vec3>& normal,
                     double t, double dt) {
    const Vec3 whole = way_of_whole(surface, begin);
    std::vector<Vec3> displacement(surface.vertices.size());
    for (std::size_t i = 0; i < displacement.size(); ++i)
        displacement[i] = whole + dot(surface.displacement[i] - whole, normal[i]) * normal[i];
    auto going = std::make_shared<GoingSurface>(surface, begin, displacement, t, dt);
    return {as_size(surface.body.value - 1),
            [going](const Vec3& x, double t0, double t1) { return t1 == t0 ? x : going->taken(x, t0, t1); }};
}

SurfaceCourse expected_course(const Mesh& begin, Region liquid, const Array<Vertex, Vec3>& velocity,
                              const Array<Vertex, Vec3>& rate, double dt) {
    SurfaceCourse surface{liquid, region_surface(begin, liquid).interface, {}, {}};
    surface.vertices = vertices_of(surface.facets);
    surface.free = free_directions(surface.vertices, contact_lines(begin, liquid, surface.vertices));
    for (Vertex v : surface.vertices) surface.displacement.push_back(dt * velocity[v] + 0.5 * dt * dt * rate[v]);
    return surface;
}

}  // namespace

LiquidStep::LiquidStep(std::vector<Region> liquids, const Mesh& begin, const Array<Vertex, Vec3>& velocity,
                       const Array<Vertex, Vec3>& rate, double t, double dt)
    : t_(t), dt_(dt) {
    Array<Vertex, Vec3> half_way = begin.position;
    for (Region liquid : liquids) {
        const SurfaceCourse surface = expected_course(begin, liquid, velocity, rate, dt);
        for (std::size_t i = 0; i < surface.vertices.size(); ++i)
            half_way[surface.vertices[i]] += 0.5 * surface.displacement[i];
        courses_.push_back(course_of(surface, begin.position, normals_of(surface, half_way), t, dt));
    }
}

LiquidStep::Verdict LiquidStep::take(const Mesh& before, const Mesh& current, const std::vector<SurfaceCourse>& surfaces) {
    courses_.clear();
    Verdict verdict = Verdict::arrived;
    Array<Vertex, Vec3> half_way = before.position;
    for (const SurfaceCourse& surface : surfaces) {
        for (Vertex v : surface.vertices) half_way[v] = 0.5 * (before.position[v] + current.position[v]);
        const std::vector<Vec3> normal = normals_of(surface, half_way);
        const Vec3 whole = way_of_whole(surface, before.position);
        double missed = 0, way = 0, against_body = 0;  // [m], the largest
        for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
            const Vertex v = surface.vertices[i];
            const Vec3& gone = surface.displacement[i];
            missed = std::max(missed, std::abs(dot(current.position[v] - before.position[v] - gone, normal[i])));
            way = std::max(way, norm(gone));
            against_body = std::max(against_body, std::abs(dot(gone - whole, normal[i])));
        }
        const double counts = std::max(against_body, of_way * way);
        if (missed > std::max(near_share * counts, near_edges * edge_of(surface))) verdict = Verdict::elsewhere;
        else if (missed > arrived_share * counts && verdict == Verdict::arrived) verdict = Verdict::near;
        courses_.push_back(course_of(surface, before.position, normal, t_, dt_));
    }
    return verdict;
}

}  // namespace kropla
