#include "report/solids.h"

#include "tiny_run.h"

#include <gtest/gtest.h>

namespace kropla {
namespace {

TEST(Solids, HaveNoPressureWithin) {
    // Two bodies of two cubes a side, with a vertex in the middle of each: at (2, 2, 2) and at (5, 2, 2).
    const Mesh mesh = grid_of_cubes({7, 4, 4}, [](int i, int j, int k) {
        const bool beside = j == 1 || j == 2, inside = beside && (k == 1 || k == 2);
        return Region(!inside ? 0 : i == 1 || i == 2 ? 1 : i == 4 || i == 5 ? 2 : 0);
    });
    Array<Vertex, double> pressure(mesh.position.size(), 1.0);
    for (const Vertex v : pressure.indices())
        if (mesh.position[v] == Vec3{2, 2, 2}) pressure[v] = 0;
    EXPECT_EQ(solid_regions(mesh, pressure), (std::vector<bool>{false, true, false}));
}

}  // namespace
}  // namespace kropla
