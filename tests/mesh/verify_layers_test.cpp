#include "mesh/meshes.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <limits>

namespace kropla {
namespace {

// One test per rule of prism layers, each on a valid mesh in which exactly that rule is broken.

TEST(VerifyLayers, AGoodOneIsGood) {
    for (int count : {1, 2, 5}) EXPECT_EQ(verify(layered_cube(count)), "");
}

TEST(VerifyLayers, ColumnsHavePrisms) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].count = 0;
    EXPECT_EQ(verify(mesh), "layer 0 has no prisms in a column");
}

TEST(VerifyLayers, RegionAndBodyAreNamed) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].body = Region{};
    EXPECT_EQ(verify(mesh), "layer 0 is of no region or body");
}

TEST(VerifyLayers, ColumnsAreWhole) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].columns.pop_back();
    EXPECT_EQ(verify(mesh), "layer 0 has 23 column vertices, no multiple of 3");
}

TEST(VerifyLayers, ColumnVerticesExist) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].columns[4] = Vertex(1000);
    EXPECT_EQ(verify(mesh), "layer 0 has a vertex in a column that does not exist");
    mesh.layers[0].columns[4] = Vertex{};
    EXPECT_EQ(verify(mesh), "layer 0 has a vertex in a column that does not exist");
}

TEST(VerifyLayers, ColumnVerticesAreThereOnce) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].columns[4] = mesh.layers[0].columns[1];
    EXPECT_EQ(verify(mesh), "layer 0 has vertex " + std::to_string(mesh.layers[0].columns[1].value) +
                                " twice in its columns");
}

TEST(VerifyLayers, PlacesAreFinite) {
    Mesh mesh = layered_cube(2);
    mesh.position[mesh.layers[0].columns[1]].z = std::numeric_limits<double>::infinity();
    EXPECT_EQ(verify(mesh),
              "vertex " + std::to_string(mesh.layers[0].columns[1].value) + " has no finite place");
}

TEST(VerifyLayers, TrianglesStandOnColumns) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].triangles[3][1] = 8;
    EXPECT_EQ(verify(mesh), "layer 0 has a triangle on a column that does not exist");
}

TEST(VerifyLayers, EachColumnIsUsed) {
    Mesh mesh = layered_cube(2);
    std::erase_if(mesh.layers[0].triangles,
                  [](const auto& t) { return t[0] == 5 || t[1] == 5 || t[2] == 5; });
    EXPECT_EQ(verify(mesh), "layer 0 has column 5 in no triangle");
}

TEST(VerifyLayers, WallsAreClosed) {
    Mesh mesh = layered_cube(2);
    const auto last = mesh.layers[0].triangles.back();
    mesh.layers[0].triangles.pop_back();
    EXPECT_NE(verify(mesh).find("the wall of layer 0 is not closed at the edge of columns"),
              std::string::npos)
        << verify(mesh);
    mesh.layers[0].triangles.push_back(
        {last[0], last[2], last[1]});  // turned over: its edges run the same way twice
    EXPECT_NE(verify(mesh).find("the wall of layer 0 is not closed"), std::string::npos) << verify(mesh);
}

TEST(VerifyLayers, LayerAtIsRight) {
    Mesh mesh = layered_cube(2);
    const std::string name = "vertex " + std::to_string(mesh.layers[0].columns[0].value);
    mesh.layer_at[mesh.layers[0].columns[0]] = Layer{};
    EXPECT_EQ(verify(mesh), name + " has layer -1 recorded, but is of 0");
    mesh = layered_cube(2);
    mesh.layer_at[Vertex(0)] = Layer(0);
    EXPECT_EQ(verify(mesh), "vertex 0 has layer 0 recorded, but is of -1");
}

TEST(VerifyLayers, VerticesWithinALayerAreNoFreeSlots) {
    Mesh mesh = layered_cube(2);
    const Vertex middle = mesh.layers[0].columns[1];
    mesh.free_vertices.push_back(middle);
    EXPECT_EQ(verify(mesh),
              "vertex slot " + std::to_string(middle.value) + " is listed as free 1 times, but is taken");
}

TEST(VerifyLayers, PrismsAreNotTurnedOver) {
    Mesh mesh = layered_cube(2);
    std::swap(mesh.position[mesh.layers[0].columns[1]], mesh.position[mesh.layers[0].columns[0]]);
    EXPECT_NE(verify(mesh), "");  // the body's tets are, too
    mesh = layered_cube(2);
    mesh.position[mesh.layers[0].columns[1]] = {0.5, 0.5, 0.5};
    EXPECT_NE(verify(mesh).find("is flat or turned over at a corner"), std::string::npos) << verify(mesh);
    mesh = layered_cube(2);
    mesh.position[mesh.layers[0].columns[1]] = mesh.position[mesh.layers[0].columns[0]];
    EXPECT_NE(verify(mesh).find("is flat or turned over at a corner"), std::string::npos) << verify(mesh);
}

/// The first facet of the tets' boundary on the patch.
Facet facet_on(const Mesh& mesh, Patch patch) {
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i)
            if (mesh.patch[t][static_cast<std::size_t>(i)] == patch) return {t, i};
    return {};
}

TEST(VerifyLayers, TheTetsEndAtTheShellAndAtTheWall) {
    Mesh mesh = layered_cube(2);
    const Facet shell = facet_on(mesh, shell_patch(Layer(0)));
    mesh.patch[shell.tet][static_cast<std::size_t>(shell.corner)] = Patch(0);
    EXPECT_EQ(verify(mesh), "the shell of layer 0 is not the tets' boundary of patch 7");
    mesh = layered_cube(2);
    const Facet face = facet_on(mesh, Patch(3));
    mesh.patch[face.tet][static_cast<std::size_t>(face.corner)] = wall_patch(Layer(0));
    EXPECT_EQ(verify(mesh), "the wall of layer 0 is not the tets' boundary of patch 6");
}

TEST(VerifyLayers, TetsAtShellAndWallAreOfTheRightRegions) {
    Mesh mesh = layered_cube(2);
    mesh.layers[0].region = Region(1);
    EXPECT_EQ(verify(mesh),
              "the tets at the shell of layer 0 are not of its region, or those at its wall are");
}

TEST(VerifyLayers, TwoLayersOfABodyStandOnOneWall) {
    Mesh mesh = layered_cube(1);
    PrismLayer other = mesh.layers[0];  // its vertices are copies
    other.region = Region(1);
    other.columns.clear();
    for (Vertex v : mesh.layers[0].columns)
        other.columns.push_back(mesh.position.push_back(mesh.position[v]));
    mesh.tet_at.resize(mesh.position.size());
    mesh.layer_at.resize(mesh.position.size());
    add_layer(mesh, other);
    EXPECT_EQ(verify(mesh), "layer 1 and layer 0 stand on one body, but not on one wall");
}

TEST(VerifyLayers, ThereArePatchesForThirteen) {
    Mesh mesh = layered_cube(1);
    mesh.layers.resize(14, mesh.layers[0]);
    EXPECT_EQ(verify(mesh), "there are more than 13 layers");
}

}  // namespace
}  // namespace kropla
