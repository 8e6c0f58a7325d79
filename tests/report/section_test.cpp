#include "base/random.h"
#include "report/section.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

Mesh unit_cube() {
    return grid_of_cubes({1, 1, 1}, [](int, int, int) { return surroundings; });
}

double total_area(const std::vector<CutPolygon>& cut) {
    double sum = 0;
    for (const CutPolygon& polygon : cut) sum += area(polygon);
    return sum;
}

TEST(Section, OfACubeIsASquare) {
    const Mesh mesh = unit_cube();
    for (int axis = 0; axis < 3; ++axis) {
        const auto cut = cut_mesh(mesh, plane_across(axis, {0.3, 0.6, 0.45}));
        EXPECT_NEAR(total_area(cut), 1, 1e-14) << "axis " << axis;
        EXPECT_GT(cut.size(), 2U);
    }
}

TEST(Section, AcrossTheDiagonalIsAHexagon) {
    const double third = 1 / std::sqrt(3.0), half = 1 / std::sqrt(2.0);
    const Vec3 normal = {third, third, third}, right = {half, -half, 0};
    const auto cut = cut_mesh(unit_cube(), {{0.5, 0.5, 0.5}, right, cross(normal, right)});
    EXPECT_NEAR(total_area(cut), 3 * std::sqrt(3.0) / 4, 1e-14);
}

TEST(Section, CoversFacetsInThePlaneOnce) {
    const Mesh mesh = grid_of_cubes({2, 2, 2}, [](int, int, int) { return surroundings; });
    for (int axis = 0; axis < 3; ++axis) {
        EXPECT_DOUBLE_EQ(total_area(cut_mesh(mesh, plane_across(axis, {1, 1, 1}))), 4) << "axis " << axis;
    }
}

TEST(Section, MissesWhatThePlaneDoesNotReach) {
    EXPECT_TRUE(cut_mesh(unit_cube(), plane_across(1, {0, 1.5, 0})).empty());
    EXPECT_TRUE(cut_mesh(unit_cube(), plane_across(1, {0, -0.5, 0})).empty());
}

TEST(Section, KnowsTheRegions) {
    const Mesh mesh = grid_of_cubes({3, 1, 2}, [](int i, int, int) { return Region(i == 1 ? 1 : 0); });
    double body = 0, rest = 0;
    for (const CutPolygon& polygon : cut_mesh(mesh, plane_across(1, {0, 0.37, 0}))) {
        (mesh.region[polygon.tet] == Region(1) ? body : rest) += area(polygon);
    }
    EXPECT_NEAR(body, 2, 1e-14);
    EXPECT_NEAR(rest, 4, 1e-14);
}

TEST(Section, OfRandomPlanesGivesLinearFieldsExactlyAndConvexPolygons) {
    const Mesh mesh = grid_of_cubes({3, 3, 3}, [](int, int, int) { return surroundings; });
    Array<Vertex, double> field(mesh.position.size());
    for (const Vertex v : mesh.position.indices()) field[v] = 2 + dot(mesh.position[v], {3, -1, 0.5});
    Random random{.seed = 7};
    std::size_t quads = 0, triangles = 0;
    for (int plane = 0; plane < 100; ++plane) {
        SCOPED_TRACE("seed 7, plane " + std::to_string(plane));
        const Vec3 right = normalised({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
        const Vec3 up = normalised(cross({random.uniform(-1, 1), 1, random.uniform(-1, 1)}, right));
        const Vec3 origin = {random.uniform(0, 3), random.uniform(0, 3), random.uniform(0, 3)};
        for (const CutPolygon& polygon : cut_mesh(mesh, {origin, right, up})) {
            (polygon.size == 4 ? quads : triangles) += 1;
            EXPECT_GT(area(polygon), 0);
            for (const CutCorner& corner : corners(polygon)) {
                const Vec3 place = origin + corner.place.x * right + corner.place.y * up;
                EXPECT_NEAR(value_at(corner, field), 2 + dot(place, {3, -1, 0.5}), 1e-12);
            }
        }
    }
    EXPECT_GT(quads, 1000U);
    EXPECT_GT(triangles, 1000U);
}

}  // namespace
}  // namespace kropla
