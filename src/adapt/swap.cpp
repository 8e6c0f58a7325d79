// Swapping: face removal (2-3) and edge removal (3-2, 4-4 and longer rings) with the best triangulation of the ring by
// dynamic programming, after [Shewchuk 2002], "Two discrete optimization algorithms for the topological improvement of
// tetrahedral meshes", who credits [Klincsek 1980]. Here the objective is the largest aspect ratio R/r, and the ring
// may be open: an edge on a face of the box, whose two ends of the ring then close it within the face.

#include "adapt/adapt.h"
#include "base/tetrahedron.h"
#include "mesh/quality.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_gain = 1e-3;  // relative fall of the worst ratio that pays
constexpr std::size_t most = longest_ring;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The best triangulation of the ring's polygon i ... j, for all i < j: its worst ratio, and the third corner of the
/// triangle on the side i-j.
struct RingTable {
    double worst[most][most];
    std::size_t apex[most][most];
};

RingTable triangulate_ring(const Mesh& mesh, Edge edge, std::span<const Vertex> ring, double bound) {
    const Vec3 a = mesh.position[edge.a], b = mesh.position[edge.b];
    const auto worst_of_triangle = [&](std::size_t i, std::size_t k, std::size_t j) {
        const Vec3 p = mesh.position[ring[i]], q = mesh.position[ring[k]], r = mesh.position[ring[j]];
        const double above = tet_aspect_ratio(p, q, r, b);
        return above >= bound ? infinity : std::max(above, tet_aspect_ratio(q, p, r, a));
    };
    RingTable table;
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i + 1 < n; ++i) table.worst[i][i + 1] = 0;
    for (std::size_t width = 2; width < n; ++width)
        for (std::size_t i = 0; i + width < n; ++i) {
            const std::size_t j = i + width;
            table.worst[i][j] = infinity;
            for (std::size_t k = i + 1; k < j; ++k) {
                const double sides = std::max(table.worst[i][k], table.worst[k][j]);
                if (sides >= bound || sides >= table.worst[i][j]) continue;
                const double worst = std::max(sides, worst_of_triangle(i, k, j));
                if (worst >= table.worst[i][j]) continue;
                table.worst[i][j] = worst;
                table.apex[i][j] = k;
            }
        }
    return table;
}

struct RingTriangles {
    Edge edge;
    std::span<const Vertex> ring;
    Region region;
    Patch patch;  // of the open side of the ring, if it is open
};

/// Adds the tets over and under the triangles of the polygon i ... j.
void add_tets(const RingTriangles& of, const RingTable& table, std::size_t i, std::size_t j, Cavity& cavity) {
    if (j == i + 1) return;
    const std::size_t k = table.apex[i][j];
    const Vertex p = of.ring[i], q = of.ring[k], r = of.ring[j];
    const Patch side = i == 0 && j + 1 == of.ring.size() ? of.patch : Patch{};
    cavity.added.push_back({{p, q, r, of.edge.b}, of.region, {Patch{}, side, Patch{}, Patch{}}});
    cavity.added.push_back({{q, p, r, of.edge.a}, of.region, {side, Patch{}, Patch{}, Patch{}}});
    add_tets(of, table, i, k, cavity);
    add_tets(of, table, k, j, cavity);
}

}  // namespace

std::optional<Cavity> face_removal(const Mesh& mesh, Facet facet) {
    const Tet below = facet.tet, above = mesh.neighbour[below][at(facet.corner)];
    if (!above.exists() || mesh.region[above] != mesh.region[below]) return std::nullopt;
    const auto f = facet_vertices(mesh, facet);
    const Vertex p = mesh.tets[below][at(facet.corner)];
    const Vertex q = mesh.tets[above][at(mirror_corner(mesh, facet))];

    Cavity cavity;
    cavity.worst_before = std::max(aspect_ratio(mesh, below), aspect_ratio(mesh, above));
    const double bound = (1 - least_gain) * cavity.worst_before;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex a = f[i], b = f[(i + 1) % 3];
        const double ratio =
            tet_aspect_ratio(mesh.position[p], mesh.position[a], mesh.position[b], mesh.position[q]);
        if (ratio >= bound) return std::nullopt;
        cavity.worst_after = std::max(cavity.worst_after, ratio);
    }
    cavity.removed = {below, above};
    for (std::size_t i = 0; i < 3; ++i)
        cavity.added.push_back({{p, f[i], f[(i + 1) % 3], q}, mesh.region[below]});
    return cavity;
}

std::optional<Cavity> edge_removal(const Mesh& mesh, const Shell& shell, Edge edge) {
    if (shell.ring.size() > most || shell.ring.size() < 3) return std::nullopt;
    const Constraint held = constraint(mesh, shell);
    if (held.rigid() || std::popcount(held.patches) > 1) return std::nullopt;

    Cavity cavity;
    cavity.worst_before = worst_aspect_ratio(mesh, shell.tets);
    const double bound = (1 - least_gain) * cavity.worst_before;
    const auto table = triangulate_ring(mesh, edge, shell.ring, bound);
    cavity.worst_after = table.worst[0][shell.ring.size() - 1];
    if (cavity.worst_after >= bound) return std::nullopt;

    const Patch patch = shell.closed ? Patch{} : Patch(std::countr_zero(held.patches));
    cavity.removed = shell.tets;
    add_tets({edge, shell.ring, mesh.region[shell.tets.front()], patch}, table, 0, shell.ring.size() - 1, cavity);
    return cavity;
}

}  // namespace kropla
