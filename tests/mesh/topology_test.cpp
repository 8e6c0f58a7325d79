#include <kropla/mesh/topology.h>

#include <kropla/base/predicates.h>
#include "mesh/meshes.h"
#include "mesh/proposals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

constexpr Edge axis{Vertex(0), Vertex(1)};  // of the shells

int turn(const Mesh& mesh, Vertex a, Vertex b, Vertex c, Vertex d) {
    return orient3d(mesh.position[a], mesh.position[b], mesh.position[c], mesh.position[d]);
}

/// tets[i] has the edge, ring[i] and ring[i + 1], and the ring turns right-handed around the edge.
void expect_in_order(const Mesh& mesh, Edge e, const Shell& s) {
    ASSERT_EQ(s.ring.size(), s.tets.size() + (s.closed ? 0 : 1));
    for (std::size_t i = 0; i < s.tets.size(); ++i) {
        const Vertex c = s.ring[i], d = s.ring[(i + 1) % s.ring.size()];
        for (Vertex v : {e.a, e.b, c, d}) EXPECT_GE(corner_of(mesh, s.tets[i], v), 0);
        EXPECT_GT(turn(mesh, e.a, e.b, c, d), 0);
    }
}

TEST(CornerOf, FindsEachCornerAndNoOther) {
    const Mesh mesh = two_tets();
    for (int i = 0; i < 4; ++i) EXPECT_EQ(corner_of(mesh, Tet(0), mesh.tets[Tet(0)][std::size_t(i)]), i);
    EXPECT_EQ(corner_of(mesh, Tet(0), Vertex(4)), -1);
}

TEST(FacetVertices, FaceOutwards) {
    const Mesh mesh = one_tet();
    for (int i = 0; i < 4; ++i) {
        const auto [a, b, c] = facet_vertices(mesh, {Tet(0), i});
        EXPECT_LT(turn(mesh, a, b, c, mesh.tets[Tet(0)][std::size_t(i)]), 0) << "facet " << i;
    }
}

TEST(MirrorCorner, FacesTheSharedFacet) {
    const Mesh mesh = two_tets();
    EXPECT_EQ(mirror_corner(mesh, {Tet(0), 3}), corner_of(mesh, Tet(1), Vertex(4)));
    EXPECT_EQ(mirror_corner(mesh, {Tet(1), 3}), corner_of(mesh, Tet(0), Vertex(3)));
}

TEST(MirrorCorner, LeadsBackFromEveryFacet) {
    const Mesh mesh = cube_of_tets(2);
    int inner = 0;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[t][std::size_t(i)];
            if (!n.exists()) continue;
            EXPECT_EQ(mesh.neighbour[n][std::size_t(mirror_corner(mesh, {t, i}))], t);
            ++inner;
        }
    EXPECT_EQ(inner, 48 * 4 - 6 * 8);  // two triangles per square, four squares per face
}

TEST(AllTets, LeavesOutFreeSlots) {
    Mesh mesh = shell_of_edge(3);
    auto made = replace_cells(mesh, edge_removal(mesh, axis)).cells;  // two
    std::ranges::sort(made);
    EXPECT_EQ(mesh.tets.size(), 3u);
    EXPECT_EQ(all_tets(mesh), made);
}

TEST(Ball, IsEveryTetAtTheVertexOnce) {
    const Mesh mesh = cube_of_tets(3);
    for (Vertex v : mesh.position.indices()) {
        std::vector<Tet> expected;
        for (Tet t : mesh.tets.indices())
            if (corner_of(mesh, t, v) >= 0) expected.push_back(t);
        auto found = ball(mesh, v);
        std::ranges::sort(found);
        EXPECT_EQ(found, expected) << "vertex " << v.value;
    }
}

TEST(Ball, EmptiesTheListGiven) {
    std::vector<Tet> tets(5, Tet(7));
    ball(two_tets(), Vertex(4), tets);
    EXPECT_EQ(tets, std::vector<Tet>{Tet(1)});
}

TEST(Ball, OfAFreeSlotIsEmpty) {
    const Mesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, 5, 5}},
                                {{Vertex(0), Vertex(1), Vertex(2), Vertex(3)}}, {surroundings});
    EXPECT_TRUE(ball(mesh, Vertex(4)).empty());
}

TEST(Link, ClosesAroundAnInnerVertex) {
    const Mesh mesh = ball_of_vertex();
    const auto facets = link(mesh, Vertex(0));
    EXPECT_EQ(facets.size(), 8u);
    std::set<std::array<Vertex, 2>> edges;  // directed: each must be met by its opposite
    for (Facet f : facets) {
        const auto v = facet_vertices(mesh, f);
        EXPECT_LT(turn(mesh, v[0], v[1], v[2], Vertex(0)), 0);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_TRUE(edges.insert({v[k], v[(k + 1) % 3]}).second);
    }
    for (const auto& [a, b] : edges) EXPECT_TRUE(edges.contains({b, a}));
}

TEST(AdjacentVertices, AreTheOtherEndsOfEdges) {
    EXPECT_EQ(adjacent_vertices(ball_of_vertex(), Vertex(1)),
              (std::vector{Vertex(0), Vertex(3), Vertex(4), Vertex(5), Vertex(6)}));
    EXPECT_EQ(adjacent_vertices(two_tets(), Vertex(3)), (std::vector{Vertex(0), Vertex(1), Vertex(2)}));
    EXPECT_EQ(adjacent_vertices(cube_of_tets(2), Vertex(13)).size(), 14u);  // the inner vertex of the grid
}

TEST(Shell, ClosedGoesOnceRoundTheEdge) {
    for (int n = 3; n <= 8; ++n) {
        SCOPED_TRACE(n);
        const Mesh mesh = shell_of_edge(n);
        for (Tet start : mesh.tets.indices()) {
            const Shell s = shell(mesh, axis, start);
            EXPECT_TRUE(s.closed);
            EXPECT_EQ(s.tets.front(), start);
            EXPECT_EQ(std::set(s.tets.begin(), s.tets.end()).size(), std::size_t(n));
            EXPECT_EQ(std::set(s.ring.begin(), s.ring.end()).size(), std::size_t(n));
            expect_in_order(mesh, axis, s);
        }
    }
}

TEST(Shell, OpenGoesFromWallToWall) {
    for (int n = 2; n <= 6; ++n) {
        SCOPED_TRACE(n);
        const Mesh mesh = open_shell_of_edge(n);
        for (Tet start : mesh.tets.indices()) {  // wherever the walk begins
            const Shell s = shell(mesh, axis, start);
            EXPECT_FALSE(s.closed);
            EXPECT_EQ(s.tets.size(), std::size_t(n));
            EXPECT_EQ(s.ring.front(), Vertex(2));
            EXPECT_EQ(s.ring.back(), Vertex(n + 2));
            expect_in_order(mesh, axis, s);
        }
    }
}

TEST(Shell, OfTheEdgeTurnedIsTurned) {
    const Mesh mesh = open_shell_of_edge(3);
    const auto there = shell(mesh, axis);
    auto back = shell(mesh, Edge{axis.b, axis.a});
    ASSERT_TRUE(there && back);
    expect_in_order(mesh, Edge{axis.b, axis.a}, *back);
    std::ranges::reverse(back->tets);
    std::ranges::reverse(back->ring);
    EXPECT_EQ(back->tets, there->tets);
    EXPECT_EQ(back->ring, there->ring);
}

TEST(Shell, OfEveryEdgeOfAGridIsInOrder) {
    const Mesh mesh = cube_of_tets(2);
    int closed = 0, open = 0;
    for (Vertex a : mesh.position.indices())
        for (Vertex b : adjacent_vertices(mesh, a)) {
            const auto s = shell(mesh, Edge{a, b});
            ASSERT_TRUE(s);
            expect_in_order(mesh, Edge{a, b}, *s);
            ++(s->closed ? closed : open);
        }
    EXPECT_EQ(closed, 2 * 26);  // 98 edges; on the surface of 48 triangles are 72; each seen from both ends
    EXPECT_EQ(open, 2 * 72);
}

TEST(Shell, OfNoEdgeIsNothing) {
    EXPECT_FALSE(shell(two_tets(), Edge{Vertex(3), Vertex(4)}));
}

TEST(Constraint, OfVerticesIsTheirPatchesAndInterface) {
    const Mesh mesh = cube_in_cube(3);  // 4 x 4 x 4 vertices; the inner cube begins at 21 and ends at 42
    const auto of = [&](int v) { return constraint(mesh, Vertex(v), ball(mesh, Vertex(v))); };
    EXPECT_EQ(of(0), (Constraint{1u << 0 | 1u << 2 | 1u << 4, false}));
    EXPECT_EQ(of(63), (Constraint{1u << 1 | 1u << 3 | 1u << 5, false}));
    EXPECT_EQ(of(1), (Constraint{1u << 2 | 1u << 4, false}));
    EXPECT_EQ(of(5), (Constraint{1u << 4, false}));
    EXPECT_EQ(of(21), (Constraint{0, true}));
    const Mesh plain = cube_of_tets(2);
    EXPECT_TRUE(constraint(plain, Vertex(13), ball(plain, Vertex(13))).free());
}

TEST(Constraint, OfEdgesIsThatOfTheirShell) {
    const Mesh mesh = cube_in_cube(3);
    const auto of = [&](int a, int b) {
        return constraint(mesh, shell(mesh, Edge{Vertex(a), Vertex(b)}).value());
    };
    EXPECT_EQ(of(0, 1), (Constraint{1u << 2 | 1u << 4, false}));  // an edge of the box
    EXPECT_EQ(of(5, 6), (Constraint{1u << 4, false}));            // inside a face of the box
    EXPECT_EQ(of(5, 21), (Constraint{0, false}));                 // from the box to the body
    EXPECT_EQ(of(21, 22), (Constraint{0, true}));                 // an edge of the body
    EXPECT_EQ(of(21, 26), (Constraint{0, true}));                 // a diagonal on a face of the body
    EXPECT_EQ(of(21, 42), (Constraint{0, false}));                // the diagonal through the body
}

}  // namespace
}  // namespace kropla
