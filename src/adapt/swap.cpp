// Swapping: face removal (2-3) and edge removal (3-2, 4-4 and longer rings) with the best triangulation of
// the ring by dynamic programming, after [Shewchuk 2002], "Two discrete optimization algorithms for the
// topological improvement of tetrahedral meshes", who credits [Klincsek 1980]. Here the objective is the
// largest aspect ratio R/r, or a sum over the volume, for which the same recursion holds; and the ring may be
// open: an edge on a face of the box, whose two ends of the ring then close it within the face.

#include "adapt/adapt.h"
#include "base/tetrahedron.h"
#include "mesh/quality.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double least_gain = 1e-3;         // relative fall of the worst ratio that pays
constexpr double least_energy_gain = 0.05;  // and of the energy
constexpr std::size_t most = longest_ring;

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// What a set of cells is worth: the worst of them, or their sum.
struct Measure {
    SwapGoal goal;

    [[nodiscard]] double together(double a, double b) const { return goal.by_energy ? a + b : std::max(a, b); }
    [[nodiscard]] double of_tet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
        const double ratio = tet_aspect_ratio(a, b, c, d);
        if (ratio > goal.limit) return infinity;
        return goal.by_energy ? tet_volume(a, b, c, d) * (ratio * ratio) * (ratio * ratio) : ratio;
    }
};

double of_tets(const Mesh& mesh, std::span<const Tet> tets, SwapGoal goal) {
    const Measure measure{{goal.by_energy, infinity}};
    double all = 0;
    for (Tet t : tets) {
        const auto& v = mesh.tets[t];
        all = measure.together(all, measure.of_tet(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]],
                                                   mesh.position[v[3]]));
    }
    return all;
}

/// The best triangulation of the ring's polygon i ... j, for all i < j: what it is worth, and the third
/// corner of the triangle on the side i-j.
struct RingTable {
    double value[most][most];
    std::size_t apex[most][most];
};

RingTable triangulate_ring(const Mesh& mesh, Edge edge, std::span<const Vertex> ring, const Measure& measure,
                           double bound) {
    const Vec3 a = mesh.position[edge.a], b = mesh.position[edge.b];
    const auto with_triangle = [&](double sides, std::size_t i, std::size_t k, std::size_t j, double limit) {
        const Vec3 p = mesh.position[ring[i]], q = mesh.position[ring[k]], r = mesh.position[ring[j]];
        const double above = measure.together(sides, measure.of_tet(p, q, r, b));
        return above >= limit ? infinity : measure.together(above, measure.of_tet(q, p, r, a));
    };
    RingTable table;
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i + 1 < n; ++i) table.value[i][i + 1] = 0;
    for (std::size_t width = 2; width < n; ++width)
        for (std::size_t i = 0; i + width < n; ++i) {
            const std::size_t j = i + width;
            table.value[i][j] = bound;
            for (std::size_t k = i + 1; k < j; ++k) {
                const double sides = measure.together(table.value[i][k], table.value[k][j]);
                if (sides >= table.value[i][j]) continue;
                const double value = with_triangle(sides, i, k, j, table.value[i][j]);
                if (value >= table.value[i][j]) continue;
                table.value[i][j] = value;
                table.apex[i][j] = k;
            }
        }
    return table;
}

double gain_asked(SwapGoal goal) { return goal.by_energy ? least_energy_gain : least_gain; }

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

std::optional<Cavity> face_removal(const Mesh& mesh, Facet facet, SwapGoal goal) {
    const Tet below = facet.tet, above = mesh.neighbour[below][at(facet.corner)];
    if (!above.exists() || mesh.region[above] != mesh.region[below]) return std::nullopt;
    const auto f = facet_vertices(mesh, facet);
    const Vertex p = mesh.tets[below][at(facet.corner)];
    const Vertex q = mesh.tets[above][at(mirror_corner(mesh, facet))];

    const Measure measure{goal};
    const double before = of_tets(mesh, std::array{below, above}, goal);
    const double bound = (1 - gain_asked(goal)) * before;
    double after = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vertex a = f[i], b = f[(i + 1) % 3];
        after = measure.together(
            after, measure.of_tet(mesh.position[p], mesh.position[a], mesh.position[b], mesh.position[q]));
        if (after >= bound) return std::nullopt;
    }
    Cavity cavity;
    cavity.worst_before = before;
    cavity.worst_after = after;
    cavity.removed = {below, above};
    for (std::size_t i = 0; i < 3; ++i)
        cavity.added.push_back({{p, f[i], f[(i + 1) % 3], q}, mesh.region[below]});
    return cavity;
}

std::optional<Cavity> edge_removal(const Mesh& mesh, const Shell& shell, Edge edge, SwapGoal goal) {
    if (shell.ring.size() > most || shell.ring.size() < 3) return std::nullopt;
    const Constraint held = constraint(mesh, shell);
    if (held.rigid() || std::popcount(held.patches) > 1) return std::nullopt;

    const double before = of_tets(mesh, shell.tets, goal);
    const double bound = (1 - gain_asked(goal)) * before;
    const auto table = triangulate_ring(mesh, edge, shell.ring, Measure{goal}, bound);
    const double after = table.value[0][shell.ring.size() - 1];
    if (after >= bound) return std::nullopt;

    Cavity cavity;
    cavity.worst_before = before;
    cavity.worst_after = after;
    const Patch patch = shell.closed ? Patch{} : Patch(std::countr_zero(held.patches));
    cavity.removed = shell.tets;
    add_tets({edge, shell.ring, mesh.region[shell.tets.front()], patch}, table, 0, shell.ring.size() - 1, cavity);
    return cavity;
}

}  // namespace kropla
