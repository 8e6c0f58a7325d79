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

int number_vertex(Zone& zone, const Mesh& mesh, Vertex v, unsigned char axes) {
    if (const int known = zone.number(v); known >= 0) return known;
    zone.vertices.push_back(v);
    zone.start.push_back(mesh.position[v]);
    zone.axes.push_back(axes);
    return zone.number.add(v);
}

/// The axes along which the vertices of a facet of the zone may slide.
unsigned char axes_of(const Zone& zone, const Mesh& mesh, Facet facet) {
    const Tet n = mesh.neighbour[facet.tet][at(facet.corner)];
    if (n.exists()) return zone.holds.contains(n) && mesh.region[n] == mesh.region[facet.tet] ? all_axes : 0;
    const Patch patch = mesh.patch[facet.tet][at(facet.corner)];
    return patch.value < box_faces ? static_cast<unsigned char>(all_axes & ~(1 << patch.value / 2)) : 0;
}

void add_cell(Zone& zone, const Mesh& mesh, Tet t) {
    std::array<int, 4> corners{};
    for (std::size_t i = 0; i < 4; ++i) corners[i] = number_vertex(zone, mesh, mesh.tets[t][i], all_axes);
    zone.cells.push_back(t);
    zone.corners.push_back(corners);
    for (int i = 0; i < 4; ++i) {
        const unsigned char axes = axes_of(zone, mesh, {t, i});
        if (axes == all_axes) continue;
        for (int corner : tet_facets[at(i)]) zone.axes[at(corners[at(corner)])] &= axes;
    }
}

void find_balls(Zone& zone) {
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

}  // namespace

void clear(Zone& zone) {
    zone.holds.clear();
    zone.cells.clear();
    zone.corners.clear();
    zone.vertices.clear();
    zone.start.clear();
    zone.axes.clear();
    zone.number.clear();
}

void add_held(Zone& zone, const Mesh& mesh, Vertex v) { number_vertex(zone, mesh, v, 0); }

void close(Zone& zone, const Mesh& mesh) {
    zone.cells.reserve(zone.holds.size());
    zone.corners.reserve(zone.holds.size());
    zone.holds.for_each([&](Tet t) { add_cell(zone, mesh, t); });
    zone.place = zone.start;
    find_balls(zone);
}

void gather(Zone& zone, const Mesh& mesh, std::span<const Tet> cells) {
    clear(zone);
    for (Tet t : cells)
        if (alive(mesh, t)) zone.holds.insert(t);
    close(zone, mesh);
}

void find_sizes(Zone& zone, const Snapshot& at_time) {
    zone.size.resize(zone.place.size());
    for_all(zone.place.size(), [&](std::size_t v) { zone.size[v] = target_size(at_time, zone.place[v]); });
}

double aspect_ratio(const Zone& zone, int cell) {
    const auto& v = zone.corners[at(cell)];
    return tet_aspect_ratio(zone.place[at(v[0])], zone.place[at(v[1])], zone.place[at(v[2])], zone.place[at(v[3])]);
}

FourPlaces four_cells(const Zone& zone, std::size_t first, const std::vector<Vec3>& places) {
    FourPlaces tets;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& v = zone.corners[std::min(first + i, zone.corners.size() - 1)];
        for (std::size_t k = 0; k < 4; ++k) tets[i][k] = &places[at(v[k])];
    }
    return tets;
}

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
