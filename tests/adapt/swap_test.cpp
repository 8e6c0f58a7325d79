#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "base/random.h"
#include "base/tetrahedron.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

const Edge axis{Vertex(0), Vertex(1)};  // of the shells below

/// two_tets with the apexes at z = +-height.
Mesh two_tets_of_height(double height) {
    Mesh mesh = two_tets();
    mesh.position[Vertex(3)] = {0, 0, height};
    mesh.position[Vertex(4)] = {0, 0, -height};
    return mesh;
}

/// Carries the proposal out and checks what is to hold for every swap.
void expect_good_swap(Mesh& mesh, const std::optional<Cavity>& cavity) {
    ASSERT_TRUE(cavity);
    const Properties before = properties(mesh);
    EXPECT_EQ(cavity->worst_before, worst_aspect_ratio(mesh, cavity->removed));
    EXPECT_LT(cavity->worst_after, cavity->worst_before);
    const auto added = replace_cells(mesh, *cavity).cells;
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), before));
    EXPECT_NEAR(cavity->worst_after, worst_aspect_ratio(mesh, added), 1e-9 * cavity->worst_after);
}

TEST(FaceRemoval, TwoFlatTetsBecomeThree) {
    Mesh mesh = two_tets_of_height(0.4);
    const Properties before = properties(mesh);
    expect_good_swap(mesh, face_removal(mesh, {Tet(0), 3}));
    EXPECT_EQ(count_tets(mesh), 3);
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_TRUE(shell(mesh, Edge{Vertex(3), Vertex(4)}));
}

TEST(FaceRemoval, Refuses) {
    EXPECT_FALSE(face_removal(two_tets_of_height(0.4), {Tet(0), 0})) << "a facet of the boundary";
    EXPECT_FALSE(face_removal(two_tets_of_height(1.5), {Tet(0), 3})) << "no gain";

    Mesh two_regions = two_tets_of_height(0.4);
    two_regions.region[Tet(1)] = Region(1);
    EXPECT_FALSE(face_removal(two_regions, {Tet(0), 3})) << "an interface";

    Mesh bent = two_tets_of_height(0.4);  // the edge between the apexes would miss the facet
    bent.position[Vertex(3)] = {2, 1, 0.4};
    ASSERT_EQ(verify(bent), "");
    EXPECT_FALSE(face_removal(bent, {Tet(0), 3})) << "a tet would turn over";
}

/// The shell with its edge at x = 0.93 instead of in the middle of the ring, so that the tets there are flat.
Mesh off_centre(Mesh mesh) {
    mesh.position[Vertex(0)].x = mesh.position[Vertex(1)].x = 0.93;
    EXPECT_EQ(verify(mesh), "");
    return mesh;
}

std::optional<Cavity> remove_axis(const Mesh& mesh) { return edge_removal(mesh, *shell(mesh, axis), axis); }

TEST(EdgeRemoval, ClosedRings) {
    for (int n = 3; n <= longest_ring; ++n) {
        SCOPED_TRACE("ring of " + std::to_string(n));
        Mesh mesh = off_centre(shell_of_edge(n));
        if (n == 3) mesh.position[Vertex(0)].x = mesh.position[Vertex(1)].x = 0.8;
        const Properties before = properties(mesh);
        expect_good_swap(mesh, remove_axis(mesh));
        EXPECT_EQ(count_tets(mesh), 2 * (n - 2));
        EXPECT_TRUE(same(properties(mesh), before));
        EXPECT_FALSE(shell(mesh, axis));
    }
}

TEST(EdgeRemoval, OpenRingsOnAFaceOfTheBox) {
    for (int n = 2; n < longest_ring; ++n) {
        SCOPED_TRACE("ring of " + std::to_string(n + 1));
        Mesh mesh = off_centre(open_shell_of_edge(n));
        const auto cavity = remove_axis(mesh);
        expect_good_swap(mesh, cavity);
        EXPECT_EQ(count_tets(mesh), 2 * (n - 1));
        EXPECT_FALSE(shell(mesh, axis));
        const auto shape = properties(mesh);
        const auto in_face = std::ranges::count(shape.boundary, Patch(2), &BoundaryFacet::patch);
        EXPECT_EQ(in_face, 2);  // the other two triangles of the quadrilateral
        const auto across = shell(mesh, Edge{Vertex(2), Vertex(n + 2)});
        ASSERT_TRUE(across);
        EXPECT_EQ(constraint(mesh, *across).patches, 1u << 2);
    }
}

TEST(EdgeRemoval, Refuses) {
    EXPECT_FALSE(remove_axis(off_centre(shell_of_edge(longest_ring + 1)))) << "the ring is too long";
    EXPECT_FALSE(remove_axis(off_centre(open_shell_of_edge(longest_ring)))) << "the open ring is too long";
    EXPECT_FALSE(remove_axis(shell_of_edge(5))) << "no gain";
    EXPECT_FALSE(remove_axis(one_tet())) << "a single tet";

    Mesh two_regions = off_centre(shell_of_edge(5));
    two_regions.region[Tet(1)] = Region(1);
    EXPECT_FALSE(remove_axis(two_regions)) << "an edge of an interface";

    Mesh rigid = off_centre(open_shell_of_edge(4)), two_patches = rigid;
    ASSERT_TRUE(remove_axis(rigid));
    rename_patch(rigid, Patch(2), rigid_patch);
    EXPECT_FALSE(remove_axis(rigid)) << "a surface that is to stay as it is";
    std::ranges::replace(two_patches.patch[Tet(0)], Patch(2), Patch(3));
    EXPECT_FALSE(remove_axis(two_patches)) << "an edge between two patches";

    // Ring vertices under the plane of the others: the part of the ring that is left would turn over.
    Mesh bent = shell_of_edge(3);
    for (int i = 2; i <= 4; ++i) bent.position[Vertex(i)].z = -1.2;
    EXPECT_FALSE(remove_axis(bent)) << "a tet would turn over";
}

/// What a set of tets is worth by the goal: with `a` and `b` what two parts of it are.
double together(SwapGoal goal, double a, double b) { return goal.by_energy ? a + b : std::max(a, b); }

/// Its worst aspect ratio or its energy, V (R/r)^4; infinite above the limit.
double worth(SwapGoal goal, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const double ratio = tet_aspect_ratio(a, b, c, d);
    if (ratio > goal.limit) return std::numeric_limits<double>::infinity();
    return goal.by_energy ? tet_volume(a, b, c, d) * std::pow(ratio, 4) : ratio;
}

double energy(const Mesh& mesh, std::span<const Tet> tets) {
    double sum = 0;
    for (Tet t : tets) sum += volume(mesh, t) * std::pow(aspect_ratio(mesh, t), 4);
    return sum;
}

/// The best over all triangulations of the ring's polygon i ... j.
double best_by_trying_all(const Mesh& mesh, std::span<const Vertex> ring, std::size_t i, std::size_t j,
                          SwapGoal goal = {}) {
    if (j == i + 1) return 0;
    const Vec3 a = mesh.position[axis.a], b = mesh.position[axis.b];
    const Vec3 p = mesh.position[ring[i]], r = mesh.position[ring[j]];
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t k = i + 1; k < j; ++k) {
        const Vec3 q = mesh.position[ring[k]];
        const double here = together(goal, worth(goal, p, q, r, b), worth(goal, q, p, r, a));
        const double sides = together(goal, best_by_trying_all(mesh, ring, i, k, goal),
                                      best_by_trying_all(mesh, ring, k, j, goal));
        best = std::min(best, together(goal, sides, here));
    }
    return best;
}

/// A shell with all of its vertices moved at random, but in the face y = 0 if it is open.
Mesh random_shell(Mesh mesh, bool closed, Random& random) {
    for (;;) {
        Mesh moved = mesh;
        for (Vertex v : mesh.position.indices())
            for (int coordinate = 0; coordinate < 3; ++coordinate)
                if (closed || coordinate != 1 || mesh.position[v].y != 0)
                    moved.position[v][coordinate] += random.uniform(-0.5, 0.5);
        if (std::isfinite(worst_of(moved))) return moved;
    }
}

TEST(EdgeRemoval, FindsTheBestTriangulationOfTheRing) {
    Random random{1};
    int done = 0, refused = 0;
    for (int round = 0; round < 600; ++round) {
        SCOPED_TRACE("seed 1, round " + std::to_string(round));
        const bool closed = round % 3 != 0;
        const int n = 3 + static_cast<int>(random.below(4));  // ring vertices, 3 ... 6
        Mesh mesh = random_shell(closed ? shell_of_edge(n) : open_shell_of_edge(n - 1), closed, random);
        const auto around = *shell(mesh, axis);
        ASSERT_EQ(around.ring.size(), std::size_t(n));
        const double before = worst_aspect_ratio(mesh, around.tets);
        const double best = best_by_trying_all(mesh, around.ring, 0, around.ring.size() - 1);
        const auto cavity = edge_removal(mesh, around, axis);
        if (!cavity) {
            EXPECT_GT(best, 0.99 * before);
            ++refused;
            continue;
        }
        EXPECT_EQ(cavity->worst_after, best);
        expect_good_swap(mesh, cavity);
        ++done;
    }
    EXPECT_GE(done, 280);
    EXPECT_GE(refused, 250);
}

/// As expect_good_swap, for a swap by energy: it falls by a twentieth at least; no cell is above the limit.
void expect_good_energy_swap(Mesh& mesh, const Cavity& cavity, double limit) {
    const Properties shape = properties(mesh);
    const double before = energy(mesh, cavity.removed);
    const auto added = replace_cells(mesh, cavity).cells;
    const double after = energy(mesh, added);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), shape));
    EXPECT_LE(after, 0.95 * before);
    EXPECT_LE(worst_aspect_ratio(mesh, added), limit * (1 + 1e-12));
    EXPECT_NEAR(cavity.worst_before, before, 1e-9 * before);
    EXPECT_NEAR(cavity.worst_after, after, 1e-9 * after);
}

TEST(EdgeRemovalByEnergy, FindsTheBestTriangulationOfTheRing) {
    Random random{2};
    int done = 0, refused = 0, worst_rose = 0;
    for (int round = 0; round < 600; ++round) {
        SCOPED_TRACE("seed 2, round " + std::to_string(round));
        const bool closed = round % 3 != 0;
        const int n = 3 + static_cast<int>(random.below(4));  // ring vertices, 3 ... 6
        Mesh mesh = random_shell(closed ? shell_of_edge(n) : open_shell_of_edge(n - 1), closed, random);
        const SwapGoal goal{true, random.uniform(5, 40)};
        const auto around = *shell(mesh, axis);
        const double before = energy(mesh, around.tets);
        const double worst_before = worst_aspect_ratio(mesh, around.tets);
        const double best = best_by_trying_all(mesh, around.ring, 0, around.ring.size() - 1, goal);
        const auto cavity = edge_removal(mesh, around, axis, goal);
        if (!cavity) {
            EXPECT_GE(best, 0.95 * before * (1 - 1e-12));
            ++refused;
            continue;
        }
        EXPECT_NEAR(cavity->worst_after, best, 1e-12 * best);
        expect_good_energy_swap(mesh, *cavity, goal.limit);
        worst_rose += worst_of(mesh) > worst_before;
        ++done;
    }
    EXPECT_GE(done, 250);
    EXPECT_GE(refused, 280);
    EXPECT_GE(worst_rose, 14);  // it is another goal than the worst
}

TEST(FaceRemovalByEnergy, LowersTheEnergyWithinTheLimit) {
    for (double height : {0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5}) {
        SCOPED_TRACE("height " + std::to_string(height));
        Mesh mesh = two_tets_of_height(height), swapped = mesh;
        Cavity by_hand{{Tet(0), Tet(1)}, {}, {}};
        for (const auto& [i, j] : {std::pair(0, 1), std::pair(1, 2), std::pair(2, 0)})
            by_hand.added.push_back({{Vertex(4), Vertex(i), Vertex(j), Vertex(3)}, surroundings});
        replace_cells(swapped, by_hand);
        ASSERT_EQ(verify(swapped), "");
        const double worst = worst_of(swapped);
        const bool pays = energy(swapped, all_tets(swapped)) < 0.95 * energy(mesh, all_tets(mesh));
        EXPECT_FALSE(face_removal(mesh, {Tet(0), 3}, {true, 0.999 * worst})) << "above the limit";
        const auto cavity = face_removal(mesh, {Tet(0), 3}, {true, 1.001 * worst});
        ASSERT_EQ(cavity.has_value(), pays);
        EXPECT_EQ(pays, height < 0.6);
        if (cavity) expect_good_energy_swap(mesh, *cavity, 1.001 * worst);
    }
}

}  // namespace
}  // namespace kropla
