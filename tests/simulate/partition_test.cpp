#include "meshes.h"
#include "simulate/partition.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

TEST(Partition, NumbersEachVertexOnceAndSharesThemEqually) {
    const Mesh mesh = unit_cube(8);  // 729 vertices
    const Numbering numbering = number_vertices(mesh, living_cells(mesh), 4);
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
    const Cells cells = living_cells(mesh);
    const Numbering numbering = number_vertices(mesh, cells, 2);
    std::size_t listed = 0;
    for (int rank = 0; rank < 2; ++rank) listed += cells_of_rank(mesh, cells, numbering, rank).tets.size();
    EXPECT_GE(listed, cells.tets.size());
    EXPECT_LT(listed,
              cells.tets.size() + 3 * 6 * 64);  // astride the cut: no more than three layers of 8 x 8 cubes
}

TEST(Partition, OfOneRegionLeavesOutTheOthers) {
    const Mesh mesh = unit_cube_with_body(8);
    const Cells body = living_cells(mesh, Region(1));
    EXPECT_EQ(body.tets.size(), 6u * 4 * 4 * 4);
    const Numbering numbering = number_vertices(mesh, body, 1);
    EXPECT_EQ(numbering.rows(), 5 * 5 * 5);
    EXPECT_EQ(std::ranges::count(numbering.row, -1), 729 - 125);
}

TEST(Partition, ColumnsOfALayerAreNumberedToo) {
    const Mesh mesh = with_layer(unit_cube_with_body(4), {0.5, 0.5, 0.5}, surroundings, 3, 0.3);
    const Cells cells = living_cells(mesh);
    const Numbering numbering = number_vertices(mesh, cells, 2);
    EXPECT_EQ(numbering.rows(), 125 + 3 * 26);  // 26 of the grid's vertices are on the body
    EXPECT_EQ(numbering.rows(), count_vertices(mesh));
    std::size_t listed = 0;
    for (int rank = 0; rank < 2; ++rank) listed += cells_of_rank(mesh, cells, numbering, rank).prisms.size();
    EXPECT_EQ(cells.prisms.size(), 3u * 48);
    EXPECT_GT(listed, cells.prisms.size());
    EXPECT_LT(listed, 2 * cells.prisms.size());
    EXPECT_EQ(living_cells(mesh, Region(1)).prisms.size(), 0u);
}

}  // namespace
}  // namespace kropla
