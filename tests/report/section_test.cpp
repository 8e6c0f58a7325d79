#include "../io/layered.h"
#include "base/random.h"
#include "report/section.h"
#include "tiny_run.h"

#include <gtest/gtest.h>

#include <algorithm>
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
        (polygon.region == Region(1) ? body : rest) += area(polygon);
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

// Tets and prisms together cover the section of the cube, also where the quads of the prisms are bent; no overlap
// and no gap, as all neighbours share their corners.
TEST(Section, OfLayersCoversTheSquareOnce) {
    for (const double bend : {0.0, 0.01e-3}) {
        Mesh mesh = layered_cube(4, {3, 2});
        Random random{.seed = 11};
        for (const PrismLayer& layer : mesh.layers)
            for (const Vertex v : layer.columns)
                for (int axis = 0; axis < 3; ++axis) mesh.position[v][axis] += random.uniform(-bend, bend);
        for (const double at : {1.3e-3, 2e-3, 2.71e-3}) {
            SCOPED_TRACE("seed 11, bent by " + std::to_string(bend * 1e3) + " mm, at " + std::to_string(at * 1e3));
            const auto cut = cut_mesh(mesh, plane_across(2, {0, 0, at}));
            EXPECT_NEAR(total_area(cut), 16e-6, 1e-18);
            EXPECT_GT(std::ranges::count_if(cut, &CutPolygon::of_prism), 20);
        }
    }
}

TEST(Section, OfAPrismIsItsTriangleOrItsQuad) {
    const Mesh mesh = layered_cube(4, {1, 0});
    const Vec3 x = mesh.position[column_vertex(mesh.layers[0], 0, 0)];
    std::size_t triangles = 0, quads = 0;
    for (const CutPolygon& polygon : cut_mesh(mesh, plane_across(0, x))) {
        if (!polygon.of_prism) continue;
        EXPECT_EQ(polygon.region, surroundings);
        (polygon.size == 3 ? triangles : quads) += 1;
        for (const CutCorner& corner : corners(polygon)) EXPECT_LT(corner.a, corner.b);
    }
    EXPECT_GT(triangles, 0U);
    EXPECT_GT(quads, 0U);
}

}  // namespace
}  // namespace kropla
