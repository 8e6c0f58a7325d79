// The points of the initial mesh (paper 1.1): random candidates, accepted if no point lies within r = Fun(R).
//
// Boundaries first: surfaces of bodies, corners, edges and faces of the box, each a maximal sample of its own
// dimension; then the inside, at a distance from the boundaries so that no flat tets stand on them and the
// surfaces' triangles keep their diametral spheres empty.

#include "generate/box.h"
#include "generate/clearance.h"
#include <kropla/generate/generate.h>
#include "generate/layers.h"
#include "generate/resample.h"
#include "generate/sampling.h"

#include <algorithm>
#include <iterator>

namespace kropla {

namespace {

// The spacing r of a maximal sample, per target size, whose Delaunay mesh has edges of the target size on the
// mean: measured on the default case after relaxation (inner 1.00, faces 1.00, all 1.01).
constexpr double spacing_on_face = 0.76;
constexpr double spacing_inside = 0.76;

void append(std::vector<Vec3>& to, const std::vector<Vec3>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

/// A seed for each independent stage of the sampling.
std::uint64_t stage_seed(std::uint64_t seed, std::size_t stage) { return random_bits(seed, stage); }

std::vector<Vec3> sample_face(const Snapshot& at, Patch patch, const std::vector<Vec3>& given,
                              Random random, const Watch* watch) {
    const auto spacing = [&](const Vec3& x) { return spacing_on_face * target_size(at, x); };
    const auto room_for = [&](const Vec3& x) { return clearance_on_face(at, patch, x); };
    PointGrid taken;
    for (const Vec3& x : given)
        if (lies_on_face(at.box, patch, x)) taken.insert(x, spacing(x));
    return fill_room(face_of_box(at.box, patch),
                     {spacing, spacing_on_face * size_slope(at), room_for, clearance_slope(at)}, taken,
                     random, watch);
}

std::vector<Vec3> sample_inside(const Snapshot& at, const std::vector<Vec3>& boundary_points,
                                const std::vector<Vec3>& shell_points, Random random,
                                const Watch* watch) {
    // Both are asked of the same place, one after the other.
    Vec3 last = at.box.min;
    SizeAndClearance found = size_and_clearance(at, last);
    const auto look = [&](const Vec3& x) {
        if (x != last) found = size_and_clearance(at, x);
        last = x;
        return found;
    };
    const auto spacing = [&](const Vec3& x) { return spacing_inside * look(x).size; };
    const auto room_for = [&](const Vec3& x) { return look(x).clearance; };
    PointGrid taken;
    for (const Vec3& x : boundary_points) taken.insert(x, spacing(x));
    for (const Vec3& x : shell_points) taken.insert(x, spacing(x));
    return fill_room(at.box, {spacing, spacing_inside * size_slope(at), room_for, clearance_slope(at)}, taken,
                     random, watch);
}

/// The points of surfaces that lie on faces of the box.
std::vector<Vec3> points_on_faces(const Box& box, const std::vector<Surface>& surfaces) {
    std::vector<Vec3> points;
    for (const Surface& surface : surfaces)
        std::ranges::copy_if(surface.points, std::back_inserter(points),
                             [&](const Vec3& x) { return shared_face(box, {x}).exists(); });
    return points;
}

/// The points of the shells of all layers, where tets begin.
std::vector<Vec3> sample_shells(const Snapshot& at, const std::vector<Surface>& walls) {
    std::vector<Vec3> points;
    for (std::size_t body = 0; body < walls.size(); ++body)
        for (const bool inside : {false, true})
            if (const auto stacks = stacks_on(walls[body], body, inside, at))
                append(points, shell_of(walls[body], *stacks).points);
    return points;
}

SurfaceSize size_on_surface(const Snapshot& at, std::size_t body) {
    SurfaceSize size{surface_size(at, body)};
    if (has_local_size(at, body)) size.local = [&at, body](const Vec3& x) { return surface_size(at, body, x); };
    return size;
}

}  // namespace

PointSet sample_points(const Snapshot& as_asked, std::uint64_t seed, const Watch* watch) {
    PointSet set;
    std::size_t stage = 0;
    for (std::size_t body = 0; body < as_asked.shapes.size(); ++body) {
        heed(watch, "meshing surfaces", static_cast<double>(body) / static_cast<double>(as_asked.shapes.size()));
        try {
            set.surfaces.push_back(triangulate_surface(as_asked.shapes[body], size_on_surface(as_asked, body),
                                                       stage_seed(seed, stage++), watch));
        } catch (const DomainError& error) {
            throw BodyError(body, error.what());
        }
        set.first_of_surface.push_back(static_cast<int>(set.points.size()));
        append(set.points, set.surfaces.back().points);
    }
    heed(watch, "drawing points", 0);
    const Snapshot at = bounded_by(set.surfaces, as_asked);
    std::vector<Vec3> given = points_on_faces(at.box, set.surfaces), edge_points = box_corners(at.box);
    append(edge_points, sample_box_edges(at, given));
    append(set.points, edge_points);
    append(given, edge_points);
    for (int face = 0; face < 6; ++face)
        append(set.points, sample_face(at, Patch(face), given, Random{stage_seed(seed, stage++)}, watch));
    append(set.points, sample_inside(at, set.points, sample_shells(at, set.surfaces),
                                     Random{stage_seed(seed, stage)}, watch));
    return set;
}

}  // namespace kropla
