#include "adapt/cases.h"
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include "transfer/adapted.h"
#include "transfer/changed.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

double total_volume(const Mesh& mesh, const std::vector<Tet>& tets, Region region) {
    double sum = 0;
    for (Tet t : tets)
        if (mesh.region[t] == region) sum += volume(mesh, t);
    return sum;
}

/// What a look at every slot finds.
ChangedCells by_all_slots(const Mesh& before, const Mesh& after) {
    ChangedCells all;
    for (Tet t : all_tets(before))
        if (!same_tet(before, after, t)) all.gone.push_back(t);
    for (Tet t : all_tets(after))
        if (!same_tet(before, after, t)) all.come.push_back(t);
    return all;
}

TEST(ChangedCells, AreAllThatDiffer) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const AdaptedMesh mesh = adapted_mesh(seed);
        const ChangedCells found =
            changed_cells(mesh.before, mesh.after, mesh.changes.cells, mesh.changes.vertices);
        const ChangedCells all = by_all_slots(mesh.before, mesh.after);
        EXPECT_EQ(found.gone, all.gone) << "seed " << seed;
        EXPECT_EQ(found.come, all.come) << "seed " << seed;
        for (Region region : {surroundings, Region(1)}) {
            const double gone = total_volume(mesh.before, found.gone, region);
            EXPECT_GT(gone, 0);
            EXPECT_NEAR(total_volume(mesh.after, found.come, region), gone, 1e-12 * gone);
        }
    }
}

TEST(ChangedCells, AreFoundFromOneOfThem) {
    const AdaptedMesh mesh = swapped_mesh(jittered_cube(4, 1));
    ASSERT_EQ(mesh.changes.cells.size(), 3u);
    const Tet one = mesh.changes.cells.back();
    const ChangedCells found = changed_cells(mesh.before, mesh.after, {&one, 1}, {});
    EXPECT_EQ(found.gone.size(), 2u);
    EXPECT_EQ(found.come.size(), 3u);
}

TEST(ChangedCells, AreTheBallOfAMovedVertex) {
    const Mesh before = cube_of_tets(3);
    Mesh after = before;
    const Vertex inner(1 + 4 * (1 + 4 * 1));
    after.position[inner].x += 0.01;
    const ChangedCells found = changed_cells(before, after, {}, {&inner, 1});
    auto expected = ball(before, inner);
    std::ranges::sort(expected);
    EXPECT_EQ(found.come, expected);
    EXPECT_EQ(found.gone, expected);
}

TEST(ChangedCells, AreNoneWhereNothingChangedWhateverIsNamed) {
    const Mesh mesh = cube_of_tets(2);
    auto cells = all_tets(mesh);
    cells.push_back(Tet(cells.size() + 5));  // gone again, together with its slot
    const auto vertices = all_vertices(mesh);
    const ChangedCells found = changed_cells(mesh, mesh, cells, vertices);
    EXPECT_TRUE(found.gone.empty());
    EXPECT_TRUE(found.come.empty());
}

}  // namespace
}  // namespace kropla
