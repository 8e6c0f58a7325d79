#include <kropla/mesh/verify.h>

#include "mesh/meshes.h"
#include "mesh/proposals.h"

#include <gtest/gtest.h>

#include <limits>

namespace kropla {
namespace {

// One test per rule, each on a valid mesh in which exactly that rule is broken.

TEST(Verify, SizesAgree) {
    Mesh mesh = two_tets();
    mesh.tet_at.push_back(Tet(0));
    EXPECT_EQ(verify(mesh), "tet_at and position differ in size");
    mesh = two_tets();
    mesh.layer_at.push_back(Layer{});
    EXPECT_EQ(verify(mesh), "layer_at and position differ in size");
    mesh = two_tets();
    mesh.region.push_back(surroundings);
    EXPECT_EQ(verify(mesh), "the arrays of cells differ in size");
}

TEST(Verify, VerticesExist) {
    Mesh mesh = two_tets();
    mesh.tets[Tet(1)][3] = Vertex(5);
    EXPECT_EQ(verify(mesh), "cell 1 has vertex 5, which does not exist");
    mesh.tets[Tet(1)][3] = Vertex{};
    EXPECT_EQ(verify(mesh), "cell 1 has vertex -1, which does not exist");
}

TEST(Verify, CellsHaveFourVertices) {
    Mesh mesh = one_tet();
    mesh.tets[Tet(0)][3] = Vertex(1);
    EXPECT_EQ(verify(mesh), "cell 0 at (0.5, 0.25, 0) has vertex 1 twice");
}

TEST(Verify, PlacesAreFinite) {
    Mesh mesh = one_tet();
    mesh.position[Vertex(2)].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(verify(mesh), "vertex 2 has no finite place");
}

TEST(Verify, CellsHaveARegion) {
    Mesh mesh = one_tet();
    mesh.region[Tet(0)] = Region{};
    EXPECT_EQ(verify(mesh), "cell 0 at (0.25, 0.25, 0.25) is of no region");
}

TEST(Verify, CellsArePositivelyOriented) {
    Mesh mesh = one_tet();
    mesh.position[Vertex(3)].z = 0;
    EXPECT_EQ(verify(mesh), "cell 0 at (0.25, 0.25, 0) is flat");
    mesh.position[Vertex(3)].z = -1e-40;
    EXPECT_EQ(verify(mesh), "cell 0 at (0.25, 0.25, -2.5e-41) is turned inside out");
    mesh.position[Vertex(3)].z = 1e-40;
    EXPECT_EQ(verify(mesh), "");
}

TEST(Verify, EachFacetOfTheBoundaryHasAPatch) {
    Mesh mesh = one_tet();
    mesh.patch[Tet(0)][2] = Patch{};
    EXPECT_EQ(verify(mesh),
              "cell 0 at (0.25, 0.25, 0.25): its facet opposite corner 2 has neither neighbour nor patch");
}

TEST(Verify, NoOtherFacetHasAPatch) {
    Mesh mesh = two_tets();
    mesh.patch[Tet(1)][3] = Patch(0);
    EXPECT_EQ(verify(mesh),
              "cell 1 at (0, 0, -0.25): its facet opposite corner 3 has both a neighbour and a patch");
}

TEST(Verify, PatchesGoUpToThirtyOne) {
    Mesh mesh = one_tet();
    mesh.patch[Tet(0)][0] = Patch(31);
    EXPECT_EQ(verify(mesh), "");
    mesh.patch[Tet(0)][0] = Patch(32);
    EXPECT_EQ(verify(mesh),
              "cell 0 at (0.25, 0.25, 0.25): its facet opposite corner 0 is of patch 32, above 31");
}

TEST(Verify, NeighboursExist) {
    Mesh mesh = two_tets();
    mesh.neighbour[Tet(0)][3] = Tet(2);
    EXPECT_EQ(verify(mesh), "cell 0 at (0, 0, 0.25): across its facet opposite corner 3 is no cell");
    replace_cells(mesh = shell_of_edge(3), edge_removal(shell_of_edge(3), {Vertex(0), Vertex(1)}));
    mesh.neighbour[Tet(0)][3] = mesh.free_tets.front();
    EXPECT_NE(verify(mesh).find("is no cell"), std::string::npos) << verify(mesh);
}

TEST(Verify, NeighboursAreMutual) {
    Mesh mesh = shell_of_edge(4);  // tet 0 leads to tet 1 and tet 3, across corners 2 and 3
    mesh.neighbour[Tet(0)][2] = Tet(2);
    EXPECT_EQ(verify(mesh), "cell 0 at (0.25, 0.25, 0): its neighbour cell 2 across its facet opposite "
                            "corner 2 does not share that facet");
}

TEST(Verify, NeighboursShareTheirFacet) {
    Mesh mesh = shell_of_edge(3);
    std::swap(mesh.neighbour[Tet(0)][2], mesh.neighbour[Tet(0)][3]);  // mutual still
    EXPECT_NE(verify(mesh).find("does not share that facet"), std::string::npos) << verify(mesh);
}

TEST(Verify, CellsThatShareAFacetAreNeighbours) {
    Mesh mesh = two_tets();
    for (Tet t : {Tet(0), Tet(1)}) {
        mesh.neighbour[t][3] = Tet{};
        mesh.patch[t][3] = Patch(0);
    }
    EXPECT_EQ(verify(mesh), "cell 1 at (0, 0, -0.25) and cell 0 share a facet but are not neighbours");
}

TEST(Verify, AFacetHasNoThirdCell) {
    Mesh mesh = two_tets();  // one more tet on the triangle 0, 1, 2, with an apex of its own beyond the tet 1
    const Vertex apex = mesh.position.push_back({0, 0, -3});
    const Tet third = mesh.tets.push_back({Vertex(0), Vertex(2), Vertex(1), apex});
    mesh.neighbour.push_back({});
    mesh.patch.push_back({Patch(0), Patch(0), Patch(0), Patch(0)});
    mesh.region.push_back(surroundings);
    mesh.tet_at.push_back(third);
    mesh.layer_at.push_back(Layer{});
    EXPECT_NE(verify(mesh).find("share a facet but are not neighbours"), std::string::npos) << verify(mesh);
}

TEST(Verify, TetAtHasTheVertex) {
    Mesh mesh = two_tets();
    mesh.tet_at[Vertex(4)] = Tet(0);
    EXPECT_EQ(verify(mesh), "vertex 4: the cell recorded for it does not have it");
    mesh.tet_at[Vertex(4)] = Tet(2);
    EXPECT_EQ(verify(mesh), "vertex 4: the cell recorded for it does not have it");
    mesh.tet_at[Vertex(4)] = Tet{};
    EXPECT_EQ(verify(mesh), "vertex 4 at (0, 0, -1) has cells but none is recorded");
}

TEST(Verify, BallsAreInOnePiece) {
    // two tets that touch in the origin only
    const Mesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0},
                                 {0, 0, -1}},
                                {{Vertex(0), Vertex(1), Vertex(2), Vertex(3)},
                                 {Vertex(0), Vertex(5), Vertex(4), Vertex(6)}},
                                {surroundings, surroundings});
    EXPECT_EQ(verify(mesh), "vertex 0 at (0, 0, 0): its cells are not in one piece");
}

TEST(Verify, FreeSlotsAreListedOnce) {
    Mesh mesh = shell_of_edge(3);
    replace_cells(mesh, edge_removal(mesh, {Vertex(0), Vertex(1)}));
    ASSERT_EQ(verify(mesh), "");
    const Tet slot = mesh.free_tets.front();
    const std::string name = "tet slot " + std::to_string(slot.value) + " is listed as free ";
    mesh.free_tets = {slot, slot};
    EXPECT_EQ(verify(mesh), name + "2 times, but is free");
    mesh.free_tets = {};
    EXPECT_EQ(verify(mesh), name + "0 times, but is free");
    mesh.free_tets = {slot, Tet(0)};
    EXPECT_EQ(verify(mesh), "tet slot 0 is listed as free 1 times, but is taken");
    mesh.free_tets = {slot, Tet(3)};
    EXPECT_EQ(verify(mesh), "a free tet slot is listed that does not exist");

    mesh = two_tets();
    mesh.free_vertices = {Vertex(2)};
    EXPECT_EQ(verify(mesh), "vertex slot 2 is listed as free 1 times, but is taken");
}

/// The cells of the grid of which `keep` says yes.
template <class Keep>
Mesh part_of(const Mesh& grid, Keep keep) {
    Array<Tet, std::array<Vertex, 4>> tets;
    for (Tet t : grid.tets.indices())
        if (keep(t)) tets.push_back(grid.tets[t]);
    const Array<Tet, Region> region(tets.size(), surroundings);
    return make_mesh(grid.position, tets, region);
}

/// Cube (i, j, k) of cube_of_tets(n) is number c = i + n (j + n k); its tets are 6c ... 6c + 5.
int cube_of(Tet t) { return t.value / 6; }

TEST(Verify, TheBoundaryDoesNotTouchItself) {
    // Two cubes of the middle layer are left out that have an upright edge in common, 26-42. The other two
    // cubes there meet in it, and are joined above and below; one is of region 1, so that no region touches
    // itself.
    const Mesh grid = cube_of_tets(3);
    Mesh mesh = part_of(grid, [](Tet t) { return cube_of(t) != 13 && cube_of(t) != 17; });
    for (Tet t : mesh.tets.indices())
        if (t.value >= 6 * 15 && t.value < 6 * 16) mesh.region[t] = Region(1);  // cube 16, 13 left out before
    EXPECT_EQ(verify(mesh), "the boundary touches itself at edge 26-42 near (0.666667, 0.666667, 0.5)");
}

TEST(Verify, ARegionDoesNotTouchItself) {
    Mesh mesh = cube_of_tets(2);
    for (Tet t : mesh.tets.indices())
        if (cube_of(t) == 0 || cube_of(t) == 3) mesh.region[t] = Region(1);  // they meet in an upright edge
    EXPECT_EQ(verify(mesh), "the surface of region 0 touches itself at edge 4-13 near (0.5, 0.5, 0.25)");
}

}  // namespace
}  // namespace kropla
