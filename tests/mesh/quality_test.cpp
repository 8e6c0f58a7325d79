#include <kropla/mesh/quality.h>

#include "mesh/meshes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(AspectRatio, IsThreeForTheRegularTet) {
    EXPECT_NEAR(aspect_ratio(regular_tet(), Tet(0)), 3, 1e-14);
}

TEST(AspectRatio, OfTheCornerOfACube) {
    // R = sqrt(3)/2; r = 3 V / A = (1/2) / (3/2 + sqrt(3)/2)
    EXPECT_NEAR(aspect_ratio(one_tet(), Tet(0)), std::sqrt(3.0) / 2 * (3 + std::sqrt(3.0)), 1e-13);
}

TEST(AspectRatio, IsInfiniteForFlatAndTurnedTets) {
    Mesh mesh = one_tet();
    mesh.position[Vertex(3)] = {0.25, 0.25, 0};
    EXPECT_EQ(aspect_ratio(mesh, Tet(0)), infinity);
    mesh.position[Vertex(3)] = {0.25, 0.25, -1};
    EXPECT_EQ(aspect_ratio(mesh, Tet(0)), infinity);
}

TEST(Volume, OfTetsAndRegions) {
    EXPECT_DOUBLE_EQ(volume(one_tet(), Tet(0)), 1.0 / 6);
    EXPECT_DOUBLE_EQ(volume(regular_tet(), Tet(0)), 8.0 / 3);
    EXPECT_NEAR(region_volume(cube_in_cube(4), Region(1)), 1.0 / 8, 1e-15);
    EXPECT_NEAR(region_volume(cube_in_cube(4), surroundings), 7.0 / 8, 1e-14);
    EXPECT_EQ(region_volume(one_tet(), Region(1)), 0);
}

TEST(Centroid, IsTheMeanOfTheCorners) {
    EXPECT_EQ(centroid(one_tet(), Tet(0)), (Vec3{0.25, 0.25, 0.25}));
}

TEST(WorstAspectRatio, IsTheLargestOfThoseAsked) {
    Mesh mesh = two_tets();
    mesh.position[Vertex(4)] = {0, 0, -0.1};
    const std::vector<Tet> both = {Tet(0), Tet(1)}, first = {Tet(0)};
    EXPECT_EQ(worst_aspect_ratio(mesh, both), aspect_ratio(mesh, Tet(1)));
    EXPECT_EQ(worst_aspect_ratio(mesh, first), aspect_ratio(mesh, Tet(0)));
    EXPECT_EQ(worst_aspect_ratio(mesh, {}), 0);
}

TEST(Summary, OfTheRegularTet) {
    const auto summary = summarise_quality(regular_tet());
    EXPECT_EQ(summary.tets, 1);
    EXPECT_EQ(summary.vertices, 4);
    EXPECT_EQ(summary.worst, Tet(0));
    for (double ratio : {summary.max_aspect_ratio, summary.p999_aspect_ratio, summary.mean_aspect_ratio})
        EXPECT_NEAR(ratio, 3, 1e-14);
    const double angle = std::acos(1.0 / 3) * 180 / std::numbers::pi;  // 70.5 degrees
    EXPECT_NEAR(summary.min_dihedral, angle, 1e-12);
    EXPECT_NEAR(summary.max_dihedral, angle, 1e-12);
}

TEST(Summary, LeavesOutTheWorstThousandth) {
    Mesh mesh = cube_of_tets(7);  // 2058 tets: the worst two are beyond the 0.999 quantile
    const double regular = aspect_ratio(mesh, Tet(0));
    mesh.position[Vertex(7)].x -= 0.5 / 7;  // the corner (1, 0, 0), which two tets have
    const auto summary = summarise_quality(mesh);
    EXPECT_GT(summary.max_aspect_ratio, regular * 1.1);
    EXPECT_EQ(summary.max_aspect_ratio, aspect_ratio(mesh, summary.worst));
    EXPECT_NEAR(summary.p999_aspect_ratio, regular, 1e-10);
    EXPECT_NEAR(summary.mean_aspect_ratio, regular, 0.0031);
}

TEST(Summary, OfOneRegionSeesThatRegionOnly) {
    Mesh mesh = cube_in_cube(3);
    mesh.position[Vertex(0)] = {0.1, 0.1, 0.1};
    const auto whole = summarise_quality(mesh), body = summarise_quality(mesh, Region(1));
    EXPECT_EQ(whole.tets, 162);
    EXPECT_EQ(whole.vertices, 64);
    EXPECT_EQ(body.tets, 6);
    EXPECT_EQ(body.vertices, 8);
    EXPECT_GT(whole.max_aspect_ratio, body.max_aspect_ratio);
    EXPECT_NEAR(body.min_dihedral, 45, 1e-10);
    EXPECT_NEAR(body.max_dihedral, 90, 1e-10);
    EXPECT_EQ(mesh.region[body.worst], Region(1));
}

TEST(Summary, OfNothing) {
    const auto summary = summarise_quality(one_tet(), Region(1));
    EXPECT_EQ(summary.tets, 0);
    EXPECT_EQ(summary.vertices, 0);
    EXPECT_EQ(summary.max_aspect_ratio, 0);
    EXPECT_FALSE(summary.worst.exists());
}

}  // namespace
}  // namespace kropla
