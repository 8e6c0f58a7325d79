#include "base/random.h"
#include "meshes.h"
#include <kropla/mesh/prisms.h>
#include "simulate/carried.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kropla {
namespace {

Vec3 turned_and_shifted(const Vec3& x) {
    const double c = std::cos(0.7), s = std::sin(0.7);
    return {c * x.x - s * x.y + 3, s * x.x + c * x.y - 2, x.z + 1};
}

TEST(Carried, FindsTheRigidMotionFromTheInterface) {
    const Mesh before = unit_cube_with_body(8);
    Mesh current = before;
    const auto of_gas = vertices_of(before, surroundings), of_body = vertices_of(before, Region(1));
    Random random{21};
    for (Vertex v : current.position.indices()) {
        current.position[v] = turned_and_shifted(before.position[v]);
        const bool shaken = !of_gas[v] && v.value % 2 == 0;
        if (shaken) current.position[v] += 0.03 * Vec3{random.uniform(), random.uniform(), random.uniform()};
    }
    const Array<Vertex, Vec3> carried = carried_along(before, current, Region(1));
    int apart = 0;
    for (Vertex v : carried.indices()) {
        if (!of_body[v]) continue;
        EXPECT_LT(distance(carried[v], turned_and_shifted(before.position[v])), 1e-14) << "seed 21";
        apart += carried[v] != current.position[v];
    }
    EXPECT_GT(apart, 11);   // of the 27 inside
    EXPECT_LT(apart, 22);  // those that were not shaken are at their places, bit for bit
}

TEST(Carried, TakesTheLayerInsideTheBodyAlong) {
    const Mesh before = with_layer(unit_cube_with_body(4), {0.5, 0.5, 0.5}, Region(1), 2, 0.3);
    Mesh current = before;
    for (Vec3& x : current.position) x = turned_and_shifted(x);
    const PrismLayer& layer = before.layers[0];
    for (int column = 0; column < count_columns(layer); ++column)  // squeezed to its wall
        for (int k = 1; k <= layer.count; ++k) {
            Vec3& x = current.position[column_vertex(layer, column, k)];
            x += 0.2 * (current.position[column_vertex(layer, column, 0)] - x);
        }
    const Array<Vertex, Vec3> carried = carried_along(before, current, Region(1));
    for (Vertex v : layer.columns)
        EXPECT_LT(distance(carried[v], turned_and_shifted(before.position[v])), 1e-14);
}

TEST(Carried, ABodyWithoutInterfaceStays) {
    const Mesh before = unit_cube(2);
    Mesh current = before;
    for (Vec3& x : current.position) x = turned_and_shifted(x);
    EXPECT_EQ(carried_along(before, current, Region(0)), before.position);
}

}  // namespace
}  // namespace kropla
