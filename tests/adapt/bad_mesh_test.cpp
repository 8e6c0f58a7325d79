// Meshes that no run makes, but that a user of the library may hand in: with cells turned over, flat, or at places that
// are not finite. No operator proposes such a cell, and every loop ends.

#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "base/random.h"
#include "base/tetrahedron.h"
#include "mesh/meshes.h"
#include "mesh/proposals.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

const Snapshot unit_cube{{{0, 0, 0}, {1, 1, 1}}, {0.2, 0, 0.2}, {}};

/// A cube of which every n-th vertex has gone astray, some onto a neighbour, so that cells are turned over and flat.
Mesh tangled(std::uint64_t seed, int n) {
    Mesh mesh = cube_in_cube(6);
    Random random{seed};
    for (Vertex v : all_vertices(mesh)) {
        if (random.below(static_cast<std::uint64_t>(n)) != 0) continue;
        if (!constraint(mesh, v, ball(mesh, v)).free()) continue;
        const auto beside = adjacent_vertices(mesh, v);
        if (random.below(3) == 0) mesh.position[v] = mesh.position[beside[random.below(beside.size())]];
        else mesh.position[v] += 0.3 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    }
    return mesh;
}

int count_turned(const Mesh& mesh) {
    const auto is_turned = [&](Tet t) { return aspect_ratio(mesh, t) == infinity; };
    return static_cast<int>(std::ranges::count_if(all_tets(mesh), is_turned));
}

/// Cells of the proposal are all the right way round. Counts it.
void expect_valid(const Mesh& mesh, const std::optional<Cavity>& cavity, int& made) {
    if (!cavity) return;
    ++made;
    EXPECT_TRUE(std::isfinite(cavity->worst_after));
    const auto place = [&](Vertex v) { return place_in(mesh, *cavity, v); };
    for (const NewTet& t : cavity->added) {
        const auto& v = t.vertices;
        EXPECT_TRUE(std::isfinite(tet_aspect_ratio(place(v[0]), place(v[1]), place(v[2]), place(v[3]))));
    }
}

TEST(BadMesh, NoOperatorProposesACellThatIsTurnedOver) {
    int facets = 0, edges = 0, collapses = 0, splits = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = tangled(seed, 2);
        ASSERT_GT(count_turned(mesh), 66);
        for (Tet t : all_tets(mesh))
            for (const SwapGoal goal : {SwapGoal{}, SwapGoal{true}, SwapGoal{false, 1e9}, SwapGoal{true, 1e9}}) {
                for (int i = 0; i < 4; ++i) expect_valid(mesh, face_removal(mesh, {t, i}, goal), facets);
                for (const auto& [i, j] : tet_edges) {
                    const Edge e{mesh.tets[t][std::size_t(i)], mesh.tets[t][std::size_t(j)]};
                    const Shell around = shell(mesh, e, t);
                    expect_valid(mesh, edge_removal(mesh, around, e, goal), edges);
                    if (goal.by_energy || goal.limit < infinity) continue;
                    expect_valid(mesh, edge_split(mesh, around, e, infinity), splits);
                    expect_valid(mesh, edge_collapse(mesh, e.a, e.b, infinity), collapses);
                }
            }
    }
    EXPECT_GE(facets, 620);
    EXPECT_GE(edges, 7300);
    EXPECT_GE(collapses, 2700);
    EXPECT_GE(splits, 14000);
}

TEST(BadMesh, ByEnergyAnInvertedCellIsNoGain) {
    // Seen from behind, the two tets have no energy below infinity; nor have the three that would replace them.
    Mesh mesh = two_tets();
    std::swap(mesh.position[Vertex(3)], mesh.position[Vertex(4)]);
    EXPECT_FALSE(face_removal(mesh, {Tet(0), 3}, {.by_energy = true}));
    EXPECT_FALSE(face_removal(mesh, {Tet(0), 3}));
}

TEST(BadMesh, ImprovementEndsAndMendsWhatItCan) {
    int before = 0, after = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = tangled(seed, seed % 2 == 0 ? 2 : 8);
        const int turned = count_turned(mesh);
        ASSERT_GT(turned, 0);
        const AdaptOptions options;
        adapt_to_size(mesh, all_tets(mesh), unit_cube, options);
        const Changes changes = improve(mesh, all_tets(mesh), unit_cube, options);
        EXPECT_GT(changes.treated, 0);
        repair(mesh, all_tets(mesh), unit_cube, options);
        EXPECT_LE(count_turned(mesh), turned);
        before += turned;
        after += count_turned(mesh);
        if (count_turned(mesh) == 0) {
            EXPECT_EQ(verify(mesh), "");
        }
    }
    EXPECT_LT(after, before / 2);
}

TEST(BadMesh, PlacesThatAreNotFiniteAreLeft) {
    for (const double stray : {not_a_number, infinity, -infinity, 1e300}) {
        SCOPED_TRACE(stray);
        Mesh mesh = cube_in_cube(4);
        Vertex lost;
        for (Vertex v : all_vertices(mesh))
            if (on_interface(mesh, v)) lost = v;  // nothing may move it
        mesh.position[lost].y = stray;
        EXPECT_EQ(worst_of(mesh), infinity);
        Changes changes = adapt_to_size(mesh, all_tets(mesh), unit_cube);
        changes += improve(mesh, all_tets(mesh), unit_cube);
        changes += repair(mesh, all_tets(mesh), unit_cube);
        optimise_places(mesh, all_tets(mesh));
        EXPECT_TRUE(alive(mesh, lost));
        for (Vertex v : all_vertices(mesh)) EXPECT_TRUE(v == lost || is_finite(mesh.position[v])) << v.value;
    }
}

TEST(Budget, ImprovementSaysWhenItIsSpent) {
    // Nothing is good enough: there is always something to ask for.
    Mesh mesh = cube_in_cube(5);
    jiggle(mesh, 0.02, 1);
    const AdaptOptions options{.good_enough = 2.9, .treatments = 0.5, .clusters = false};
    const int cells = count_tets(mesh);
    const Changes changes = improve(mesh, all_tets(mesh), unit_cube, options);
    EXPECT_GT(changes.given_up, 670);
    EXPECT_GT(changes.treated, 430);
    EXPECT_LE(changes.treated, 100 + 0.5 * cells + cells / 4);  // and one round of cells apart
    EXPECT_EQ(verify(mesh), "");
}

TEST(Budget, TheLadderSaysWhenItIsSpent) {
    Mesh mesh = improved_mesh(sphere_in_box(), 1);
    const AdaptOptions unreachable{.floor = 2.9, .cut_out = 1, .whole_region = false};
    const int cells = count_tets(mesh);
    const Changes changes = repair(mesh, all_tets(mesh), snapshot(sphere_in_box(), 0), unreachable);
    EXPECT_GT(changes.given_up, cells / 2);
    EXPECT_LE(changes.cut_out, 20000 + 4 * cells);
    EXPECT_EQ(verify(mesh), "");
}

TEST(Budget, WhatCanBeMendedDoesNotSpendIt) {
    Mesh mesh = improved_mesh(sphere_in_box(), 2);
    ASSERT_FALSE(spoil(mesh, surroundings, 10, 2).empty());
    const Snapshot at_time = snapshot(sphere_in_box(), 0);
    Changes changes = improve(mesh, all_tets(mesh), at_time);
    changes += repair(mesh, all_tets(mesh), at_time);
    EXPECT_EQ(changes.given_up, 0);
    EXPECT_LE(worst_of(mesh), AdaptOptions{}.floor);
}

}  // namespace
}  // namespace kropla
