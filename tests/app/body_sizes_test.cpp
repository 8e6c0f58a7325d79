#include "app/body_sizes.h"
#include "generate/domains.h"
#include <kropla/generate/generate.h>
#include "report/table.h"
#include "temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace kropla {
namespace {

/// A ball and an ellipsoid with prisms on both sides of its surface.
Domain two_bodies() {
    Domain domain = small_domain({ball({-1.2, -1.2, 2}, 1), turned_ellipsoid({0.5, 0.5, 5}, {1, 1.5, 1.2})});
    domain.bodies[1].layer = LayerOptions{3, 0.03, 1.3, LayerOptions::Side::both, {}};
    return domain;
}

TEST(BodySizes, AreThoseAskedForAndThoseOfTheMesh) {
    const Domain domain = two_bodies();
    const auto sizes = body_sizes(domain, generate_mesh(domain, 1));
    ASSERT_EQ(sizes.size(), 2u);
    EXPECT_EQ(sizes[1].name, "1");
    EXPECT_EQ(sizes[1].semi_axes, (Vec3{1, 1.5, 1.2}));
    EXPECT_NEAR(sizes[0].volume, 4 * std::numbers::pi / 3, 1e-14);
    EXPECT_NEAR(sizes[1].volume, 4 * std::numbers::pi / 3 * 1.8, 1e-14);
    for (std::size_t body = 0; body < 2; ++body) {
        const BodySize& s = sizes[body];
        const Surface wall =
            triangulate_surface(domain.bodies[body].shape, surface_size(snapshot(domain, 0), body), 1);
        EXPECT_NEAR(s.mesh_volume / s.volume, 1, 1e-12);
        EXPECT_EQ(s.triangles, static_cast<int>(wall.triangles.size()));  // by the area, for any seed
        EXPECT_NEAR(s.mean_edge / surface_size(snapshot(domain, 0), body), 1, 0.05);
    }
}

TEST(BodySizes, AreWrittenAsATableThatReadsBack) {
    const TemporaryFolder folder;
    const std::vector<BodySize> sizes = {{"a, \"left\"", {1, 2, 3}, 0.1, 0.1 + 1e-16, 44, 1.0 / 3},
                                         {"b", {1e-6, 2e-6, 3e-6}, 1e-17, 1e-17, 12, 1e-7}};
    const std::vector<BodyState> at_start = {{.place = {1, 2, 3}, .coldest = 300, .mean = 301, .hottest = 302}, {}};
    write_bodies(folder.path / "bodies.csv", sizes, at_start, true);
    const Table table = read_table(folder.path / "bodies.csv");
    EXPECT_EQ(numbers(table, "body"), (std::vector<double>{1, 2}));
    EXPECT_EQ(numbers(table, "semi_axis_3"), (std::vector<double>{3, 3e-6}));
    EXPECT_EQ(numbers(table, "mesh_volume"), (std::vector<double>{0.1 + 1e-16, 1e-17}));
    EXPECT_EQ(numbers(table, "triangles"), (std::vector<double>{44, 12}));
    EXPECT_EQ(numbers(table, "mean_edge"), (std::vector<double>{1.0 / 3, 1e-7}));
    EXPECT_EQ(table.columns[1].cells, (std::vector<std::string>{"a, \"left\"", "b"}));
    EXPECT_EQ(numbers(table, "z"), (std::vector<double>{3, 0}));
    EXPECT_EQ(numbers(table, "temperature_mean"), (std::vector<double>{301, 0}));
    write_bodies(folder.path / "bodies.csv", sizes, at_start, false);
    EXPECT_FALSE(has_column(read_table(folder.path / "bodies.csv"), "temperature_mean"));
}

TEST(BodySizes, AreSaidOfTheFirstFewBodies) {
    const BodySize one{"drop", {1e-3, 2e-3, 1e-3}, 8e-9, 8e-9, 722, 2e-4};
    EXPECT_EQ(describe({one}), "body \"drop\": semi-axes 0.001, 0.002, 0.001 m; volume 8e-09 m^3, the mesh's off by "
                               "0e+00 of it; 722 triangles of edge 0.0002 m\n");
    const std::string many = describe(std::vector<BodySize>(100, one));
    EXPECT_EQ(std::ranges::count(many, '\n'), 9);
    EXPECT_TRUE(many.ends_with("\nand 92 bodies more\n"));
}

}  // namespace
}  // namespace kropla
