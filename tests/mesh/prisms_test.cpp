#include <kropla/mesh/prisms.h>

#include "base/random.h"
#include "base/tetrahedron.h"
#include <kropla/mesh/cavity.h>
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

using Corners = std::array<Vec3, 6>;

/// On an equilateral triangle of edge 1, of height 1: volume sqrt(3)/4.
Corners right_prism() {
    const double h = std::sqrt(0.75);
    return {{{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, h, 1}}};
}

Corners distorted(std::uint64_t seed) {
    Random random{seed};
    Corners x = right_prism();
    for (Vec3& p : x)
        for (int axis = 0; axis < 3; ++axis) p[axis] += random.uniform(-0.15, 0.15);
    return x;
}

/// The integral of the Jacobian of (r, s, z) -> (1-z) bottom(r, s) + z top(r, s): quadratic in z and in (r,
/// s), so that two Gauss points and the edges' midpoints are exact.
double integrated_volume(const Corners& x) {
    double sum = 0;
    for (double z : {0.5 - std::sqrt(1.0 / 12), 0.5 + std::sqrt(1.0 / 12)})
        for (const auto& [r, s] : {std::pair{0.5, 0.0}, {0.0, 0.5}, {0.5, 0.5}}) {
            const auto mixed = [&](const Vec3& below, const Vec3& above) {
                return (1 - z) * below + z * above;
            };
            const Vec3 by_r = mixed(x[1] - x[0], x[4] - x[3]), by_s = mixed(x[2] - x[0], x[5] - x[3]);
            const Vec3 by_z = (1 - r - s) * (x[3] - x[0]) + r * (x[4] - x[1]) + s * (x[5] - x[2]);
            sum += determinant(by_r, by_s, by_z) / 12;
        }
    return sum;
}

/// Cut into three tets: the top corner above `first` goes to all of the bottom, the one above `second` to its
/// rest.
double cut_volume(const Corners& x, std::size_t first, std::size_t second, std::size_t third) {
    return std::abs(tet_volume(x[0], x[1], x[2], x[first + 3])) +
           std::abs(tet_volume(x[second], x[third], x[first + 3], x[second + 3])) +
           std::abs(tet_volume(x[third], x[first + 3], x[second + 3], x[third + 3]));
}

TEST(Prism, OfARightPrismVolumeAndQualityAreKnown) {
    EXPECT_NEAR(prism_volume(right_prism()), std::sqrt(3) / 4, 1e-15);
    EXPECT_NEAR(scaled_corner_jacobian(right_prism()), 1, 1e-15);
}

TEST(Prism, VolumeIsTheIntegralOfItsJacobian) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Corners x = distorted(seed);
        EXPECT_NEAR(prism_volume(x), integrated_volume(x), 1e-14);
    }
}

TEST(Prism, VolumeIsTheMeanOfItsSixCutsIntoTets) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Corners x = distorted(seed);
        const double cuts = cut_volume(x, 0, 1, 2) + cut_volume(x, 0, 2, 1) + cut_volume(x, 1, 0, 2) +
                            cut_volume(x, 1, 2, 0) + cut_volume(x, 2, 0, 1) + cut_volume(x, 2, 1, 0);
        EXPECT_NEAR(prism_volume(x), cuts / 6, 1e-14);
    }
}

TEST(Prism, QualityDoesNotDependOnHeightButOnLean) {
    Corners x = right_prism();
    for (std::size_t i = 3; i < 6; ++i) x[i].z = 1e-3;
    EXPECT_NEAR(scaled_corner_jacobian(x), 1, 1e-12);
    x = right_prism();
    for (std::size_t i = 3; i < 6; ++i) x[i].x += 1;  // columns lean by 45 degrees
    EXPECT_NEAR(scaled_corner_jacobian(x), std::sqrt(0.5), 1e-15);
    x = right_prism();
    x[5].z = -0.1;
    EXPECT_LT(scaled_corner_jacobian(x), 0);
    x[5] = x[2];
    EXPECT_EQ(scaled_corner_jacobian(x), 0);
}

TEST(Layer, PrismsAreImpliedByTrianglesAndColumns) {
    const Mesh mesh = layered_cube(3);
    ASSERT_EQ(verify(mesh), "");
    EXPECT_EQ(count_prisms(mesh), 12 * 3);
    const auto prisms = all_prisms(mesh);
    ASSERT_EQ(prisms.size(), 36u);
    for (std::size_t i = 1; i < prisms.size(); ++i) {
        if (prisms[i].triangle != prisms[i - 1].triangle) continue;
        const auto below = prism_vertices(mesh, prisms[i - 1]), above = prism_vertices(mesh, prisms[i]);
        for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(below[c + 3], above[c]);
    }
    for (const Prism& prism : prisms) EXPECT_GT(prism_volume(prism_corners(mesh, prism)), 0);
}

TEST(Layer, BodyLayerAndSurroundingsFillTheBox) {
    const Mesh mesh = layered_cube(3);
    EXPECT_NEAR(region_volume(mesh, Region(1)), std::pow(1.0 / 6, 3), 1e-15);
    EXPECT_NEAR(region_volume(mesh, surroundings) + region_volume(mesh, Region(1)), 1, 1e-12);
    double layer = 0;
    for (const Prism& prism : all_prisms(mesh)) layer += prism_volume(prism_corners(mesh, prism));
    EXPECT_NEAR(layer, 1.0 / 27 - 1.0 / 216, 1e-15);
}

TEST(Layer, SummaryHasItsHeightsAndQuality) {
    const LayerSummary summary = summarise_layer(layered_cube(3), Layer(0));
    const double diagonal = std::sqrt(3) / 12;  // from the wall's corner to the shell's
    EXPECT_EQ(summary.prisms, 36);
    EXPECT_NEAR(summary.min_first_height, diagonal / 3, 1e-15);
    EXPECT_NEAR(summary.max_first_height, diagonal / 3, 1e-15);
    EXPECT_NEAR(summary.min_thickness, diagonal, 1e-15);
    EXPECT_NEAR(summary.max_thickness, diagonal, 1e-15);
    EXPECT_NEAR(summary.min_growth, 1, 1e-12);
    EXPECT_NEAR(summary.max_growth, 1, 1e-12);
    // At a corner of the cube: 45 degrees in the triangle, the diagonal's height over its length 1/sqrt(3).
    EXPECT_NEAR(summary.min_jacobian, std::sqrt(0.5) / std::sqrt(3) / std::sqrt(0.75), 1e-12);
}

TEST(Layer, ItsVerticesAreCounted) {
    const Mesh mesh = layered_cube(3);
    EXPECT_EQ(count_vertices(mesh), 64 + 8 * 3);
    EXPECT_EQ(summarise_quality(mesh).vertices, 64 + 8 * 3);
    EXPECT_EQ(summarise_quality(mesh, Region(1)).vertices, 8);
    EXPECT_EQ(summarise_quality(mesh, surroundings).vertices, 64 + 8 * 3);
    EXPECT_TRUE(mesh.free_vertices.empty());
}

TEST(Layer, ItsWallAndShellAreRigid) {
    const Mesh mesh = layered_cube(2);
    for (int column = 0; column < 8; ++column) {
        const Vertex wall = column_vertex(mesh.layers[0], column, 0),
                     shell = column_vertex(mesh.layers[0], column, 2);
        EXPECT_TRUE(constraint(mesh, wall, ball(mesh, wall)).rigid());
        EXPECT_TRUE(constraint(mesh, shell, ball(mesh, shell)).rigid());
        EXPECT_TRUE(ball(mesh, column_vertex(mesh.layers[0], column, 1)).empty());
    }
}

TEST(Layer, GoesAlongWhenAMeshIsCompacted) {
    Mesh mesh = layered_cube(2);
    // a vertex is put into the tets of the body and taken out again: a free slot before new ones, and one
    // after
    const Tet t = mesh.tet_at[column_vertex(mesh.layers[0], 0, 0)];
    const auto corners = mesh.tets[t];
    Cavity put_in{{t}, {}, {centroid(mesh, t)}, 0, 0};
    for (std::size_t i = 0; i < 4; ++i) {
        NewTet added{corners, mesh.region[t]};
        added.vertices[i] = inserted_vertex(0);
        put_in.added.push_back(added);
    }
    const std::vector<Tet> four = replace_cells(mesh, put_in).cells;
    ASSERT_EQ(verify(mesh), "");
    replace_cells(mesh, {four, {{corners, Region(1)}}, {}, 0, 0});
    ASSERT_EQ(verify(mesh), "");
    ASSERT_FALSE(mesh.free_vertices.empty());
    std::swap(mesh.position[mesh.layers[0].columns[1]], mesh.position[mesh.free_vertices[0]]);
    mesh.layer_at[mesh.free_vertices[0]] =
        Layer(0);  // that column vertex takes the last slot, its own is free
    std::swap(mesh.layers[0].columns[1], mesh.free_vertices[0]);
    mesh.layer_at[mesh.free_vertices[0]] = Layer{};
    ASSERT_EQ(verify(mesh), "");
    const Compacted compacted = compact(mesh);
    EXPECT_EQ(verify(compacted.mesh), "");
    EXPECT_EQ(compacted.mesh.position.size(), mesh.position.size() - 1);
    const auto before = all_prisms(mesh), after = all_prisms(compacted.mesh);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(prism_corners(mesh, before[i]), prism_corners(compacted.mesh, after[i]));
}

}  // namespace
}  // namespace kropla
