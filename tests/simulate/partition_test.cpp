#include "meshes.h"
#include "mesh/topology.h"
#include "simulate/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

TEST(Partition, NumbersEachVertexOnceAndSharesThemEqually) {
    const Mesh mesh = unit_cube(8);  // 729 vertices
    const Numbering numbering = number_vertices(mesh, all_tets(mesh), 4);
    ASSERT_EQ(numbering.rows(), count_vertices(mesh));
    for (int r = 0; r < numbering.rows(); ++r) {
        EXPECT_EQ(numbering.row[numbering.vertex[static_cast<std::size_t>(r)]], r);
    }
    for (std::size_t rank = 0; rank < 4; ++rank) {
        EXPECT_NEAR(numbering.first_row[rank + 1] - numbering.first_row[rank], 729 / 4.0, 1);
    }
}

TEST(Partition, PiecesAreCompact) {
    const Mesh mesh = unit_cube(8);
    const std::vector<Tet> cells = all_tets(mesh);
    const Numbering numbering = number_vertices(mesh, cells, 2);
    std::size_t listed = 0;
    for (int rank = 0; rank < 2; ++rank) listed += cells_of_rank(mesh, cells, numbering, rank).size();
    EXPECT_GE(listed, cells.size());
    EXPECT_LT(listed,
              cells.size() + 3 * 6 * 64);  // astride the cut: no more than three layers of 8 x 8 cubes
}

TEST(Partition, OfOneRegionLeavesOutTheOthers) {
    const Mesh mesh = unit_cube_with_body(8);
    const std::vector<Tet> body = all_tets(mesh, Region(1));
    EXPECT_EQ(body.size(), 6u * 4 * 4 * 4);
    const Numbering numbering = number_vertices(mesh, body, 1);
    EXPECT_EQ(numbering.rows(), 5 * 5 * 5);
    EXPECT_EQ(std::ranges::count(numbering.row, -1), 729 - 125);
}

}  // namespace
}  // namespace kropla
