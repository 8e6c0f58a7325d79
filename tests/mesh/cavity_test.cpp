#include <kropla/mesh/cavity.h>

#include "mesh/meshes.h"
#include "mesh/properties.h"
#include "mesh/proposals.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace kropla {
namespace {

constexpr Edge axis{Vertex(0), Vertex(1)};  // of the shells

/// The cavity is refused and the mesh stays as it is, bit for bit.
void expect_refused(Mesh mesh, const Cavity& cavity, const std::string& reason) {
    const Mesh before = mesh;
    try {
        replace_cells(mesh, cavity);
        ADD_FAILURE() << "not refused";
    } catch (const std::logic_error& error) {
        EXPECT_EQ(error.what(), "replace_cells: " + reason);
    }
    EXPECT_EQ(mesh, before);
}

TEST(ReplaceCells, TwoBecomeThreeAndTwoAgain) {
    Mesh mesh = two_tets();
    const Properties before = properties(mesh);
    replace_cells(mesh, facet_removal(mesh, {Tet(0), 3}));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_EQ(count_tets(mesh), 3);
    const Edge made{Vertex(3), Vertex(4)};
    ASSERT_TRUE(shell(mesh, made));
    EXPECT_TRUE(shell(mesh, made)->closed);

    replace_cells(mesh, edge_removal(mesh, made));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_EQ(count_tets(mesh), 2);
    EXPECT_FALSE(shell(mesh, made));
}

TEST(ReplaceCells, ThreeBecomeTwo) {
    Mesh mesh = shell_of_edge(3);
    const Properties before = properties(mesh);
    replace_cells(mesh, edge_removal(mesh, axis));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_EQ(count_tets(mesh), 2);
    EXPECT_EQ(mesh.free_tets.size(), 1u);
}

TEST(ReplaceCells, InsertsAVertex) {
    Mesh mesh = one_tet();
    const Properties before = properties(mesh);
    const auto [added, inserted] = replace_cells(mesh, insertion(mesh, Tet(0), {0.25, 0.25, 0.25}));
    ASSERT_EQ(inserted.size(), 1u);
    const Vertex named = inserted.front();
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_EQ(count_tets(mesh), 4);
    EXPECT_EQ(count_vertices(mesh), 5);
    EXPECT_EQ(mesh.position[named], (Vec3{0.25, 0.25, 0.25}));
    for (std::size_t i = 0; i < 4; ++i) {  // in the order of the proposal: the i-th has the i-th facet
        EXPECT_EQ(mesh.tets[added[i]][i], named);
        EXPECT_EQ(mesh.patch[added[i]][i], Patch(i));
    }
}

TEST(ReplaceCells, RemovesAVertex) {
    Mesh mesh = ball_of_vertex();
    const Properties before = properties(mesh);
    replace_cells(mesh, edge_collapse(mesh, {Vertex(0), Vertex(1)}));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_EQ(count_tets(mesh), 4);
    EXPECT_EQ(mesh.free_vertices, std::vector{Vertex(0)});
    EXPECT_EQ(mesh.free_tets.size(), 4u);
}

TEST(ReplaceCells, SwapsTheDiagonalOfAWall) {
    Mesh mesh = open_shell_of_edge(2);
    const Properties before = properties(mesh);
    replace_cells(mesh, wall_swap(mesh, axis));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), before));
    EXPECT_FALSE(same(properties(mesh), before)) << "the facets on the wall are others";
    EXPECT_FALSE(shell(mesh, axis));
    const auto made = shell(mesh, Edge{Vertex(2), Vertex(4)});
    ASSERT_TRUE(made);
    EXPECT_EQ(constraint(mesh, *made), (Constraint{1u << 2, false}));
}

TEST(ReplaceCells, SplitsEdgesInsideAndOnTheBoundary) {
    for (int n = 3; n <= 6; ++n) {
        for (Mesh mesh : {shell_of_edge(n), open_shell_of_edge(n)}) {
            const Properties before = properties(mesh);
            const Vertex middle = replace_cells(mesh, edge_split(mesh, axis)).vertices.front();
            EXPECT_EQ(verify(mesh), "");
            EXPECT_TRUE(same_shape(properties(mesh), before));
            EXPECT_EQ(count_tets(mesh), 2 * n);
            EXPECT_FALSE(shell(mesh, axis));

            replace_cells(mesh, edge_collapse(mesh, {middle, axis.a}));
            EXPECT_EQ(verify(mesh), "");
            EXPECT_TRUE(same(properties(mesh), before));
            EXPECT_TRUE(shell(mesh, axis));
        }
    }
}

TEST(ReplaceCells, KeepsTheRegionsOfASplitInterface) {
    Mesh mesh = cube_in_cube(3);
    const Properties before = properties(mesh);
    const Edge on_body{Vertex(21), Vertex(22)};
    const Vertex middle = replace_cells(mesh, edge_split(mesh, on_body)).vertices.front();
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_TRUE(constraint(mesh, middle, ball(mesh, middle)).on_interface);
}

TEST(ReplaceCells, TakesFreeSlotsFirst) {
    Mesh mesh = ball_of_vertex();
    replace_cells(mesh, edge_collapse(mesh, {Vertex(0), Vertex(1)}));
    const std::size_t slots = mesh.tets.size();
    Tet first;
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t)) first = t;
    const auto [added, inserted] = replace_cells(mesh, insertion(mesh, first, centroid(mesh, first)));
    EXPECT_EQ(verify(mesh), "");
    EXPECT_EQ(inserted, std::vector{Vertex(0)});
    EXPECT_EQ(mesh.tets.size(), slots);
    EXPECT_EQ(added.front(), first);
    EXPECT_EQ(mesh.free_tets.size(), 1u);
    EXPECT_TRUE(mesh.free_vertices.empty());
}

TEST(ReplaceCells, NamesSeveralNewVertices) {
    Mesh mesh = ball_of_vertex();
    replace_cells(mesh, edge_collapse(mesh, {Vertex(0), Vertex(1)}));  // slot 0 is free
    Mesh two_steps = mesh;
    Tet t;
    for (Tet u : mesh.tets.indices())
        if (alive(mesh, u)) t = u;
    const Vec3 first = centroid(mesh, t), second = (first + mesh.position[mesh.tets[t][0]]) / 2;
    Cavity both = insertion(mesh, t, first);
    // all but the first have corner 0 of t, and `second` in the middle of their edge from there to p
    both.inserted.push_back(second);
    std::vector<NewTet> halves = {both.added[0]};  // the one without corner 0
    for (std::size_t i = 1; i < 4; ++i)
        for (std::size_t end : {std::size_t{0}, i}) {
            halves.push_back(both.added[i]);
            halves.back().vertices[end] = inserted_vertex(1);
        }
    both.added = halves;
    ASSERT_TRUE(all_positive(mesh, both));
    const auto inserted = replace_cells(mesh, both).vertices;
    EXPECT_EQ(verify(mesh), "");
    ASSERT_EQ(inserted, (std::vector{Vertex(0), Vertex(7)}));  // the free slot, then a new one
    const Vertex p = inserted[0], q = inserted[1];
    EXPECT_EQ(mesh.position[p], first);
    EXPECT_EQ(mesh.position[q], second);

    replace_cells(two_steps, insertion(two_steps, t, first));
    replace_cells(two_steps, edge_split(two_steps, {p, two_steps.tets[t][1]}));
    EXPECT_EQ(count_tets(two_steps), count_tets(mesh));
}

TEST(ReplaceCells, AProposalOutlivesOthersThatInsert) {
    Mesh mesh = cube_of_tets(2);
    const std::size_t vertices = mesh.position.size();
    const Cavity first = insertion(mesh, Tet(0), centroid(mesh, Tet(0)));
    const Cavity second = insertion(mesh, Tet(7), centroid(mesh, Tet(7)));
    EXPECT_EQ(replace_cells(mesh, first).vertices, std::vector{Vertex(vertices)});
    EXPECT_EQ(replace_cells(mesh, second).vertices, std::vector{Vertex(vertices + 1)});
    EXPECT_EQ(verify(mesh), "");
}

TEST(ReplaceCells, FreesAnInsertedVertexThatNoTetTook) {
    Mesh mesh = two_tets();
    Cavity cavity = facet_removal(mesh, {Tet(0), 3});
    cavity.inserted.push_back({0, 0, 0});
    replace_cells(mesh, cavity);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_EQ(mesh.free_vertices, std::vector{Vertex(5)});
}

TEST(ReplaceCells, RefusesACavityThatLosesAFacetAroundIt) {
    const Mesh mesh = cube_of_tets(2);
    Cavity cavity = insertion(mesh, Tet(0), centroid(mesh, Tet(0)));
    const auto inner = std::ranges::find_if(mesh.neighbour[Tet(0)], [](Tet n) { return n.exists(); });
    const auto corner = inner - mesh.neighbour[Tet(0)].begin();
    std::swap(cavity.added[std::size_t(corner)], cavity.added.back());
    cavity.added.pop_back();
    expect_refused(mesh, cavity, "a facet around the cavity would be lost");
}

TEST(ReplaceCells, RefusesNewFacetsOfTheBoundaryWithoutAPatch) {
    const Mesh mesh = open_shell_of_edge(2);
    Cavity cavity = wall_swap(mesh, axis);
    for (auto& tet : cavity.added) tet.patch = {};
    expect_refused(mesh, cavity, "an added facet has no other side and no patch");
}

TEST(ReplaceCells, RefusesAFacetUsedTooOften) {
    const Mesh mesh = two_tets();
    Cavity twice = facet_removal(mesh, {Tet(0), 3});
    twice.added.push_back(twice.added.back());
    expect_refused(mesh, twice, "a facet of the cavity is used too often");
}

TEST(ReplaceCells, RefusesToRemoveACellTwiceOrAFreeSlot) {
    Mesh mesh = shell_of_edge(3);
    replace_cells(mesh, edge_removal(mesh, axis));
    ASSERT_EQ(mesh.free_tets.size(), 1u);
    Cavity cavity = facet_removal(mesh, {Tet(0), 3});
    cavity.removed.push_back(Tet(0));
    expect_refused(mesh, cavity, "a cell is removed that does not exist, or twice");
    cavity.removed.back() = mesh.free_tets.front();
    expect_refused(mesh, cavity, "a cell is removed that does not exist, or twice");
}

TEST(ReplaceCells, RefusesVerticesThatNobodyMade) {
    const Mesh mesh = two_tets();
    Cavity cavity = insertion(mesh, Tet(0), centroid(mesh, Tet(0)));
    cavity.inserted.clear();
    expect_refused(mesh, cavity, "an added cell has a vertex that does not exist");
    for (Vertex unknown : {Vertex{}, Vertex(5)}) {
        Cavity other = facet_removal(mesh, {Tet(0), 3});
        other.added.front().vertices[0] = unknown;
        expect_refused(mesh, other, "an added cell has a vertex that does not exist");
    }
}

}  // namespace
}  // namespace kropla
