#include "mesh/crossing.h"

#include "base/random.h"
#include "mesh/box_tree.h"
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// Both meshes in one, the second scaled and shifted; they share no vertex.
Mesh beside(const Mesh& a, const Mesh& b, const Vec3& shift, double scale = 1) {
    auto position = a.position;
    auto tets = a.tets;
    auto region = a.region;
    const auto first = static_cast<std::int32_t>(a.position.size());
    for (const Vec3& x : b.position) position.push_back(scale * x + shift);
    for (const Tet t : b.tets.indices()) {
        auto v = b.tets[t];
        for (Vertex& corner : v) corner = Vertex(corner.value + first);
        tets.push_back(v);
        region.push_back(b.region[t]);
    }
    return make_mesh(std::move(position), std::move(tets), std::move(region));
}

Mesh without_region(const Mesh& mesh, Region region) {
    Array<Tet, std::array<Vertex, 4>> tets;
    for (const Tet t : mesh.tets.indices())
        if (mesh.region[t] != region) tets.push_back(mesh.tets[t]);
    const std::size_t count = tets.size();
    return make_mesh(mesh.position, std::move(tets), Array<Tet, Region>(count, surroundings));
}

void expect_sound(const Mesh& mesh, const char* what) {
    EXPECT_EQ(verify(mesh), "") << what;
    EXPECT_FALSE(find_crossing(mesh)) << what;
    EXPECT_FALSE(find_buried(mesh)) << what;
}

TEST(Crossing, LegalMeshesHaveNone) {
    expect_sound(one_tet(), "one tet");
    expect_sound(two_tets(), "two tets");
    expect_sound(shell_of_edge(7), "a shell");
    expect_sound(open_shell_of_edge(5), "an open shell");
    expect_sound(ball_of_vertex(), "a ball");
    expect_sound(cube_of_tets(4), "a cube");
    expect_sound(layered_cube(3), "layers");
    const Mesh hollow = without_region(cube_in_cube(5), Region(1));
    expect_sound(hollow, "a hollow cube");
    expect_sound(beside(cube_of_tets(2), cube_of_tets(3), {1.0000001, 0, 0}), "two cubes in a row");
    expect_sound(beside(hollow, cube_of_tets(2), {0.3, 0.35, 0.3}, 0.4), "a cube in a hollow one");
    Mesh jiggled = hollow;
    jiggle(jiggled, 0.1 / 5, 1);
    expect_sound(jiggled, "jiggled");
}

TEST(Crossing, SurfacesThatCutAreFound) {
    for (const Vec3& shift : {Vec3{0.31, 0.22, 0.13}, Vec3{0.9, 0.9, 0.9}, Vec3{-0.4, 0.001, 0.2}}) {
        const Mesh mesh = beside(cube_of_tets(3), cube_of_tets(2), shift);
        EXPECT_EQ(verify(mesh), "");
        const auto found = find_crossing(mesh);
        ASSERT_TRUE(found);
        EXPECT_FALSE(found->covers);
        const auto first = static_cast<std::int32_t>(cube_of_tets(3).tets.size());
        EXPECT_NE(found->a.tet.value < first, found->b.tet.value < first);  // one of each
    }
}

TEST(Crossing, SurfacesThatCoverAreFound) {
    const Mesh cube = cube_of_tets(3);
    for (const Vec3& shift : {Vec3{}, Vec3{0.5, 0, 0}, Vec3{1, 0, 0}, Vec3{0.25, 1, 0.1}}) {
        const auto found = find_crossing(beside(cube, cube, shift));
        ASSERT_TRUE(found) << shift.x;
        EXPECT_TRUE(found->covers || shift.x == 0.5) << shift.x;  // there, it begins with one that cuts
    }
    const auto smaller = find_crossing(beside(cube, cube, {0.2, 0.2, 0}, 0.1));  // within one of its facets
    ASSERT_TRUE(smaller);
    EXPECT_TRUE(smaller->covers);
}

/// Two tets that share the edge 0-1; their facets at z = 0 lie on each other: the one rises, the other hangs.
Mesh folded(double y) {
    return make_mesh({{0, 0, 0}, {1, 0, 0}, {0.4, 1, 0}, {0.4, 0.5, 1}, {0.5, y, 0}, {0.5, y / 2, -1}},
                     {{Vertex(0), Vertex(1), Vertex(2), Vertex(3)}, {Vertex(1), Vertex(0), Vertex(4), Vertex(5)}},
                     Array<Tet, Region>(2, surroundings));
}

TEST(Crossing, FacetsFoldedAtTheirCommonEdgeCover) {
    const auto found = find_crossing(folded(0.8));
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->covers);
    auto open = folded(-0.8);
    std::swap(open.tets[Tet(1)][0], open.tets[Tet(1)][1]);
    EXPECT_FALSE(find_crossing(make_mesh(open.position, open.tets, open.region)));
}

TEST(Crossing, ATetThatPiercesAnotherBesideACommonVertexIsFound) {
    // The second has the vertex 0 and an edge through the first one's facet opposite to it, or beside it.
    for (const double aside : {0.0, 3.0}) {
        Mesh mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2 + aside, 2, 2}, {2 + aside, 3, 2}, {2 + aside, 2, 3}},
                              {{Vertex(0), Vertex(1), Vertex(2), Vertex(3)}, {Vertex(0), Vertex(4), Vertex(5), Vertex(6)}},
                              Array<Tet, Region>(2, surroundings));
        mesh.position[Vertex(4)].y -= aside;  // beyond the facet y = 0
        mesh.position[Vertex(5)].y -= 2 * aside;
        mesh.position[Vertex(6)].y -= aside;
        if (volume(mesh, Tet(1)) < 0) std::swap(mesh.tets[Tet(1)][2], mesh.tets[Tet(1)][3]);
        ASSERT_GT(volume(mesh, Tet(1)), 0);
        EXPECT_EQ(find_crossing(make_mesh(mesh.position, mesh.tets, mesh.region)).has_value(), aside == 0);
    }
}

TEST(Crossing, IsExact) {
    for (const double height : {std::nextafter(1.0, 2.0), 1.0, std::nextafter(1.0, 0.0)}) {
        Mesh tet = one_tet();  // turned over, so that it stands on its tip
        for (Vec3& x : tet.position) x = {0.3 + 0.1 * x.x, 0.3 + 0.1 * x.y, height + (0.5 - 0.5 * x.z)};
        std::swap(tet.tets[Tet(0)][0], tet.tets[Tet(0)][1]);
        ASSERT_GT(volume(tet, Tet(0)), 0);
        EXPECT_EQ(find_crossing(beside(cube_of_tets(3), tet, {})).has_value(), height <= 1) << height - 1;
    }
}

TEST(Buried, APartWithinAnotherIsFound) {
    const Mesh mesh = beside(cube_of_tets(2), cube_of_tets(2), {0.31, 0.33, 0.35}, 0.05);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_FALSE(find_crossing(mesh));
    const auto found = find_buried(mesh);
    ASSERT_TRUE(found);
    EXPECT_GE(found->cell.value, 48);
    EXPECT_LT(std::get<Tet>(found->within).value, 48);
}

TEST(Buried, APartWithinAPrismIsFound) {
    const Mesh layered = layered_cube(2);
    const std::vector<Prism> prisms = all_prisms(layered);
    ASSERT_GE(prisms.size(), 24u);
    for (const Prism& prism : prisms) {
        Vec3 middle;
        for (const Vec3& x : prism_corners(layered, prism)) middle += x / 6;
        Mesh mesh = beside(layered, cube_of_tets(1), middle, 1e-3);
        for (const Tet t : layered.tets.indices()) mesh.patch[t] = layered.patch[t];
        add_layer(mesh, layered.layers[0]);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_FALSE(find_crossing(mesh));
        const auto found = find_buried(mesh);
        ASSERT_TRUE(found);
        EXPECT_GE(as_size(found->cell.value), layered.tets.size());
        const Prism within = std::get<Prism>(found->within);
        EXPECT_EQ(std::pair(within.triangle, within.k), std::pair(prism.triangle, prism.k));
    }
}

/// Whether a plane parts the tets: one of their facets, or across an edge of each [Gottschalk et al. 1996].
bool are_apart(const std::array<Vec3, 4>& a, const std::array<Vec3, 4>& b) {
    const auto parts = [&](const Vec3& axis) {
        double a_min = 1e300, a_max = -1e300, b_min = 1e300, b_max = -1e300;
        for (std::size_t i = 0; i < 4; ++i) {
            a_min = std::min(a_min, dot(axis, a[i]));
            a_max = std::max(a_max, dot(axis, a[i]));
            b_min = std::min(b_min, dot(axis, b[i]));
            b_max = std::max(b_max, dot(axis, b[i]));
        }
        return a_max < b_min || b_max < a_min;
    };
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            for (const auto* tet : {&a, &b})
                for (std::size_t k = 0; k < 4; ++k)
                    if (parts(cross((*tet)[i] - (*tet)[j], (*tet)[k] - (*tet)[j]))) return true;
            for (std::size_t k = 0; k < 4; ++k)
                for (std::size_t l = 0; l < k; ++l)
                    if (parts(cross(a[i] - a[j], b[k] - b[l]))) return true;
        }
    return false;
}

TEST(Crossing, AgreesWithPlanesThatPartRandomTets) {
    Random random{5};
    SCOPED_TRACE("seed 5");
    int crossing = 0, buried = 0, apart = 0;
    for (int i = 0; i < 3000; ++i) {
        Mesh a = one_tet(), b = one_tet();
        const double scale = i % 4 == 0 ? 0.1 : 1;  // so that some lie within others
        const auto shuffle = [&](Mesh& mesh, double size, double spread) {
            const Vec3 middle = {random.uniform(-spread, spread), random.uniform(-spread, spread), random.uniform(-spread, spread)};
            do
                for (Vec3& x : mesh.position)
                    x = middle + size * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
            while (!(volume(mesh, Tet(0)) > 1e-3 * size * size * size));
        };
        shuffle(a, 1, 0);
        shuffle(b, scale, 0.5);
        const Mesh both = beside(a, b, {});
        const bool cut = find_crossing(both).has_value(), within = find_buried(both).has_value();
        std::array<Vec3, 4> pa, pb;
        for (std::size_t k = 0; k < 4; ++k) {
            pa[k] = a.position[a.tets[Tet(0)][k]];
            pb[k] = b.position[b.tets[Tet(0)][k]];
        }
        ASSERT_EQ(cut || within, !are_apart(pa, pb)) << i;
        crossing += cut ? 1 : 0;
        buried += within && !cut ? 1 : 0;
        apart += cut || within ? 0 : 1;
    }
    EXPECT_GE(crossing, 1000);
    EXPECT_GE(buried, 19);
    EXPECT_GE(apart, 1600);
}

TEST(BoxTree, FindsTheBoxesThatMeet) {
    Random random{2};
    SCOPED_TRACE("seed 2");
    for (const std::size_t count : {0, 1, 7, 9, 500}) {
        std::vector<Extent> boxes(count);
        const auto point = [&] { return Vec3{random.uniform(), random.uniform(), random.uniform()}; };
        for (Extent& box : boxes) {
            const Vec3 x = point();
            box.take_in(x);
            box.take_in(x + 0.2 * point());
        }
        const BoxTree tree(boxes);
        for (int i = 0; i < 50; ++i) {
            Extent box;
            box.take_in(point());
            if (i % 2 == 0) box.take_in(point());  // else it is a point
            std::vector<std::size_t> found, expected;
            EXPECT_FALSE(tree.any(box, [&](std::size_t n) { return found.push_back(n), false; }));
            for (std::size_t n = 0; n < count; ++n)
                if (boxes[n].meets(box)) expected.push_back(n);
            std::ranges::sort(found);
            EXPECT_EQ(found, expected);
        }
    }
}

}  // namespace
}  // namespace kropla
