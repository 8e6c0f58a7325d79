#include <kropla/mesh/mesh.h>

#include <kropla/mesh/cavity.h>
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace kropla {
namespace {

const std::array<Vertex, 4> corners_0123 = {Vertex(0), Vertex(1), Vertex(2), Vertex(3)};
const Array<Vertex, Vec3> four_places = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// What make_mesh says against its input; empty if nothing.
std::string complaint(const Array<Vertex, Vec3>& position, const Array<Tet, std::array<Vertex, 4>>& tets,
                      const std::vector<BoundaryFacet>& boundary = {}) {
    try {
        (void)make_mesh(position, tets, Array<Tet, Region>(tets.size(), surroundings), boundary);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

TEST(TinyMeshes, AreValidAndOfTheSizeTheySay) {
    EXPECT_EQ(verify(one_tet()), "");
    EXPECT_EQ(verify(regular_tet()), "");
    EXPECT_EQ(verify(two_tets()), "");
    EXPECT_EQ(verify(ball_of_vertex()), "");
    for (int n = 2; n <= 6; ++n) {
        SCOPED_TRACE(n);
        EXPECT_EQ(verify(shell_of_edge(n + 1)), "");
        EXPECT_EQ(verify(open_shell_of_edge(n)), "");
        EXPECT_EQ(count_tets(open_shell_of_edge(n)), n);
    }
    for (int n = 1; n <= 3; ++n) {
        SCOPED_TRACE(n);
        Mesh mesh = cube_of_tets(n);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_EQ(count_tets(mesh), 6 * n * n * n);
        EXPECT_EQ(count_vertices(mesh), (n + 1) * (n + 1) * (n + 1));
        EXPECT_EQ(properties(mesh).euler_characteristic, 1);
        EXPECT_NEAR(properties(mesh).volume.at(surroundings), 1, 1e-12);
        jiggle(mesh, 0.1 / n, 1);
        EXPECT_EQ(verify(mesh), "");
    }
}

TEST(TinyMeshes, CubesHaveTheSixFacesOfTheBoxAsPatches) {
    const auto area = properties(cube_of_tets(2)).area;
    ASSERT_EQ(area.size(), 6u);
    for (const auto& [patch, vector] : area)
        for (int axis = 0; axis < 3; ++axis) {
            const double expected = axis == patch.value / 2 ? (patch.value % 2 == 0 ? -1 : 1) : 0;
            EXPECT_NEAR(vector[axis], expected, 1e-12) << "patch " << patch.value;
        }
}

TEST(TinyMeshes, CubeInCubeHasTwoRegions) {
    for (int n = 3; n <= 4; ++n) {
        const Mesh mesh = cube_in_cube(n);
        const double inner = std::pow((n - 2.0) / n, 3);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_NEAR(properties(mesh).volume.at(Region(1)), inner, 1e-12);
        EXPECT_NEAR(properties(mesh).volume.at(surroundings), 1 - inner, 1e-12);
    }
}

TEST(MakeMesh, FindsNeighboursAndPatches) {
    const Mesh mesh = two_tets();
    EXPECT_EQ(mesh.neighbour[Tet(0)], (std::array<Tet, 4>{Tet{}, Tet{}, Tet{}, Tet(1)}));
    EXPECT_EQ(mesh.neighbour[Tet(1)], (std::array<Tet, 4>{Tet{}, Tet{}, Tet{}, Tet(0)}));
    EXPECT_EQ(mesh.patch[Tet(0)], (std::array<Patch, 4>{Patch(0), Patch(0), Patch(0), Patch{}}));
    EXPECT_EQ(one_tet().patch[Tet(0)], (std::array<Patch, 4>{Patch(0), Patch(1), Patch(2), Patch(3)}));
}

TEST(MakeMesh, LeavesVerticesOfNoTetAsFreeSlots) {
    auto places = four_places;
    places.push_back({7, 7, 7});
    const Mesh mesh = make_mesh(places, {corners_0123}, {surroundings});
    EXPECT_EQ(mesh.free_vertices, std::vector<Vertex>{Vertex(4)});
    EXPECT_EQ(count_vertices(mesh), 4);
    EXPECT_EQ(verify(mesh), "");
}

TEST(MakeMesh, MakesNothingOfNothing) {
    EXPECT_EQ(make_mesh({}, {}, {}), Mesh{});
    EXPECT_EQ(verify(Mesh{}), "");
}

TEST(MakeMesh, RefusesVerticesThatDoNotExist) {
    for (int v : {-1, 4}) {
        EXPECT_EQ(complaint(four_places, {{Vertex(0), Vertex(1), Vertex(2), Vertex(v)}}),
                  "cell 0 has vertex " + std::to_string(v) + ", but there are 4 vertices");
        EXPECT_EQ(complaint(four_places, {corners_0123}, {{{Vertex(0), Vertex(v), Vertex(1)}, Patch(1)}}),
                  "boundary facet 0 has vertex " + std::to_string(v) + ", but there are 4 vertices");
    }
}

TEST(MakeMesh, RefusesAThirdCellAtAFacet) {
    auto places = four_places;
    places.push_back({0, 0, -1});
    places.push_back({0, 0, -2});
    EXPECT_EQ(complaint(places, {corners_0123,
                                 {Vertex(0), Vertex(2), Vertex(1), Vertex(4)},
                                 {Vertex(0), Vertex(2), Vertex(1), Vertex(5)}}),
              "a facet of cell 2 already belongs to cells 0 and 1");
}

/// cube_in_cube(3) with free slots: two tets are split by a new vertex each, then the first is made whole
/// again.
Mesh with_free_slots() {
    Mesh mesh = cube_in_cube(3);
    for (Tet t : {Tet(0), Tet(80)}) {
        const auto v = mesh.tets[t];
        Cavity split{{t}, {}, {centroid(mesh, t)}};
        for (std::size_t i = 0; i < 4; ++i) {
            split.added.push_back({v, mesh.region[t]});
            split.added.back().vertices[i] = inserted_vertex(0);
        }
        const auto quarters = replace_cells(mesh, split).cells;
        if (t == Tet(0)) replace_cells(mesh, {quarters, {{v, mesh.region[t]}}, {}});
    }
    return mesh;
}

TEST(Compact, IsTheSameMeshWithoutFreeSlots) {
    const Mesh mesh = with_free_slots();
    ASSERT_EQ(verify(mesh), "");
    const auto [small, old_vertex, old_tet] = compact(mesh);
    EXPECT_EQ(verify(small), "");
    EXPECT_TRUE(small.free_tets.empty() && small.free_vertices.empty());
    ASSERT_EQ(static_cast<int>(small.tets.size()), count_tets(mesh));
    ASSERT_EQ(static_cast<int>(small.position.size()), count_vertices(mesh));
    for (Vertex v : small.position.indices()) EXPECT_EQ(small.position[v], mesh.position[old_vertex[v]]);
    for (Tet t : small.tets.indices()) {
        const Tet was = old_tet[t];
        EXPECT_EQ(small.region[t], mesh.region[was]);
        EXPECT_EQ(small.patch[t], mesh.patch[was]);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(old_vertex[small.tets[t][i]], mesh.tets[was][i]);
            const Tet n = small.neighbour[t][i];
            EXPECT_EQ(n.exists() ? old_tet[n] : Tet{}, mesh.neighbour[was][i]);
        }
    }
}

TEST(Compact, ChangesNothingTheSecondTime) {
    const Mesh once = compact(with_free_slots()).mesh;
    EXPECT_EQ(compact(once).mesh, once);
    EXPECT_EQ(compact(cube_in_cube(3)).mesh, cube_in_cube(3));
}

TEST(Mesh, IsAValue) {
    const Mesh mesh = cube_of_tets(1);
    Mesh copy = mesh;
    EXPECT_EQ(copy, mesh);
    copy.position[Vertex(0)].x = 0.1;
    EXPECT_NE(copy, mesh);
}

TEST(CopyChanged, CopiesWhatIsNamedAndNothingElse) {
    const Mesh from = [] {
        Mesh mesh = cube_of_tets(2);
        mesh.position[Vertex(13)] = {0.51, 0.5, 0.5};
        mesh.position[Vertex(4)] = {0.52, 0.5, 0};
        return mesh;
    }();
    Mesh to = cube_of_tets(2);
    copy_changed(to, from, {}, std::array{Vertex(13)});
    EXPECT_EQ(to.position[Vertex(13)], from.position[Vertex(13)]);
    EXPECT_EQ(to.position[Vertex(4)], (Vec3{0.5, 0.5, 0}));
    copy_changed(to, from, {}, std::array{Vertex(4)});
    EXPECT_EQ(to, from);
}

TEST(CopyChanged, TakesLayersAlong) {
    const Mesh thin = layered_cube(2), thick = layered_cube(5), bare = cube_in_cube(3);
    for (const auto& [from, to] : {std::pair(&thin, &thick), {&thick, &thin}, {&thick, &bare}, {&bare, &thick}}) {
        std::vector<Tet> tets;
        for (std::size_t i = 0; i < std::max(from->tets.size(), to->tets.size()); ++i) tets.push_back(Tet(i));
        Mesh follower = *to;
        ASSERT_NE(follower.layers, from->layers);
        copy_changed(follower, *from, tets, {});
        EXPECT_EQ(follower, *from);
    }
    Mesh moved = thick, follower = thick;  // the same layer, elsewhere
    for (Vertex v : moved.layers.front().columns) moved.position[v] *= 1.01;
    copy_changed(follower, moved, {}, moved.layers.front().columns);
    EXPECT_EQ(follower, moved);
}

TEST(CopyChanged, MakesTheMeshSmallerAgain) {
    const Mesh before = cube_of_tets(1);
    Mesh mesh = before;
    const Tet t(0);
    Cavity cavity{{t}, {}, {centroid(mesh, t)}};
    for (std::size_t i = 0; i < 4; ++i) {
        NewTet added{mesh.tets[t], mesh.region[t]};
        added.vertices[i] = inserted_vertex(0);
        cavity.added.push_back(added);
    }
    auto tets = replace_cells(mesh, cavity).cells;
    tets.push_back(t);
    ASSERT_GT(mesh.tets.size(), before.tets.size());
    Mesh follower = before;
    copy_changed(follower, mesh, tets, {});
    EXPECT_EQ(follower, mesh);
    copy_changed(follower, before, tets, {});
    EXPECT_EQ(follower, before);
}

}  // namespace
}  // namespace kropla
