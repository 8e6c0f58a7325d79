// Swapping: face removal (2-3) and edge removal (3-2, 4-4 and longer rings) with the best triangulation of
// the ring by dynamic programming, after [Shewchuk 2002], "Two discrete optimization algorithms for the
// topological improvement of tetrahedral meshes", who credits [Klincsek 1980]. Here the objective is the
// largest aspect ratio R/r, or a sum over the volume, for which the same recursion holds; and the ring may be
// open: an edge on a face of the box, whose two ends of the ring then close it within the face.

#include <kropla/adapt/adapt.h>
#include "adapt/constants.h"
#include "adapt/propose.h"
#include "base/tetrahedron.h"
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <bit>

namespace kropla {
namespace {

constexpr std::size_t most = longest_ring;

using Corners = std::array<const Vec3*, 4>;

/// What a set of cells is worth: the worst of them, or their sum.
struct Measure {
    SwapGoal goal;

    [[nodiscard]] double together(double a, double b) const { return goal.by_energy ? a + b : std::max(a, b); }
    /// Of up to four cells at once.
    [[nodiscard]] FourNumbers of_each(std::span<const Corners> tets) const {
        const auto which = [&](std::size_t i) { return tets[std::min(i, tets.size() - 1)]; };
        const FourPlaces four = {which(0), which(1), which(2), which(3)};
        RatiosAndEnergies of;
        if (goal.by_energy) of = tet_energies(four);
        else of.ratios = tet_aspect_ratios(four);
        FourNumbers& values = goal.by_energy ? of.energies : of.ratios;
        for (std::size_t i = 0; i < 4; ++i)
            if (of.ratios[i] > goal.limit || of.ratios[i] == infinity) values[i] = infinity;
        return values;
    }
    [[nodiscard]] double of_all(std::span<const Corners> tets) const {
        double all = 0;
        for (std::size_t first = 0; first < tets.size(); first += 4) {
            const auto some = tets.subspan(first, std::min<std::size_t>(4, tets.size() - first));
            const FourNumbers each = of_each(some);
            for (std::size_t i = 0; i < some.size(); ++i) all = together(all, each[i]);
        }
        return all;
    }
};

double of_tets(const Mesh& mesh, std::span<const Tet> tets, SwapGoal goal) {
    std::array<Corners, most> corners;
    for (std::size_t i = 0; i < tets.size(); ++i)
        for (std::size_t k = 0; k < 4; ++k) corners[i][k] = &mesh.position[mesh.tets[tets[i]][k]];
    return Measure{{goal.by_energy, infinity}}.of_all({corners.data(), tets.size()});
}

/// The best triangulation of the ring's polygon i ... j, for all i < j: what it is worth, and the third
/// corner of the triangle on the side i-j.
struct RingTable {
    double value[most][most];
    std::size_t apex[most][most];
};

/// The corners k at which the polygon i ... j may be cut, with what the two sides are worth.
struct Cuts {
    std::array<std::size_t, most> corner;
    std::array<double, most> sides;
    std::size_t count = 0;
};

Cuts cuts_of(const RingTable& table, std::size_t i, std::size_t j, const Measure& measure, double bound) {
    Cuts cuts;
    for (std::size_t k = i + 1; k < j; ++k) {
        const double sides = measure.together(table.value[i][k], table.value[k][j]);
        if (sides >= bound) continue;
        cuts.corner[cuts.count] = k;
        cuts.sides[cuts.count++] = sides;
    }
    return cuts;
}

RingTable triangulate_ring(const Mesh& mesh, Edge edge, std::span<const Vertex> ring, const Measure& measure,
                           double bound) {
    const Vec3 *a = &mesh.position[edge.a], *b = &mesh.position[edge.b];
    const auto place = [&](std::size_t i) { return &mesh.position[ring[i]]; };
    RingTable table;
    const std::size_t n = ring.size();
    for (std::size_t i = 0; i + 1 < n; ++i) table.value[i][i + 1] = 0;
    for (std::size_t width = 2; width < n; ++width)
        for (std::size_t i = 0; i + width < n; ++i) {
            const std::size_t j = i + width;
            double& best = table.value[i][j] = bound;
            const Cuts cuts = cuts_of(table, i, j, measure, bound);
            for (std::size_t first = 0; first < cuts.count; first += 2) {  // two triangles, four tets at once
                const std::size_t last = std::min(first + 1, cuts.count - 1);
                const Vec3 *p = place(i), *q = place(cuts.corner[first]), *s = place(cuts.corner[last]), *r = place(j);
                const FourNumbers each = measure.of_each(std::array<Corners, 4>{{{p, q, r, b}, {q, p, r, a}, {p, s, r, b},
                                                                         {s, p, r, a}}});
                for (std::size_t c = first; c <= last; ++c) {
                    const double above = measure.together(cuts.sides[c], each[2 * (c - first)]);
                    const double value = measure.together(above, each[2 * (c - first) + 1]);
                    if (value >= best) continue;
                    best = value;
                    table.apex[i][j] = cuts.corner[c];
                }
            }
        }
    return table;
}

/// What is to be undercut.
double bound_of(const Mesh& mesh, std::span<const Tet> tets, SwapGoal goal) {
    if (goal.by_energy) return (1 - least_energy_gain) * of_tets(mesh, tets, goal);
    return goal.limit < infinity ? goal.limit : (1 - least_gain) * of_tets(mesh, tets, goal);
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

std::optional<Cavity> face_removal(const Mesh& mesh, Facet facet, SwapGoal goal) {
    const Tet below = facet.tet, above = mesh.neighbour[below][as_size(facet.corner)];
    if (!above.exists() || mesh.region[above] != mesh.region[below]) return std::nullopt;
    const auto f = facet_vertices(mesh, facet);
    const Vertex p = mesh.tets[below][as_size(facet.corner)];
    const Vertex q = mesh.tets[above][as_size(mirror_corner(mesh, facet))];

    const Measure measure{goal};
    std::array<Corners, 3> around;
    for (std::size_t i = 0; i < 3; ++i)
        around[i] = {&mesh.position[p], &mesh.position[f[i]], &mesh.position[f[(i + 1) % 3]], &mesh.position[q]};
    const double after = measure.of_all(around);
    if (after >= bound_of(mesh, std::array{below, above}, goal)) return std::nullopt;
    Cavity cavity;
    cavity.removed = {below, above};
    cavity.worst_before = of_tets(mesh, cavity.removed, goal);
    cavity.worst_after = after;
    for (std::size_t i = 0; i < 3; ++i)
        cavity.added.push_back({{p, f[i], f[(i + 1) % 3], q}, mesh.region[below]});
    return cavity;
}

std::optional<Cavity> edge_removal(const Mesh& mesh, const Shell& shell, Edge edge, SwapGoal goal) {
    if (shell.ring.size() > most || shell.ring.size() < 3) return std::nullopt;
    const Constraint held = constraint(mesh, shell);
    if (held.rigid() || std::popcount(held.patches) > 1) return std::nullopt;

    const double bound = bound_of(mesh, shell.tets, goal);
    const auto table = triangulate_ring(mesh, edge, shell.ring, Measure{goal}, bound);
    const double after = table.value[0][shell.ring.size() - 1];
    if (after >= bound) return std::nullopt;

    Cavity cavity;
    cavity.worst_before = of_tets(mesh, shell.tets, goal);
    cavity.worst_after = after;
    const Patch patch = shell.closed ? Patch{} : Patch(std::countr_zero(held.patches));
    cavity.removed = shell.tets;
    add_tets({edge, shell.ring, mesh.region[shell.tets.front()], patch}, table, 0, shell.ring.size() - 1, cavity);
    return cavity;
}

bool fill_half(const Mesh& mesh, Edge edge, std::span<const Vertex> ring, Region region, Cavity& cavity) {
    if (ring.size() > most) return false;
    const auto table = triangulate_ring(mesh, edge, ring, Measure{}, infinity);
    if (!(table.value[0][ring.size() - 1] < infinity)) return false;
    add_tets({edge, ring, region, Patch{}}, table, 0, ring.size() - 1, cavity);
    return true;
}

}  // namespace kropla
