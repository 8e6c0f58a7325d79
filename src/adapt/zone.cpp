#include "adapt/zone.h"

#include "base/for_all.h"
#include "base/tetrahedron.h"
#include <kropla/mesh/cells.h>

#include <algorithm>

namespace kropla {
namespace {

/// Makes room for what the mesh has.
void fit(Zone& zone, const Mesh& mesh) {
    if (zone.ball.size() >= mesh.position.size()) return;
    zone.ball.resize(mesh.position.size());
    zone.axes.resize(mesh.position.size(), 0);
}

/// What the facet opposite the corner lets its vertices do: the axes along which they may slide, or `rim`.
unsigned char axes_at(const Zone& zone, const Mesh& mesh, Tet t, int corner) {
    const Tet n = mesh.neighbour[t][as_size(corner)];
    if (n.exists()) {
        if (mesh.region[n] != mesh.region[t]) return 0;
        return zone.holds.contains(n) ? Zone::all_axes : Zone::rim;
    }
    const Patch patch = mesh.patch[t][as_size(corner)];
    return patch.value < box_faces ? static_cast<unsigned char>(Zone::all_axes & ~(1 << patch.value / 2)) : 0;
}

unsigned char axes_of(const Zone& zone, const Mesh& mesh, Vertex v) {
    unsigned char axes = Zone::all_axes, rim = 0;
    for (Tet t : zone.ball[v])
        for (int corner = 0; corner < 4; ++corner) {
            if (mesh.tets[t][as_size(corner)] == v) continue;
            const unsigned char here = axes_at(zone, mesh, t, corner);
            axes &= here;
            rim |= here & Zone::rim;
        }
    return axes | rim;
}

void insert(Zone& zone, const Mesh& mesh, Tet t, IndexSet<Vertex>& touched) {
    if (!zone.holds.insert(t)) return;
    for (Vertex v : mesh.tets[t]) {
        zone.has.insert(v);
        zone.ball[v].push_back(t);
        touched.insert(v);
    }
}

/// Puts the balls of vertices whose cells have changed in order, and asks anew what holds them.
void settle(Zone& zone, const Mesh& mesh, const IndexSet<Vertex>& touched) {
    const auto vertices = touched.list();
    for_all(vertices.size(), [&](std::size_t i) {
        const Vertex v = vertices[i];
        auto& ball = zone.ball[v];
        std::erase_if(ball, [&](Tet t) { return !zone.holds.contains(t) || corner_of(mesh, t, v) < 0; });
        std::ranges::sort(ball);
        ball.erase(std::unique(ball.begin(), ball.end()), ball.end());
        zone.axes[v] = axes_of(zone, mesh, v);
    }, 32);
    for (Vertex v : vertices)
        if (zone.ball[v].empty()) zone.has.erase(v);
}

}  // namespace

void add_cells(Zone& zone, const Mesh& mesh, std::span<const Tet> cells) {
    fit(zone, mesh);
    IndexSet<Vertex> touched;
    for (Tet t : cells) insert(zone, mesh, t, touched);
    settle(zone, mesh, touched);
}

void follow(Zone& zone, const Mesh& mesh, const IndexSet<Tet>& replaced) {
    if (zone.holds.size() == 0) return;
    fit(zone, mesh);
    std::vector<Tet> cells;
    IndexSet<Vertex> touched;
    replaced.for_each([&](Tet t) {
        zone.holds.erase(t);
        if (as_size(t.value) >= mesh.tets.size() || !alive(mesh, t)) return;
        for (Vertex v : mesh.tets[t]) touched.insert(v);
        if (zone.takes(mesh.region[t])) cells.push_back(t);
    });
    for (Tet t : cells) zone.holds.insert(t);
    const auto is_old = [&](Tet t) { return replaced.contains(t); };
    touched.for_each([&](Vertex v) { std::erase_if(zone.ball[v], is_old); });
    for (Tet t : cells) {
        for (Vertex v : mesh.tets[t]) {
            auto& ball = zone.ball[v];
            ball.insert(std::ranges::upper_bound(ball, t), t);
            zone.has.insert(v);
        }
        for (int corner = 0; corner < 4; ++corner)
            if (axes_at(zone, mesh, t, corner) != Zone::all_axes)
                for (Vertex v : facet_vertices(mesh, {t, corner})) zone.axes[v] = 0;  // to be asked anew
    }
    touched.for_each([&](Vertex v) {
        // Where all was within the zone, and what is new is too, it still is.
        if (zone.axes[v] != Zone::all_axes) zone.axes[v] = axes_of(zone, mesh, v);
    });
    zone.has.for_each([&](Vertex v) {
        if (as_size(v.value) < mesh.position.size() && alive(mesh, v) && !zone.ball[v].empty()) return;
        zone.ball[v].clear();
        zone.has.erase(v);
    });
}

void shrink(Zone& zone, const Mesh& mesh, const IndexSet<Tet>& stay) {
    IndexSet<Vertex> touched;
    zone.holds.for_each([&](Tet t) {
        if (stay.contains(t)) return;
        zone.holds.erase(t);
        for (Vertex v : mesh.tets[t]) touched.insert(v);
    });
    settle(zone, mesh, touched);
}

void begin_motion(ZoneMotion& motion) {
    for (Vertex v : motion.vertices) motion.moves[v] = 0;
    for (Vertex v : motion.bodies) motion.moves[v] = 0;
    motion.bodies.clear();
    motion.vertices.clear();
    motion.cells.clear();
    motion.beyond.clear();
}

void fit(ZoneMotion& motion, const Mesh& mesh) {
    const std::size_t vertices = mesh.position.size(), tets = mesh.tets.size();
    if (motion.moves.size() < vertices) {
        motion.moves.resize(vertices, 0);
        motion.place.resize(vertices);
        motion.size.resize(vertices, 1);
    }
    if (motion.ratio.size() < tets) {
        motion.ratio.resize(tets, 0);
        motion.centroid.resize(tets);
    }
}

MovableCells movable(const Mesh& mesh, std::span<const Tet> cells, const Snapshot* at_time) {
    MovableCells result;
    auto& [zone, motion] = result;
    std::vector<Tet> living;
    std::ranges::copy_if(cells, std::back_inserter(living), [&](Tet t) { return alive(mesh, t); });
    add_cells(zone, mesh, living);
    fit(motion, mesh);
    motion.vertices = zone.has.list();
    for (Vertex v : motion.vertices) {
        motion.moves[v] = ZoneMotion::by_itself;
        motion.place[v] = mesh.position[v];
    }
    list_cells(zone, motion, mesh);
    if (at_time) find_sizes(motion, *at_time);
    return result;
}

void list_cells(const Zone& zone, ZoneMotion& motion, const Mesh& mesh) {
    motion.cells.clear();
    motion.beyond.clear();
    zone.holds.for_each([&](Tet t) {
        const auto& v = mesh.tets[t];
        const auto moves = motion.moves[v[0]] | motion.moves[v[1]] | motion.moves[v[2]] | motion.moves[v[3]];
        if ((moves & (ZoneMotion::by_itself | ZoneMotion::with_body)) != 0) motion.cells.push_back(t);
        else if (moves != 0) motion.beyond.push_back(t);
    });
}

void find_sizes(ZoneMotion& motion, const Snapshot& at_time) {
    for_all(motion.vertices.size(), [&](std::size_t i) {
        const Vertex v = motion.vertices[i];
        motion.size[v] = target_size(at_time, motion.place[v]);
    });
}

double aspect_ratio(const ZoneMotion& motion, const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return tet_aspect_ratio(motion.place[v[0]], motion.place[v[1]], motion.place[v[2]], motion.place[v[3]]);
}

Freedom freedom(const Zone& zone, const ZoneMotion& motion, Vertex v) {
    const unsigned axes = motion.moves[v] == ZoneMotion::by_itself ? zone.axes[v] : 0u;
    return {{(axes & 1) != 0, (axes & 2) != 0, (axes & 4) != 0}};
}

std::vector<Vec3> places(const ZoneMotion& motion) {
    std::vector<Vec3> now;
    for (Vertex v : motion.vertices) now.push_back(motion.place[v]);
    return now;
}

void put_back(ZoneMotion& motion, std::span<const Vec3> places) {
    for (std::size_t i = 0; i < places.size(); ++i) motion.place[motion.vertices[i]] = places[i];
}

std::vector<Vertex> vertices_of_worse(const Zone& zone, const ZoneMotion& motion, const Mesh& mesh, double above) {
    IndexSet<Vertex> vertices;
    for (Tet t : motion.cells)
        if (motion.ratio[t] > above)
            for (Vertex v : mesh.tets[t])
                if (!freedom(zone, motion, v).none()) vertices.insert(v);
    return vertices.list();
}

void write_places(const ZoneMotion& motion, Mesh& mesh) {
    for (Vertex v : motion.bodies) mesh.position[v] = motion.place[v];
    for (Vertex v : motion.vertices)
        if (motion.moves[v] != 0) mesh.position[v] = motion.place[v];
}

}  // namespace kropla
