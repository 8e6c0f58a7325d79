#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Vertices of cube_of_tets(2), whose number is i + 3 j + 9 k at (i, j, k) / 2.
const Vertex corner(0), on_edge(9), on_face(12), centre(13);

void expect_collapse(Mesh mesh, Vertex from, Vertex to) {
    SCOPED_TRACE("from " + std::to_string(from.value) + " to " + std::to_string(to.value));
    const Properties before = properties(mesh);
    const auto cavity = edge_collapse(mesh, from, to, 100);
    ASSERT_TRUE(cavity);
    const auto added = replace_cells(mesh, *cavity).cells;
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), before));
    EXPECT_FALSE(alive(mesh, from));
    EXPECT_NEAR(cavity->worst_after, worst_aspect_ratio(mesh, added), 1e-9);
}

TEST(EdgeCollapse, OfAFreeVertex) {
    Mesh mesh = ball_of_vertex();
    const auto cavity = edge_collapse(mesh, Vertex(0), Vertex(1), 100);
    ASSERT_TRUE(cavity);
    const Properties before = properties(mesh);
    replace_cells(mesh, *cavity);
    EXPECT_EQ(count_tets(mesh), 4);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
    EXPECT_FALSE(alive(mesh, Vertex(0)));
    EXPECT_EQ(cavity->worst_before, worst_aspect_ratio(ball_of_vertex(), cavity->removed));
}

TEST(EdgeCollapse, AlongWhatHoldsTheVertex) {
    const Mesh mesh = cube_of_tets(2);
    expect_collapse(mesh, centre, on_face);
    expect_collapse(mesh, on_face, on_edge);
    expect_collapse(mesh, on_edge, corner);
    EXPECT_FALSE(edge_collapse(mesh, on_face, centre, infinity)) << "off the face";
    EXPECT_FALSE(edge_collapse(mesh, on_edge, on_face, infinity)) << "off the edge of the box, within a face";
    EXPECT_FALSE(edge_collapse(mesh, on_edge, centre, infinity)) << "off the edge of the box";
    for (Vertex to : adjacent_vertices(mesh, corner))
        EXPECT_FALSE(edge_collapse(mesh, corner, to, infinity)) << "a corner of the box";
}

TEST(EdgeCollapse, NeverOfAnInterfaceVertex) {
    const Mesh mesh = cube_in_cube(4);
    int held = 0, onto = 0;
    for (Vertex v : all_vertices(mesh))
        for (Vertex w : adjacent_vertices(mesh, v)) {
            if (on_interface(mesh, v)) {
                EXPECT_FALSE(edge_collapse(mesh, v, w, infinity));
                ++held;
            } else if (on_interface(mesh, w) && edge_collapse(mesh, v, w, 100)) {
                expect_collapse(mesh, v, w);  // a free vertex may be drawn onto one
                ++onto;
            }
        }
    EXPECT_GE(held, 320);
    EXPECT_GE(onto, 7);
}

TEST(EdgeCollapse, RefusesWhatTurnsOverOrBecomesTooBad) {
    // Corner 1 stands behind the plane of the facet 2, 3, 5, as seen from vertex 0.
    Mesh mesh = ball_of_vertex();
    mesh.position[Vertex(1)] = {1, 0.8, 0};
    mesh.position[Vertex(3)] = {0, 0.3, 0};
    ASSERT_EQ(verify(mesh), "");
    EXPECT_FALSE(edge_collapse(mesh, Vertex(0), Vertex(1), 1e6));
    EXPECT_FALSE(edge_collapse(mesh, Vertex(0), Vertex(1), infinity));

    const auto cavity = edge_collapse(ball_of_vertex(), Vertex(0), Vertex(1), 100);
    ASSERT_TRUE(cavity);
    EXPECT_TRUE(edge_collapse(ball_of_vertex(), Vertex(0), Vertex(1), cavity->worst_after));
    EXPECT_FALSE(edge_collapse(ball_of_vertex(), Vertex(0), Vertex(1), 0.999 * cavity->worst_after));
}

/// Splits the edge and returns the new vertex.
Vertex expect_split(Mesh& mesh, Edge e, bool boundary_stays) {
    const Properties before = properties(mesh);
    const auto around = shell(mesh, e);
    EXPECT_TRUE(around);
    const auto cavity = edge_split(mesh, *around, e, 100);
    EXPECT_TRUE(cavity);
    if (!cavity) return {};
    const int tets = count_tets(mesh) + static_cast<int>(around->tets.size());
    const auto [added, inserted] = replace_cells(mesh, *cavity);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_EQ(count_tets(mesh), tets);
    EXPECT_TRUE(same_shape(properties(mesh), before));
    EXPECT_EQ(same(properties(mesh), before), boundary_stays);
    EXPECT_NEAR(cavity->worst_after, worst_aspect_ratio(mesh, added), 1e-9);
    EXPECT_FALSE(shell(mesh, e));
    EXPECT_EQ(inserted.size(), 1u);
    return inserted.front();
}

Constraint held(const Mesh& mesh, Vertex v) { return constraint(mesh, v, ball(mesh, v)); }

TEST(EdgeSplit, Inside) {
    Mesh mesh = shell_of_edge(5);
    const Vertex inserted = expect_split(mesh, {Vertex(0), Vertex(1)}, true);
    EXPECT_TRUE(held(mesh, inserted).free());
}

TEST(EdgeSplit, OnAFaceAndOnAnEdgeOfTheBox) {
    Mesh mesh = cube_of_tets(2);
    mesh.position[on_face] = {0, 0.53, 0.41};
    mesh.position[on_edge] = {0, 0, 0.57};
    ASSERT_EQ(verify(mesh), "");
    const Vertex in_face = expect_split(mesh, {on_face, on_edge}, false);
    EXPECT_EQ(held(mesh, in_face), (Constraint{1u << 0, false}));
    EXPECT_EQ(mesh.position[in_face].x, 0);  // exactly
    const Vertex in_edge = expect_split(mesh, {on_edge, corner}, false);
    EXPECT_EQ(held(mesh, in_edge), (Constraint{1u << 0 | 1u << 2, false}));
    EXPECT_EQ(mesh.position[in_edge].x, 0);
    EXPECT_EQ(mesh.position[in_edge].y, 0);
}

TEST(EdgeSplit, Refuses) {
    const Mesh mesh = cube_in_cube(3);
    const auto split = [](const Mesh& m, Vertex a, Vertex b, double allowed) {
        return edge_split(m, *shell(m, Edge{a, b}), {a, b}, allowed);
    };
    EXPECT_FALSE(split(mesh, Vertex(21), Vertex(22), infinity)) << "an edge of the interface";
    Mesh rigid = open_shell_of_edge(3);
    ASSERT_TRUE(split(rigid, Vertex(0), Vertex(1), 100));
    rename_patch(rigid, Patch(2), rigid_patch);
    EXPECT_FALSE(split(rigid, Vertex(0), Vertex(1), infinity)) << "an edge of a surface that is to stay";
    EXPECT_FALSE(split(shell_of_edge(5), Vertex(0), Vertex(1), 3)) << "the new tets are too bad";
}

/// The mean distance of the edges' lengths from the target, as |log2|.
double mean_departure(const Mesh& mesh, double target) {
    double sum = 0;
    int count = 0;
    for (Vertex v : all_vertices(mesh))
        for (Vertex w : adjacent_vertices(mesh, v)) {
            sum += std::abs(std::log2(distance(mesh.position[v], mesh.position[w]) / target));
            ++count;
        }
    return sum / count;
}

TEST(AdaptToSize, BringsLengthsNearerToTheTarget) {
    for (double target : {0.1, 0.12, 0.15, 0.45, 0.6, 0.8}) {
        SCOPED_TRACE("target " + std::to_string(target));
        Mesh mesh = cube_in_cube(4);
        jiggle(mesh, 0.02, 1);
        const Properties before = properties(mesh);
        const double departure = mean_departure(mesh, target);
        const int vertices = count_vertices(mesh);
        const AdaptOptions options;
        const double allowed = std::max(options.passing, worst_of(mesh));
        const Snapshot at{{{0, 0, 0}, {1, 1, 1}}, {target, 0, target}, {}};
        const Changes changes = adapt_to_size(mesh, all_tets(mesh), at, options);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same_shape(properties(mesh), before));
        EXPECT_LE(worst_of(mesh), allowed * (1 + 1e-12));
        EXPECT_LT(mean_departure(mesh, target), departure);
        EXPECT_EQ(count_vertices(mesh) - vertices, changes.splits - changes.collapses);
        EXPECT_GT(target < 0.3 ? changes.splits : changes.collapses, 0);
        EXPECT_EQ(changes.vertices.size(), std::size_t(changes.splits));
    }
}

TEST(AdaptToSize, LeavesAMeshOfTheRightSizeAlone) {
    Mesh mesh = cube_of_tets(4);  // edges of 0.25 ... 0.43
    const Mesh before = mesh;
    const Snapshot at{{{0, 0, 0}, {1, 1, 1}}, {0.32, 0, 0.32}, {}};
    const Changes changes = adapt_to_size(mesh, all_tets(mesh), at);
    EXPECT_EQ(mesh, before);
    EXPECT_EQ(changes.cells_replaced, 0);
}

}  // namespace
}  // namespace kropla
