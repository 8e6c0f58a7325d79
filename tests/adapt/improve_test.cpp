#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

const Snapshot unit_cube{{{0, 0, 0}, {1, 1, 1}}, {0.2, 0, 0.2}, {}};

TEST(Improve, NeverRaisesTheWorstAndUsesAllOperators) {
    Changes all;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = cube_in_cube(6);
        jiggle(mesh, 0.016, seed);
        spoil(mesh, Region(1), 20, seed);
        const Mesh before = mesh;
        const double worst = worst_of(mesh);
        ASSERT_GT(worst, 10);
        const Changes changes = improve(mesh, all_tets(mesh), unit_cube, {.clusters = false});
        EXPECT_LT(worst_of(mesh), worst);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same_shape(properties(mesh), properties(before)));
        int held = 0;
        for (Vertex v : all_vertices(before)) {
            if (!on_interface(before, v)) continue;
            EXPECT_EQ(mesh.position[v], before.position[v]);
            ++held;
        }
        EXPECT_EQ(held, 5 * 5 * 5 - 3 * 3 * 3);  // the surface of the inner cube
        EXPECT_EQ(count_vertices(mesh) - count_vertices(before), changes.splits - changes.collapses);
        all += changes;
    }
    EXPECT_GE(all.swaps, 300);
    EXPECT_GE(all.moved, 520);
    EXPECT_GE(all.cells_replaced, all.swaps);
}

TEST(Improve, NeverRaisesTheWorstOfAnyPart) {
    // Worked on cell by cell: after each, no cell of the mesh may be worse than the worst before.
    Mesh mesh = cube_in_cube(5);
    jiggle(mesh, 0.02, 3);
    spoil(mesh, Region(1), 5, 3);
    const double at_start = worst_of(mesh);
    double worst = at_start;
    int asked = 0, helped = 0;
    for (Tet t : all_tets(mesh)) {
        if (!alive(mesh, t)) continue;
        const Changes changes = improve(mesh, {&t, 1}, unit_cube);
        const double now = worst_of(mesh);
        ASSERT_LE(now, worst * (1 + 1e-12));
        worst = now;
        ++asked;
        helped += !changes.vertices.empty() || changes.cells_replaced > 0;
    }
    EXPECT_GE(asked, 500);
    EXPECT_GE(helped, 5);
    EXPECT_LT(worst, at_start);
}

int count_bad(const Mesh& mesh) {
    const auto is_bad = [&](Tet t) { return aspect_ratio(mesh, t) > AdaptOptions{}.good_enough; };
    return static_cast<int>(std::ranges::count_if(all_tets(mesh), is_bad));
}

TEST(Improve, RetriangulatesClustersWhereNothingElseHelps) {
    int left = 0, left_with_clusters = 0, clusters = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = improved_mesh(sphere_in_box(), seed);
        spoil(mesh, surroundings, 60, seed);
        const Mesh before = mesh;
        Mesh other = mesh;
        const Snapshot at_time = snapshot(sphere_in_box(), 0);
        EXPECT_EQ(improve(other, all_tets(other), at_time, {.clusters = false}).local_remeshes, 0);
        const Changes changes = improve(mesh, all_tets(mesh), at_time);
        clusters += changes.local_remeshes;
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same_shape(properties(mesh), properties(before)));
        EXPECT_LE(worst_of(mesh), worst_of(other) * (1 + 1e-12));
        left += count_bad(other);
        left_with_clusters += count_bad(mesh);
    }
    EXPECT_GE(clusters, 14);
    EXPECT_LT(left_with_clusters, left);
}

TEST(Improve, LeavesGoodCellsAndNamesTheChangedVertices) {
    Mesh mesh = cube_in_cube(6);
    jiggle(mesh, 0.016, 1);
    spoil(mesh, Region(1), 5, 1);
    const Mesh before = mesh;
    EXPECT_EQ(improve(mesh, {}, unit_cube).cells_replaced, 0);
    EXPECT_EQ(mesh, before);

    const Changes changes = improve(mesh, all_tets(mesh), unit_cube);
    int changed = 0;
    for (Vertex v : all_vertices(mesh)) {
        const bool known = v.value < static_cast<int>(before.position.size()) && alive(before, v);
        if (known && mesh.position[v] == before.position[v]) continue;
        EXPECT_TRUE(std::ranges::find(changes.vertices, v) != changes.vertices.end()) << v.value;
        ++changed;
    }
    EXPECT_GE(changed, 16);
}

TEST(OptimisePlaces, MovesVerticesOnly) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = cube_in_cube(6);
        jiggle(mesh, 0.016, seed);
        spoil(mesh, Region(1), 10, seed);
        const Mesh before = mesh;
        const Changes changes = optimise_places(mesh, all_tets(mesh));
        EXPECT_EQ(mesh.tets, before.tets);
        EXPECT_EQ(mesh.neighbour, before.neighbour);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same(properties(mesh), properties(before)));
        EXPECT_LT(worst_of(mesh), worst_of(before));
        EXPECT_GE(changes.moved, 190);
        EXPECT_GE(changes.smoothing_sweeps, 1);
        EXPECT_EQ(changes.cells_replaced, 0);
        int moved = 0;
        for (Vertex v : all_vertices(mesh)) {
            if (mesh.position[v] == before.position[v]) continue;
            EXPECT_FALSE(on_interface(mesh, v));
            EXPECT_TRUE(std::ranges::find(changes.vertices, v) != changes.vertices.end()) << v.value;
            ++moved;
        }
        EXPECT_GE(moved, 190);
    }
}

TEST(Changes, AddUp) {
    Changes a, b;
    a.swaps = 1, a.largest_ring = 3, a.vertices = {Vertex(1)}, a.cells_replaced = 2;
    b.swaps = 2, b.largest_ring = 2, b.vertices = {Vertex(2)}, b.cells = {Tet(5)}, b.global_remeshes = 1;
    a += b;
    EXPECT_EQ(a.swaps, 3);
    EXPECT_EQ(a.largest_ring, 3);
    EXPECT_EQ(a.cells_replaced, 2);
    EXPECT_EQ(a.global_remeshes, 1);
    EXPECT_EQ(a.vertices, (std::vector<Vertex>{Vertex(1), Vertex(2)}));
    EXPECT_EQ(a.cells, (std::vector<Tet>{Tet(5)}));
}

}  // namespace
}  // namespace kropla
