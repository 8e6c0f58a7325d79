// The volume inside a surface is linear in the place of one vertex, and in the length by which a set of vertices is shifted
// along one direction: a determinant with two equal rows is nothing. So what a change of the surface takes from it is put
// back by one shift, in one step, as in the smoothing of edges of [Kuprat, Khamayseh, George, Larkey 2001, "Volume conserving
// smoothing for piecewise linear curves, surfaces, and triple lines"].

#include "adapt/surface.h"

#include "adapt/constants.h"
#include "adapt/propose.h"
#include "base/tetrahedron.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

/// Places of a mesh, some of them changed.
class Places {
public:
    Places(const Mesh& mesh, std::span<const Displaced> moved) : mesh_(mesh), moved_(moved) {}
    [[nodiscard]] const Vec3& operator[](Vertex v) const {
        const auto found = std::ranges::find(moved_, v, &Displaced::vertex);
        return found == moved_.end() ? mesh_.position[v] : found->place;
    }

private:
    const Mesh& mesh_;
    std::span<const Displaced> moved_;
};

/// Six times the volume under the triangles, seen from `origin`.
double volume_under(std::span<const Triangle> triangles, const Places& places, const Vec3& origin) {
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += determinant(places[a] - origin, places[b] - origin, places[c] - origin);
    return sum;
}

/// The triangles of the surface at the vertices, each once.
std::vector<Triangle> triangles_at(const Mesh& mesh, std::span<const Vertex> vertices, Region region) {
    std::vector<Triangle> all;
    for (Vertex v : vertices)
        for (const auto& [a, b] : surface_star(mesh, v, region).sides) {
            Triangle t{v, a, b};
            std::rotate(t.begin(), std::ranges::min_element(t), t.end());
            all.push_back(t);
        }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

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

namespace {

/// Vertices of the surface next to both ends: two, unless the surface would touch itself if these became one.
std::size_t count_shared(const SurfaceStar& a, const SurfaceStar& b) {
    const auto of_a = ring(a), of_b = ring(b);
    std::vector<Vertex> shared;
    std::ranges::set_intersection(of_a, of_b, std::back_inserter(shared));
    return shared.size();
}

/// What is left around two ends that become one: the sides of triangles at one that do not have the other.
std::vector<std::array<Vertex, 2>> outline(const SurfaceStar& a, const SurfaceStar& b) {
    std::vector<std::array<Vertex, 2>> sides;
    for (const auto& [star, other] : {std::pair(&a, b.vertex), std::pair(&b, a.vertex)})
        for (const auto& side : star->sides)
            if (side[0] != other && side[1] != other) sides.push_back(side);
    return sides;
}

/// Where two ends become one: near the middle of their edge, or, if one is held to more faces of the box than the other,
/// near that; to be shifted as that one may be.
struct Meeting {
    Vec3 place;
    Freedom free;
    bool at_sharp_edge = false;  // either was on one
};
/// Nothing if both are on faces and either is on one that the other is not on; or if their edge is not in the face.
std::optional<Meeting> meeting_by_faces(const Mesh& mesh, const SurfaceStar& a, const SurfaceStar& b, bool on_line) {
    const Vec3 &p = mesh.position[a.vertex], &q = mesh.position[b.vertex];
    if (!a.free.all() && !b.free.all() && !on_line) return std::nullopt;
    if (a.free == b.free) return Meeting{0.5 * (p + q), a.free};
    const auto is_freer = [](const Freedom& one, const Freedom& other) {
        for (std::size_t i = 0; i < 3; ++i)
            if (other.along[i] && !one.along[i]) return false;
        return true;
    };
    if (is_freer(a.free, b.free)) return Meeting{q, b.free};
    if (is_freer(b.free, a.free)) return Meeting{p, a.free};
    return std::nullopt;
}

/// How much the sharp edges at a vertex hold it: it is on none, on one that goes on nearly straight or ends on a face, or in
/// a corner.
enum class Held { not_at_all, to_edge, in_corner };
Held held_by_edges(const Mesh& mesh, const SurfaceStar& star, std::span<const Vertex> sharp_ends) {
    if (sharp_ends.empty()) return Held::not_at_all;
    if (sharp_ends.size() == 1) return star.free.all() ? Held::in_corner : Held::to_edge;
    const Vec3 &x = mesh.position[star.vertex], one = mesh.position[sharp_ends[0]] - x, other = mesh.position[sharp_ends[1]] - x;
    const bool straight = -dot(one, other) > least_agreement * norm(one) * norm(other);
    return straight && star.free.all() && sharp_ends.size() == 2 ? Held::to_edge : Held::in_corner;
}

/// As by the faces of the box, but that neither leaves a sharp edge on which it is. Nothing if the faces want it otherwise.
std::optional<Meeting> meeting_of(const Mesh& mesh, const SurfaceStar& a, const SurfaceStar& b, bool on_line) {
    auto meeting = meeting_by_faces(mesh, a, b, on_line);
    const std::vector<Vertex> at_a = sharp_ends(a, mesh), at_b = sharp_ends(b, mesh);
    const Held of_a = held_by_edges(mesh, a, at_a), of_b = held_by_edges(mesh, b, at_b);
    if (!meeting || (of_a == Held::not_at_all && of_b == Held::not_at_all)) return meeting;
    const bool along_edge = std::ranges::find(at_a, b.vertex) != at_a.end();
    if (of_a != Held::not_at_all && of_b != Held::not_at_all && !along_edge) return std::nullopt;
    meeting->at_sharp_edge = true;
    if (of_a == of_b) return of_a == Held::in_corner ? std::nullopt : meeting;
    const SurfaceStar& held = of_a > of_b ? a : b;
    if (!(held.free == meeting->free)) return std::nullopt;
    meeting->place = mesh.position[held.vertex];
    return meeting;
}

/// Where the one vertex keeps the volume that both had, nearest to where they meet.
std::optional<Vec3> place_of_one(const Mesh& mesh, const SurfaceStar& a, const SurfaceStar& b, const Meeting& meeting,
                                 std::span<const std::array<Vertex, 2>> outline, Region region) {
    const Vec3 &p = mesh.position[a.vertex], &q = mesh.position[b.vertex], &from = meeting.place;
    const std::array<Vertex, 2> ends = {a.vertex, b.vertex};
    const double wanted = volume_under(triangles_at(mesh, ends, region), {mesh, {}}, from);
    Vec3 slope;
    for (const auto& [c, d] : outline) slope += cross(mesh.position[c] - from, mesh.position[d] - from);
    slope = restricted(slope, meeting.free);
    const Vec3 shift = wanted / squared_norm(slope) * slope;
    if (!(norm(shift) <= most_shift * distance(p, q))) return std::nullopt;
    return from + shift;
}

/// A cell between both ends goes; if it had a facet on the boundary at one end, the cell across from the other end comes to
/// the boundary with the facet that was between the two.
struct ComesToBoundary {
    Tet cell;
    int corner;
    Patch patch;
};
/// Nothing if that cell is not there.
std::optional<std::vector<ComesToBoundary>> coming_to_boundary(const Mesh& mesh, Edge edge, std::span<const Tet> cells) {
    std::vector<ComesToBoundary> all;
    for (Tet t : cells) {
        const std::array<int, 2> at = {corner_of(mesh, t, edge.a), corner_of(mesh, t, edge.b)};
        if (at[0] < 0 || at[1] < 0) continue;
        for (std::size_t i = 0; i < 2; ++i) {
            const Patch patch = mesh.patch[t][as_size(at[i])];
            if (mesh.neighbour[t][as_size(at[i])].exists() || !patch.exists()) continue;
            const Facet across{t, at[1 - i]};
            const Tet n = mesh.neighbour[t][as_size(across.corner)];
            if (!n.exists()) return std::nullopt;
            all.push_back({n, mirror_corner(mesh, across), patch});
        }
    }
    return all;
}

/// Do the triangles over the outline of two stars look where all of these looked, or, at a sharp edge, each where that looked
/// which it replaces; and is none of their sides too long?
bool is_fair(const Mesh& mesh, const SurfaceStar& a, const SurfaceStar& b, std::span<const std::array<Vertex, 2>> outline,
             const Vec3& at, bool at_edge, double longest) {
    const Vec3 all = twice_area(a, mesh) + twice_area(b, mesh);
    return std::ranges::all_of(outline, [&](const std::array<Vertex, 2>& side) {
        const Vec3 &p = mesh.position[side[0]], &q = mesh.position[side[1]];
        const Vertex end = std::ranges::find(a.sides, side) != a.sides.end() ? a.vertex : b.vertex;
        const Vec3 is = twice_area(at, p, q), was = at_edge ? twice_area(mesh.position[end], p, q) : all;
        return dot(is, was) > least_agreement * norm(is) * norm(was) && distance(at, p) <= longest;
    });
}

}  // namespace

std::optional<SurfaceChange> surface_collapse(const Mesh& mesh, Edge edge, Region region, double longest) {
    const SurfaceStar a = surface_star(mesh, edge.a, region), b = surface_star(mesh, edge.b, region);
    const auto has_b = [&](const std::array<Vertex, 2>& side) { return side[0] == edge.b || side[1] == edge.b; };
    const bool on_line = std::ranges::count_if(a.sides, has_b) == 1;
    if (count_shared(a, b) != (on_line ? 1 : 2)) return std::nullopt;
    const auto meeting = meeting_of(mesh, a, b, on_line);
    const auto to_boundary = coming_to_boundary(mesh, edge, a.cells);
    if (!meeting || !to_boundary) return std::nullopt;
    const auto around = outline(a, b);
    const auto at = place_of_one(mesh, a, b, *meeting, around, region);
    if (!at || !is_fair(mesh, a, b, around, *at, meeting->at_sharp_edge, longest)) return std::nullopt;

    SurfaceChange change;
    auto& removed = change.cavity.removed;
    std::ranges::set_union(a.cells, b.cells, std::back_inserter(removed));
    change.cavity.inserted = {*at};
    for (Tet t : removed) {
        change.worst_before = std::max(change.worst_before, aspect_ratio(mesh, t));
        const int of_a = corner_of(mesh, t, edge.a), of_b = corner_of(mesh, t, edge.b);
        if (of_a >= 0 && of_b >= 0) continue;
        auto v = mesh.tets[t];
        const std::size_t corner = as_size(std::max(of_a, of_b));
        std::array<Vec3, 4> x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = i == corner ? *at : mesh.position[v[i]];
        v[corner] = inserted_vertex(0);
        NewTet& added = change.cavity.added.emplace_back(NewTet{v, mesh.region[t], mesh.patch[t]});
        for (const auto& [cell, at_corner, patch] : *to_boundary)
            if (cell == t) added.patch[as_size(at_corner)] = patch;
        change.worst_after = std::max(change.worst_after, tet_aspect_ratio(x[0], x[1], x[2], x[3]));
        if (change.worst_after == infinity) return std::nullopt;
    }
    if (!meeting->free.all() && !fits(mesh, change.cavity)) return std::nullopt;
    return change;
}

std::optional<SurfaceChange> surface_swap(const Mesh& mesh, const Shell& shell, Edge edge, Region region, unsigned pinned) {
    if (!shell.closed) return std::nullopt;
    const std::size_t n = shell.tets.size();
    const auto inside = [&](std::size_t i) { return mesh.region[shell.tets[i % n]] == region; };
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
    if (is_sharp(area(one), area(other)) || !(dot(area(new_one), normal) > 0) || !(dot(area(new_other), normal) > 0))
        return std::nullopt;
    const SurfaceStar at_c = surface_star(mesh, c, region);
    if (std::ranges::binary_search(ring(at_c), d)) return std::nullopt;
    if (!at_c.free.all() && !surface_star(mesh, d, region).free.all()) return std::nullopt;  // it might lie in a face

    SurfaceChange change;
    change.cavity.removed = shell.tets;
    for (const auto& [from, to] : {std::pair(first, second), std::pair(second, first)}) {
        std::vector<Vertex> half;
        for (std::size_t i = from; i % n != to; ++i) half.push_back(shell.ring[i % n]);
        half.push_back(shell.ring[to]);
        if (!fill_half(mesh, edge, half, mesh.region[shell.tets[from]], change.cavity)) return std::nullopt;
    }
    const std::array<Vertex, 4> corners = {a, b, c, d};
    const auto before = triangles_at(mesh, corners, region);
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
    const double shift = keep_volume(mesh, before, after, normalised(normal), pinned, change.moved);
    if (!(std::abs(shift) <= most_shift * distance(mesh.position[c], mesh.position[d]))) return std::nullopt;
    if (!agree(kept, mesh, {mesh, change.moved})) return std::nullopt;
    look_at_moved(mesh, change);
    return if_valid(std::move(change));
}

std::optional<SurfaceChange> raise_to_quadric(const Mesh& mesh, Vertex v, Region region, unsigned pinned) {
    const SurfaceStar star = surface_star(mesh, v, region);
    if (is_sharp(star, mesh) || !star.free.all()) return std::nullopt;
    const auto height = height_of_quadric(mesh, star, region);
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
    const auto triangles = triangles_at(mesh, vertices, region);
    const double shift = keep_volume(mesh, triangles, triangles, normal, pinned, change.moved);
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

std::optional<SurfaceChange> slide(const Mesh& mesh, Vertex v, Region region) {
    const SurfaceStar star = surface_star(mesh, v, region);
    if (is_sharp(star, mesh)) return std::nullopt;
    const Vec3 here = mesh.position[v];
    const Vec3 place = here + way_to_middle(mesh, star, free_normal(mesh, star));
    if (!(least_angle(mesh, star, place) > least_angle(mesh, star, here)) || !agrees(mesh, star, place)) return std::nullopt;
    return if_valid(at_place(mesh, v, place));
}

std::optional<SurfaceChange> slide_for_cells(const Mesh& mesh, Vertex v, Region region) {
    const SurfaceStar star = surface_star(mesh, v, region);
    if (is_sharp(star, mesh)) return std::nullopt;
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
