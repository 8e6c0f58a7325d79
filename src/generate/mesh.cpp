// The initial mesh (paper 1.1, 1.4): points, Delaunay, identification of the bodies, prism layers.
//
// A wall and its shell are too near to each other for one Delaunay triangulation to have both as facets. So
// the room around the shells and the inside of each layered body are triangulated by themselves, and joined
// by the prisms.
//
// Where a triangle of a surface is not a facet, points in its diametral sphere are removed; where that does
// not do, an edge of it is split, as in [Shewchuk 1998, "Tetrahedral mesh generation by Delaunay
// refinement"], with the new point on the body's surface; the surface is scaled to the body's volume again,
// and the columns are set up anew.

#include <kropla/base/error.h>
#include "domain/layer_room.h"
#include <kropla/domain/words.h>
#include "generate/box.h"
#include "generate/conform.h"
#include <kropla/generate/generate.h>
#include "generate/layers.h"
#include "generate/relax.h"
#include "generate/resample.h"
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace kropla {

namespace {

/// The points of a mesh to be: the bodies' surfaces, which may be refined, and the others of each room: of
/// the box, then of the inside of each body, in use where it has a layer.
struct Draft {
    std::vector<Surface> walls;
    std::vector<std::vector<Vec3>> others;
    std::size_t missing = 0;  // the body whose surface was the last not to be found among the facets
};

bool is_layered(const Snapshot& at, std::size_t body) { return body < at.layers.size() && at.layers[body]; }

/// The room in whose tets an inner point of the box is.
std::size_t room_of(const Snapshot& at, const Vec3& x) {
    for (std::size_t body = 0; body < at.shapes.size(); ++body)
        if (is_layered(at, body) && signed_distance(at.shapes[body], x) < 0) return body + 1;
    return 0;
}

/// What bounds tets on one side of a body's wall.
Surface bounding_surface(const Surface& wall, std::size_t body, bool inside, const Snapshot& at) {
    const auto stacks = stacks_on(wall, body, inside, at);
    return stacks ? shell_of(wall, *stacks) : wall;
}

/// The room without its points but those of surfaces.
Room empty_room(const std::vector<Surface>& walls, std::size_t room, const Snapshot& at) {
    Room made;
    for (std::size_t body = 0; body < walls.size(); ++body) {
        if (room != 0 && room != body + 1) continue;
        made.surfaces.push_back(bounding_surface(walls[body], body, room != 0, at));
        made.enclosed.push_back(region_of_body(body));
    }
    return made;
}

/// Is the room to be triangulated?
bool in_use(const Snapshot& at, std::size_t room) { return room == 0 || is_layered(at, room - 1); }

/// The sampled points, relaxed but for those of the surfaces.
Draft relaxed_draft(const Snapshot& at, std::uint64_t seed, const Watch* watch) {
    constexpr int rounds = 10;
    PointSet set = sample_points(at, seed, watch);
    std::size_t fixed = 0;
    for (const Surface& s : set.surfaces) fixed += s.points.size();
    Draft draft{.walls = std::move(set.surfaces), .others = {}};
    draft.others.resize(draft.walls.size() + 1);
    for (std::size_t i = fixed; i < set.points.size(); ++i)
        draft.others[room_of(at, set.points[i])].push_back(set.points[i]);
    const Snapshot bounded = bounded_by(draft.walls, at);
    for (std::size_t r = 0; r < draft.others.size(); ++r) {
        if (!in_use(at, r)) continue;
        Room room = empty_room(draft.walls, r, at);
        std::vector<Vec3> points = all_points(room);
        const auto free_from = static_cast<std::ptrdiff_t>(points.size());
        points.insert(points.end(), draft.others[r].begin(), draft.others[r].end());
        relax_points(points, static_cast<std::size_t>(free_from), bounded, rounds, watch);
        draft.others[r].assign(points.begin() + free_from, points.end());
    }
    return draft;
}

/// A room and its triangulation, all its surfaces among the facets.
struct FilledRoom {
    Room room;
    Triangulation filled;
    Array<Tet, Region> region;
};

/// Splits the longest edges of `triangles` of the body's wall, and frees the space around the new points.
void refine_wall(Draft& draft, std::size_t body, const std::vector<std::size_t>& triangles,
                 const Snapshot& at) {
    for (const auto& [place, half_edge] : refine_surface(draft.walls[body], triangles, at.shapes[body]))
        for (auto& others : draft.others) clear_sphere(others, at.box, {place, half_edge});
}

/// Makes room for the triangles of the room's surfaces that were not found.
void recover(Draft& draft, std::size_t r, const Room& room, const std::vector<SurfaceFacet>& found,
             const Snapshot& at) {
    const auto body_of = [&](std::size_t surface) {
        return static_cast<std::size_t>(room.enclosed[surface].value) - 1;
    };
    std::size_t cleared = 0;
    for (const SurfaceFacet& f : found) {
        if (f.inner) continue;
        draft.missing = body_of(f.surface);
        cleared += clear_sphere(draft.others[r], at.box, diametral_sphere(room.surfaces[f.surface], f.triangle));
    }
    if (cleared > 0) return;
    for (std::size_t s = 0; s < room.surfaces.size(); ++s) {
        std::vector<std::size_t> missing;
        for (const SurfaceFacet& f : found)
            if (!f.inner && f.surface == s) missing.push_back(f.triangle);
        if (!missing.empty()) refine_wall(draft, body_of(s), missing, at);
    }
}

/// Triangulates the room; if a surface is not among the facets, makes room for it in the draft instead.
std::optional<FilledRoom> filled_room(Draft& draft, std::size_t r, const Snapshot& at, const Watch* watch) {
    FilledRoom done{empty_room(draft.walls, r, at), {}, {}};
    done.room.others = draft.others[r];
    done.filled = triangulate(all_points(done.room), watch);
    heed(watch);
    const std::vector<SurfaceFacet> found = find_surfaces(done.filled, done.room);
    heed(watch);
    if (std::ranges::any_of(found, [](const SurfaceFacet& f) { return !f.inner; })) {
        recover(draft, r, done.room, found, at);
        return std::nullopt;
    }
    done.region = identify_regions(done.filled, done.room, found);
    return done;
}

/// The rooms in use, in order, filled; empty if one could not be.
std::vector<FilledRoom> filled_rooms(Draft& draft, const Snapshot& at, const Watch* watch) {
    std::vector<FilledRoom> rooms;
    bool all = true;
    for (std::size_t r = 0; r < draft.others.size(); ++r) {
        if (!in_use(at, r)) continue;
        auto filled = filled_room(draft, r, at, watch);
        all = all && filled;
        if (all) rooms.push_back(std::move(*filled));
    }
    return all ? std::move(rooms) : std::vector<FilledRoom>{};
}

/// A mesh that is put together from its rooms.
struct Assembly {
    Array<Vertex, Vec3> position;
    std::vector<PrismLayer> layers;
    std::vector<std::vector<Vertex>> inner_boundary;  // per body: the vertices that bound its tets
    std::vector<std::vector<Vertex>> outer_boundary;  // per body: those that bound the tets around it
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> region;
    std::vector<BoundaryFacet> boundary;
};

/// Adds the vertices above the wall of one layer, and the facets of its two patches. Returns the shell's
/// vertices.
std::vector<Vertex> append_layer(Assembly& a, const std::vector<Vertex>& wall, Stacks stacks) {
    const Layer name(a.layers.size());
    const auto step = static_cast<std::size_t>(stacks.layer.count + 1);
    std::vector<Vertex> shell;
    for (std::size_t i = 0; i < stacks.places.size(); ++i) {
        stacks.layer.columns.push_back(i % step == 0 ? wall[i / step]
                                                     : a.position.push_back(stacks.places[i]));
        if (i % step == step - 1) shell.push_back(stacks.layer.columns.back());
    }
    for (const auto& triangle : stacks.layer.triangles) {
        const auto of = [&](const std::vector<Vertex>& surface, std::size_t i) {
            return surface[static_cast<std::size_t>(triangle[i])];
        };
        a.boundary.push_back({{of(wall, 0), of(wall, 1), of(wall, 2)}, wall_patch(name)});
        a.boundary.push_back({{of(shell, 0), of(shell, 1), of(shell, 2)}, shell_patch(name)});
    }
    a.layers.push_back(std::move(stacks.layer));
    return shell;
}

void append_walls_and_layers(Assembly& a, const std::vector<Surface>& walls, const Snapshot& at) {
    for (std::size_t body = 0; body < walls.size(); ++body) {
        std::vector<Vertex> wall;
        for (const Vec3& x : walls[body].points) wall.push_back(a.position.push_back(x));
        auto outside = stacks_on(walls[body], body, false, at),
             inside = stacks_on(walls[body], body, true, at);
        a.outer_boundary.push_back(outside ? append_layer(a, wall, std::move(*outside)) : wall);
        a.inner_boundary.push_back(inside ? append_layer(a, wall, std::move(*inside)) : wall);
    }
}

/// The hull of the room around the bodies: the faces of the box.
void append_box_facets(Assembly& a, const Triangulation& filled, const std::vector<Vertex>& names,
                       const Box& box) {
    for (Tet t : filled.tets.indices())
        for (std::size_t i = 0; i < 4; ++i) {
            if (filled.neighbour[t][i].exists()) continue;
            std::array<Vertex, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vertex local = filled.tets[t][static_cast<std::size_t>(tet_facets[i][k])];
                corners[k] = names[static_cast<std::size_t>(local.value)];
            }
            a.boundary.push_back({corners, shared_face(box, {a.position[corners[0]], a.position[corners[1]],
                                                             a.position[corners[2]]})});
        }
}

void append_room(Assembly& a, const FilledRoom& filled, bool whole_box, const Snapshot& at) {
    std::vector<Vertex> names;
    for (Region enclosed : filled.room.enclosed) {
        const auto body = static_cast<std::size_t>(enclosed.value) - 1;
        const auto& vertices = whole_box ? a.outer_boundary[body] : a.inner_boundary[body];
        names.insert(names.end(), vertices.begin(), vertices.end());
    }
    for (const Vec3& x : filled.room.others) names.push_back(a.position.push_back(x));
    for (Tet t : filled.filled.tets.indices()) {
        const Region region = filled.region[t];
        const bool in_layered =
            region != surroundings && is_layered(at, static_cast<std::size_t>(region.value) - 1);
        if (in_layered == whole_box || (!whole_box && region == surroundings)) continue;
        auto tet = filled.filled.tets[t];
        for (Vertex& v : tet) v = names[static_cast<std::size_t>(v.value)];
        a.tets.push_back(tet);
        a.region.push_back(region);
    }
    if (whole_box) append_box_facets(a, filled.filled, names, at.box);
}

Mesh assembled(const std::vector<Surface>& walls, const std::vector<FilledRoom>& rooms, const Snapshot& at) {
    Assembly a;
    append_walls_and_layers(a, walls, at);
    for (std::size_t i = 0; i < rooms.size(); ++i) append_room(a, rooms[i], i == 0, at);
    Mesh mesh = make_mesh(std::move(a.position), std::move(a.tets), std::move(a.region), a.boundary);
    for (PrismLayer& layer : a.layers) add_layer(mesh, std::move(layer));
    return mesh;
}

}  // namespace

Mesh generate_mesh(const Domain& domain, std::uint64_t seed, const Watch* watch) {
    constexpr int recoveries = 20;
    for (const Body& body : domain.bodies)
        if (body.shape.surface && body.layer)
            throw DomainError(named(body) + ": a layer of prisms is made at spheres and ellipsoids only, not at a surface of "
                              "triangles; without [body.layer] it is meshed");
    check_placement(domain, 0, least_gap_in_sizes);
    check_layers(domain, 0);
    const Snapshot at = snapshot(domain, 0);
    Draft draft = [&] {
        try {
            return relaxed_draft(at, seed, watch);
        } catch (const BodyError& error) {
            throw DomainError(named(domain.bodies[error.body]) + ": " + error.what());
        }
    }();
    for (int i = 0; i < recoveries; ++i) {
        heed(watch, "joining cells", static_cast<double>(i) / recoveries);
        const std::vector<FilledRoom> rooms = filled_rooms(draft, at, watch);
        heed(watch);
        if (!rooms.empty()) return assembled(draft.walls, rooms, at);
    }
    throw DomainError(named(domain.bodies[draft.missing]) +
                      ": its surface cannot be made facets of the mesh; a smaller size.surface may do");
}

}  // namespace kropla
