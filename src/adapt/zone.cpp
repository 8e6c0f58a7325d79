#include "adapt/zone.h"

#include "adapt/for_all.h"
#include "base/tetrahedron.h"
#include "mesh/cells.h"

#include <algorithm>
#include <numeric>

namespace kropla {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }
constexpr unsigned char all_axes = 7;

int add_vertex(Zone& zone, const Mesh& mesh, Vertex v, unsigned char axes) {
    if (const int known = zone.number(v); known >= 0) return known;
    zone.vertices.push_back(v);
    zone.start.push_back(mesh.position[v]);
    zone.axes.push_back(axes);
    return zone.number.add(v);
}

/// The vertices of the facets of the cell on the boundary stay on it; those of an interface stay.
void hold_to_boundary(Zone& zone, const Mesh& mesh, Tet t, const std::array<int, 4>& corners) {
    for (int i = 0; i < 4; ++i) {
        const Patch patch = mesh.patch[t][at(i)];
        const Tet n = mesh.neighbour[t][at(i)];
        unsigned char kept = all_axes;
        if (n.exists()) kept = mesh.region[n] == mesh.region[t] ? all_axes : 0;
        else kept = patch.value < box_faces ? static_cast<unsigned char>(all_axes & ~(1 << patch.value / 2)) : 0;
        if (kept == all_axes) continue;
        for (int corner : tet_facets[at(i)]) zone.axes[at(corners[at(corner)])] &= kept;
    }
}

double ratio_at(const std::vector<Vec3>& places, const std::array<int, 4>& v) {
    return tet_aspect_ratio(places[at(v[0])], places[at(v[1])], places[at(v[2])], places[at(v[3])]);
}

}  // namespace

bool has_turn(const Zone& zone, int name) {
    constexpr std::size_t turns = 8;
    return !zone.turn || (at(name) + *zone.turn) % turns == 0;
}

void clear(Zone& zone) {
    zone.cells.clear();
    zone.corners.clear();
    zone.vertices.clear();
    zone.start.clear();
    zone.axes.clear();
    zone.number.clear();
    zone.cell_number.clear();
}

int add_held(Zone& zone, const Mesh& mesh, Vertex v) { return add_vertex(zone, mesh, v, 0); }

void add_cell(Zone& zone, const Mesh& mesh, Tet t) {
    if (zone.cell_number(t) >= 0) return;
    zone.cell_number.add(t);
    zone.cells.push_back(t);
    std::array<int, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = add_vertex(zone, mesh, mesh.tets[t][i], all_axes);
    zone.corners.push_back(corners);
    hold_to_boundary(zone, mesh, t, corners);
}

void close(Zone& zone, const Mesh& mesh) {
    for (std::size_t cell = 0; cell < zone.cells.size(); ++cell)
        for (int i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[zone.cells[cell]][at(i)];
            if (!n.exists() || zone.cell_number(n) >= 0) continue;
            for (int corner : tet_facets[at(i)]) zone.axes[at(zone.corners[cell][at(corner)])] = 0;
        }
    zone.place = zone.start;
    zone.ball_begin.assign(zone.vertices.size() + 1, 0);
    for (const auto& corners : zone.corners)
        for (int v : corners) ++zone.ball_begin[at(v) + 1];
    std::partial_sum(zone.ball_begin.begin(), zone.ball_begin.end(), zone.ball_begin.begin());
    zone.ball.resize(4 * zone.cells.size());
    for (std::size_t cell = zone.cells.size(); cell-- > 0;)  // backwards: each ball ends in ascending order
        for (int v : zone.corners[cell]) zone.ball[at(--zone.ball_begin[at(v) + 1])] = static_cast<int>(cell);
    zone.ball_begin.erase(zone.ball_begin.begin());
    zone.ball_begin.push_back(static_cast<int>(zone.ball.size()));
}

void gather(Zone& zone, const Mesh& mesh, std::span<const Tet> cells) {
    clear(zone);
    for (Tet t : cells)
        if (alive(mesh, t)) add_cell(zone, mesh, t);
    close(zone, mesh);
}

void find_sizes(Zone& zone, const Snapshot& at_time) {
    zone.size.resize(zone.place.size());
    for_all(zone.place.size(), [&](std::size_t v) { zone.size[v] = target_size(at_time, zone.place[v]); });
}

double aspect_ratio(const Zone& zone, int cell) { return ratio_at(zone.place, zone.corners[at(cell)]); }

double start_ratio(const Zone& zone, int cell) { return ratio_at(zone.start, zone.corners[at(cell)]); }

void star_of_ball(const Zone& zone, int vertex, std::vector<StarFacet>& star) {
    star.clear();
    for (int i = zone.ball_begin[at(vertex)]; i < zone.ball_begin[at(vertex) + 1]; ++i) {
        const auto& v = zone.corners[at(zone.ball[at(i)])];
        const std::size_t corner = v[0] == vertex ? 0 : v[1] == vertex ? 1 : v[2] == vertex ? 2 : 3;
        const auto& f = tet_facets[corner];
        star.push_back({zone.place[at(v[at(f[0])])], zone.place[at(v[at(f[1])])], zone.place[at(v[at(f[2])])]});
    }
}

Freedom freedom(const Zone& zone, int vertex) {
    const unsigned axes = zone.axes[at(vertex)];
    return {{(axes & 1) != 0, (axes & 2) != 0, (axes & 4) != 0}};
}

void write_places(const Zone& zone, Mesh& mesh) {
    for (std::size_t i = 0; i < zone.vertices.size(); ++i) mesh.position[zone.vertices[i]] = zone.place[i];
}

}  // namespace kropla
