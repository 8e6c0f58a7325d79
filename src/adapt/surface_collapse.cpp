// Two vertices of a surface become one.
#include "adapt/surface.h"

#include "adapt/constants.h"
#include "adapt/propose.h"
#include "adapt/surface_volume.h"
#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <utility>

namespace kropla {
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
std::optional<Meeting> meeting_of(const Mesh& mesh, const SurfaceStar& a, const SurfaceStar& b, bool on_line, double sharp) {
    auto meeting = meeting_by_faces(mesh, a, b, on_line);
    const std::vector<Vertex> at_a = sharp_ends(a, mesh, sharp), at_b = sharp_ends(b, mesh, sharp);
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

std::optional<SurfaceChange> surface_collapse(const Mesh& mesh, Edge edge, const SurfaceOf& of, double longest) {
    const SurfaceStar a = surface_star(mesh, edge.a, of.region), b = surface_star(mesh, edge.b, of.region);
    const auto has_b = [&](const std::array<Vertex, 2>& side) { return side[0] == edge.b || side[1] == edge.b; };
    const bool on_line = std::ranges::count_if(a.sides, has_b) == 1;
    if (count_shared(a, b) != (on_line ? 1 : 2)) return std::nullopt;
    const auto meeting = meeting_of(mesh, a, b, on_line, of.sharp);
    const auto to_boundary = coming_to_boundary(mesh, edge, a.cells);
    if (!meeting || !to_boundary) return std::nullopt;
    const auto around = outline(a, b);
    const auto at = place_of_one(mesh, a, b, *meeting, around, of.region);
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

}  // namespace kropla
