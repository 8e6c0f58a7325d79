// The volume inside a surface is linear in the place of one vertex, and in the length by which a set of vertices is shifted
// along one direction: a determinant with two equal rows is nothing. So what a change of the surface takes from it is put
// back by one shift, in one step, as in the smoothing of edges of [Kuprat, Khamayseh, George, Larkey 2001, "Volume conserving
// smoothing for piecewise linear curves, surfaces, and triple lines"].

#include "adapt/surface.h"

#include "adapt/constants.h"
#include "adapt/propose.h"
#include "adapt/surface_volume.h"
#include "base/tetrahedron.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace kropla {
namespace {

/// The ways in which the vertices are shifted together: along `normal`, but along the faces of the box on which they lie, and not
/// at all on those where the line is pinned. And a point in all these faces: seen from it, nothing of the volume is under them.
struct Shift {
    std::vector<Vec3> ways;
    Vec3 origin;
    bool in_faces = false;  // the ways differ
};
std::optional<Shift> shift_of(const Mesh& mesh, std::span<const Displaced> moved, const Vec3& normal, unsigned pinned) {
    Shift shift{{}, mesh.position[moved.front().vertex]};
    std::array<bool, 3> held{};
    for (const Displaced& d : moved) {
        const auto around = ball(mesh, d.vertex);
        const Freedom free = free_on_patches(mesh, d.vertex, around);
        const bool is_pinned = (constraint(mesh, d.vertex, around).patches & pinned) != 0;
        shift.ways.push_back(is_pinned ? Vec3{} : restricted(normal, free));
        shift.in_faces |= !free.all();
        for (int axis = 0; axis < 3; ++axis) {
            if (free.along[as_size(axis)]) continue;
            const double plane = mesh.position[d.vertex][axis];
            if (std::exchange(held[as_size(axis)], true) && shift.origin[axis] != plane) return std::nullopt;
            shift.origin[axis] = plane;
        }
    }
    return shift;
}

/// Shifts the vertices by as much along `normal` as makes the volume under `after` that under `before`. Returns by how much.
double keep_volume(const Mesh& mesh, std::span<const Triangle> before, std::span<const Triangle> after, const Vec3& normal,
                   unsigned pinned, std::vector<Displaced>& moved) {
    const auto by = shift_of(mesh, moved, normal, pinned);
    if (!by) return infinity;
    const double wanted = volume_under(before, {mesh, {}}, by->origin);
    double length = 0;
    for (const auto& [a, b, c] : after) length = std::max(length, distance(mesh.position[a], mesh.position[b]));
    const double step = by->in_faces ? shift_difference * length : length;
    const auto shifted = [&](double shift) {
        std::vector<Displaced> places = moved;
        for (std::size_t i = 0; i < places.size(); ++i) places[i].place += shift * by->ways[i];
        return places;
    };
    double sum = 0;
    // Linear along one way, and once more for rounding; along several the volume is not quite so.
    for (int i = 0; i < (by->in_faces ? most_shift_steps : 2); ++i) {
        const double here = volume_under(after, {mesh, moved}, by->origin);
        const double slope = (volume_under(after, {mesh, shifted(step)}, by->origin) - here) / step;
        if (!(slope > 0)) return infinity;
        const double shift = (wanted - here) / slope;
        moved = shifted(shift);
        sum += shift;
    }
    return sum;
}

/// No triangle turns by much.
bool agree(std::span<const Triangle> triangles, const Mesh& mesh, const Places& after) {
    return std::ranges::all_of(triangles, [&](const Triangle& t) {
        const Vec3 was = twice_area(mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]);
        const Vec3 is = twice_area(after[t[0]], after[t[1]], after[t[2]]);
        return dot(was, is) > least_agreement * norm(was) * norm(is);
    });
}

/// The worst of the cells at the vertices that the cavity does not remove.
void look_at_moved(const Mesh& mesh, SurfaceChange& change) {
    std::vector<Tet> cells, around;
    for (const Displaced& d : change.moved) {
        ball(mesh, d.vertex, around);
        cells.insert(cells.end(), around.begin(), around.end());
    }
    std::ranges::sort(cells);
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    const Places places(mesh, change.moved);
    const auto ratio = [&](const std::array<Vertex, 4>& v) {
        return tet_aspect_ratio(places[v[0]], places[v[1]], places[v[2]], places[v[3]]);
    };
    for (Tet t : cells) {
        change.worst_before = std::max(change.worst_before, aspect_ratio(mesh, t));
        if (std::ranges::find(change.cavity.removed, t) == change.cavity.removed.end())
            change.worst_after = std::max(change.worst_after, ratio(mesh.tets[t]));
    }
    for (const NewTet& t : change.cavity.added) change.worst_after = std::max(change.worst_after, ratio(t.vertices));
}

std::optional<SurfaceChange> if_valid(SurfaceChange change) {
    if (!(change.worst_after < infinity)) return std::nullopt;
    return change;
}

}  // namespace

Replacement carry_out_surface(Mesh& mesh, const SurfaceChange& change, Changes& changes) {
    Replacement done;
    if (!change.cavity.removed.empty()) {
        done = replace_cells(mesh, change.cavity);
        changes.removed.insert(changes.removed.end(), change.cavity.removed.begin(), change.cavity.removed.end());
        changes.cells.insert(changes.cells.end(), done.cells.begin(), done.cells.end());
        changes.vertices.insert(changes.vertices.end(), done.vertices.begin(), done.vertices.end());
        changes.cells_replaced += static_cast<int>(change.cavity.removed.size());
        changes.vertices_inserted += static_cast<int>(done.vertices.size());
    }
    for (const Displaced& d : change.moved) {
        mesh.position[d.vertex] = d.place;
        changes.vertices.push_back(d.vertex);
    }
    return done;
}

std::optional<Shell> surface_shell(const Mesh& mesh, Edge edge, Region region) {
    if (!alive(mesh, edge.a) || !alive(mesh, edge.b)) return std::nullopt;
    auto around = shell(mesh, edge);
    if (!around) return std::nullopt;
    if (!around->closed) {
        const unsigned patches = constraint(mesh, *around).patches;
        if (std::popcount(patches) != 1 || (patches >> box_faces) != 0) return std::nullopt;
    }
    const auto inside = std::ranges::count_if(around->tets, [&](Tet t) { return mesh.region[t] == region; });
    if (inside == 0 || inside == static_cast<std::ptrdiff_t>(around->tets.size())) return std::nullopt;
    return around;
}

SurfaceChange surface_split(const Mesh& mesh, const Shell& shell, Edge edge) {
    SurfaceChange change;
    const Vec3 middle = 0.5 * (mesh.position[edge.a] + mesh.position[edge.b]);
    change.cavity.removed = shell.tets;
    change.cavity.inserted = {middle};
    for (Tet t : shell.tets) {
        change.worst_before = std::max(change.worst_before, aspect_ratio(mesh, t));
        for (Vertex end : {edge.a, edge.b}) {
            const int corner = corner_of(mesh, t, end);
            auto v = mesh.tets[t];
            std::array<Vec3, 4> x;
            for (std::size_t i = 0; i < 4; ++i) x[i] = as_size(corner) == i ? middle : mesh.position[v[i]];
            v[as_size(corner)] = inserted_vertex(0);
            change.cavity.added.push_back({v, mesh.region[t], mesh.patch[t]});
            change.worst_after = std::max(change.worst_after, tet_aspect_ratio(x[0], x[1], x[2], x[3]));
        }
    }
    return change;
}

std::optional<SurfaceChange> surface_swap(const Mesh& mesh, const Shell& shell, Edge edge, const SurfaceOf& of) {
    if (!shell.closed) return std::nullopt;
    const std::size_t n = shell.tets.size();
    const auto inside = [&](std::size_t i) { return mesh.region[shell.tets[i % n]] == of.region; };
    // From ring[first] on, cells are inside; from ring[second] on, outside. Seen from outside, with edge.a below, ring goes
    // round counter-clockwise about the edge, so that (a, b, c) with c = ring[second] looks outwards.
    std::size_t first = n, second = n;
    for (std::size_t i = 0; i < n; ++i) {
        if (inside(i) && !inside(i + n - 1)) first = first == n ? i : 2 * n;
        if (!inside(i) && inside(i + n - 1)) second = second == n ? i : 2 * n;
    }
    if (first >= n || second >= n) return std::nullopt;
    const Vertex a = edge.a, b = edge.b, c = shell.ring[second], d = shell.ring[first];
    const Triangle one{a, b, c}, other{b, a, d}, new_one{a, d, c}, new_other{d, b, c};
    const auto area = [&](const Triangle& t) {
        return twice_area(mesh.position[t[0]], mesh.position[t[1]], mesh.position[t[2]]);
    };
    const Vec3 normal = area(one) + area(other);
    if (is_sharp(area(one), area(other), of.sharp) || !(dot(area(new_one), normal) > 0) || !(dot(area(new_other), normal) > 0))
        return std::nullopt;
    const SurfaceStar at_c = surface_star(mesh, c, of.region);
    if (std::ranges::binary_search(ring(at_c), d)) return std::nullopt;
    if (!at_c.free.all() && !surface_star(mesh, d, of.region).free.all()) return std::nullopt;  // it might lie in a face

    SurfaceChange change;
    change.cavity.removed = shell.tets;
    for (const auto& [from, to] : {std::pair(first, second), std::pair(second, first)}) {
        std::vector<Vertex> half;
        for (std::size_t i = from; i % n != to; ++i) half.push_back(shell.ring[i % n]);
        half.push_back(shell.ring[to]);
        if (!fill_half(mesh, edge, half, mesh.region[shell.tets[from]], change.cavity)) return std::nullopt;
    }
    const std::array<Vertex, 4> corners = {a, b, c, d};
    const auto before = triangles_at(mesh, corners, of.region);
    std::vector<Triangle> after;
    const auto same = [](Triangle s, Triangle t) {
        std::ranges::sort(s);
        std::ranges::sort(t);
        return s == t;
    };
    std::ranges::copy_if(before, std::back_inserter(after), [&](const Triangle& t) { return !same(t, one) && !same(t, other); });
    const std::vector<Triangle> kept = after;
    after.insert(after.end(), {new_one, new_other});
    for (Vertex v : corners) change.moved.push_back({v, mesh.position[v]});
    const double shift = keep_volume(mesh, before, after, normalised(normal), of.pinned, change.moved);
    if (!(std::abs(shift) <= most_shift * distance(mesh.position[c], mesh.position[d]))) return std::nullopt;
    if (!agree(kept, mesh, {mesh, change.moved})) return std::nullopt;
    look_at_moved(mesh, change);
    return if_valid(std::move(change));
}

std::optional<SurfaceChange> raise_to_quadric(const Mesh& mesh, Vertex v, const SurfaceOf& of) {
    const SurfaceStar star = surface_star(mesh, v, of.region);
    if (is_sharp(star, mesh, of.sharp) || !star.free.all()) return std::nullopt;
    const auto height = height_of_quadric(mesh, star, of);
    if (!height) return std::nullopt;
    const Vec3 normal = normalised(twice_area(star, mesh)), here = mesh.position[v];
    std::vector<Vertex> vertices = ring(star);
    double shortest = infinity;
    for (Vertex w : vertices) shortest = std::min(shortest, distance(mesh.position[w], here));
    if (!(std::abs(*height) <= most_shift * shortest)) return std::nullopt;
    SurfaceChange change;
    change.moved.push_back({v, here + *height * normal});
    for (Vertex w : vertices) change.moved.push_back({w, mesh.position[w]});
    vertices.push_back(v);
    const auto triangles = triangles_at(mesh, vertices, of.region);
    const double shift = keep_volume(mesh, triangles, triangles, normal, of.pinned, change.moved);
    if (!(std::abs(shift) <= most_shift * shortest)) return std::nullopt;
    if (!agree(triangles, mesh, {mesh, change.moved})) return std::nullopt;
    look_at_moved(mesh, change);
    return if_valid(std::move(change));
}

double least_angle(const Mesh& mesh, const SurfaceStar& star, const Vec3& at) {
    const auto angle = [](const Vec3& tip, const Vec3& p, const Vec3& q) {
        return std::atan2(norm(cross(p - tip, q - tip)), dot(p - tip, q - tip));
    };
    double least = infinity;
    for (const auto& side : star.sides) {
        const Vec3 &a = mesh.position[side[0]], &b = mesh.position[side[1]];
        least = std::min({least, angle(at, a, b), angle(a, b, at), angle(b, at, a)});
    }
    return least;
}

namespace {

/// Along which the volume grows fastest where the vertex may go.
Vec3 free_normal(const Mesh& mesh, const SurfaceStar& star) {
    return normalised(restricted(twice_area(star, mesh), star.free));
}

/// From the vertex to the middle of its triangles, weighted by area, within the plane that keeps the volume.
Vec3 way_to_middle(const Mesh& mesh, const SurfaceStar& star, const Vec3& normal) {
    const Vec3 here = mesh.position[star.vertex];
    Vec3 sum;
    double total = 0;
    for (const auto& side : star.sides) {
        const Vec3 &a = mesh.position[side[0]], &b = mesh.position[side[1]];
        const double area = norm(twice_area(here, a, b));
        sum += area / 3 * (a + b - 2 * here);
        total += area;
    }
    const Vec3 way = restricted(sum / total, star.free);
    return way - dot(way, normal) * normal;
}

SurfaceChange at_place(const Mesh& mesh, Vertex v, const Vec3& place) {
    SurfaceChange change;
    change.moved = {{v, place}};
    look_at_moved(mesh, change);
    return change;
}

bool agrees(const Mesh& mesh, const SurfaceStar& star, const Vec3& place) {
    const Displaced moved{star.vertex, place};
    std::vector<Triangle> triangles;
    for (const auto& [a, b] : star.sides) triangles.push_back({star.vertex, a, b});
    return agree(triangles, mesh, {mesh, {&moved, 1}});
}

}  // namespace

std::optional<SurfaceChange> slide(const Mesh& mesh, Vertex v, const SurfaceOf& of) {
    const SurfaceStar star = surface_star(mesh, v, of.region);
    if (is_sharp(star, mesh, of.sharp)) return std::nullopt;
    const Vec3 here = mesh.position[v];
    const Vec3 place = here + way_to_middle(mesh, star, free_normal(mesh, star));
    if (!(least_angle(mesh, star, place) > least_angle(mesh, star, here)) || !agrees(mesh, star, place)) return std::nullopt;
    return if_valid(at_place(mesh, v, place));
}

std::optional<SurfaceChange> slide_for_cells(const Mesh& mesh, Vertex v, const SurfaceOf& of) {
    const SurfaceStar star = surface_star(mesh, v, of.region);
    if (is_sharp(star, mesh, of.sharp)) return std::nullopt;
    const Vec3 here = mesh.position[v], normal = free_normal(mesh, star);
    // Down the slope of the worst cell's ratio, in the plane.
    double worst = 0;
    Vec3 downhill;
    double nearest = infinity;
    for (Tet t : star.cells) {
        const auto [a, b, c] = facet_vertices(mesh, {t, corner_of(mesh, t, v)});
        const Vec3 &p = mesh.position[a], &q = mesh.position[b], &r = mesh.position[c];
        nearest = std::min({nearest, distance(here, p), distance(here, q), distance(here, r)});
        const double ratio = aspect_ratio(mesh, t);
        if (ratio <= worst) continue;
        worst = ratio;
        downhill = -tet_aspect_gradient(here, p, q, r).gradient;
    }
    const Vec3 to_middle = way_to_middle(mesh, star, normal);
    downhill = restricted(downhill, star.free);
    downhill -= dot(downhill, normal) * normal;
    std::optional<SurfaceChange> best;
    for (Vec3 way : {to_middle, norm(downhill) > 0 ? first_step * nearest / norm(downhill) * downhill : Vec3{}})
        for (int i = 0; i <= most_slide_halvings; ++i, way *= 0.5) {
            SurfaceChange tried = at_place(mesh, v, here + way);
            if (!(tried.worst_after < (1 - least_gain) * worst) || !agrees(mesh, star, here + way)) continue;
            if (!best || tried.worst_after < best->worst_after) best = std::move(tried);
        }
    return best;
}

}  // namespace kropla
