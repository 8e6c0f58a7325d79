// Meshes from elsewhere, with bodies of any shape.
#include "adapt/cases.h"
#include "adapt/stepping.h"
#include <kropla/base/error.h>
#include <kropla/domain/of_mesh.h>
#include "domain/paths.h"
#include "domain/triangulated_surface.h"
#include <kropla/generate/generate.h>
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

/// A cylinder of radius 1 and height 2.5 about z, of 10 x 10 squares by 10 layers, six tets each; a cube of side 0.5
/// about (0, 0, 1.75) is region 1. Patches 4 and 5 are the ends, 6 the wall.
Mesh cube_in_a_cylinder() {
    constexpr int cube = 1, rings = 4, layers = 10, width = 2 * rings + 1, up = width * width;
    constexpr double half = 0.25, height = 0.25;
    Array<Vertex, Vec3> position;
    for (int n = 0; n < up * (layers + 1); ++n) {
        const int i = n % width - rings, j = n / width % width - rings, ring = std::max({std::abs(i), std::abs(j), 1});
        const double x = static_cast<double>(i) / ring, y = static_cast<double>(j) / ring;
        const double out = static_cast<double>(ring - cube) / (rings - cube), far = std::max(std::hypot(x, y), 0.5);
        const double factor = (1 - out) * half + out / far;
        position.push_back({factor * x, factor * y, height * (n / up)});
    }
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, Region> region;
    for (int n = 0; n < up * layers; ++n) {
        const int i = n % width - rings, j = n / width % width - rings, k = n / up;
        if (i == rings || j == rings) continue;
        const bool in_cube = std::max({-i, i + 1, -j, j + 1}) <= cube && (k == 6 || k == 7);
        const bool rises = (i < 0) == (j < 0);  // the diagonal that points at the axis
        const std::array<std::array<int, 3>, 2> halves = {{{n, n + 1, rises ? n + width + 1 : n + width},
                                                          {rises ? n : n + 1, n + width, n + width + 1}}};
        for (const auto& [p, q, r] : halves)
            for (auto [a, b, c, d] : {std::array{p, q, r, r + up}, {p, q, q + up, r + up}, {p, p + up, q + up, r + up}}) {
                const Vec3 &o = position[Vertex(a)], &x = position[Vertex(b)], &y = position[Vertex(c)];
                if (determinant(x - o, y - o, position[Vertex(d)] - o) < 0) std::swap(a, b);
                tets.push_back({Vertex(a), Vertex(b), Vertex(c), Vertex(d)});
                region.push_back(in_cube ? Region(1) : surroundings);
            }
    }
    std::vector<BoundaryFacet> boundary;
    const Mesh bare = make_mesh(position, tets, region);
    for (Tet t : bare.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            if (bare.neighbour[t][static_cast<std::size_t>(corner)].exists()) continue;
            const auto v = facet_vertices(bare, {t, corner});
            const auto all_at = [&](double z) {
                return position[v[0]].z == z && position[v[1]].z == z && position[v[2]].z == z;
            };
            boundary.push_back({v, Patch(all_at(0) ? 4 : all_at(height * layers) ? 5 : 6)});
        }
    return make_mesh(position, tets, region, boundary);
}

Domain domain_with_cube(const Mesh& mesh, Motion motion) {
    Domain domain = domain_of(mesh, {.surface = 0.25, .growth = 0.2, .far = 0.4});
    domain.bodies.push_back({"cube", shape_of_region(mesh, Region(1)), std::move(motion)});
    return domain;
}

std::string message_of(const auto& deed) {
    try {
        deed();
    } catch (const DomainError& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST(OwnMesh, TellsTheShapesOfItsRegionsAndItsWalls) {
    const Mesh mesh = cube_in_a_cylinder();
    ASSERT_EQ(verify(mesh), "");
    const Domain domain = domain_with_cube(mesh, [](double) { return Pose{}; });
    const Shape& cube = domain.bodies[0].shape;
    EXPECT_NEAR(distance(cube.centre, {0, 0, 1.75}), 0, 1e-14);
    EXPECT_NEAR(volume(cube), 0.125, 1e-15);
    EXPECT_NEAR(distance(cube.semi_axes, {0.25, 0.25, 0.25}), 0, 1e-15);
    EXPECT_EQ(domain.box.min, (Vec3{-1, -1, 0}));
    EXPECT_EQ(domain.box.max.z, 2.5);
    ASSERT_TRUE(domain.walls);
    EXPECT_EQ(domain.walls->triangles().size(), 4u * 8 * 10 * 2);
    const double half_a_facet = (std::atan2(4, 3) - std::atan2(1, 1)) / 2;  // [rad], beside the diagonal
    EXPECT_NEAR(gap_between(cube, *domain.walls), (1 - 0.25 * std::sqrt(2.0)) * std::cos(half_a_facet), 1e-14);
    EXPECT_EQ(message_of([&] { (void)shape_of_region(mesh, Region(2)); }), "the mesh has no region 2");
    EXPECT_NE(message_of([&] { (void)shape_of_region(mesh, surroundings); }).find("reaches the boundary"),
              std::string::npos);
    Mesh bent = mesh;
    rename_patch(bent, Patch(6), Patch(0));
    EXPECT_NE(message_of([&] { (void)domain_of(bent, {}); }).find("not in the wall x min"), std::string::npos);
}

TEST(OwnMesh, TellsTheShapeOfALayeredBodyByItsWall) {
    for (const auto side : {LayerOptions::Side::outside, LayerOptions::Side::both}) {
        Domain domain = sphere_in_box();
        domain.bodies[0].layer = LayerOptions{.count = 2, .first_height = 0.02, .growth = 1.5, .side = side};
        const Mesh mesh = generate_mesh(domain, 1);
        const Shape shape = shape_of_region(mesh, Region(1));
        EXPECT_NEAR(volume(shape) / volume(domain.bodies[0].shape), 1, 1e-12);
        EXPECT_FALSE(domain_of(mesh, domain.size).walls);
    }
}

TEST(OwnMesh, ACubeMovesInACylinder) {
    Mesh mesh = cube_in_a_cylinder();
    const Domain domain = domain_with_cube(mesh, [](double t) {
        return Pose{{0.1 * t, 0, -t}, rotation_about({1, 2, 2}, 0.5 * t)};
    });
    improve(mesh, all_tets(mesh), snapshot(domain, 0));
    const Properties start = properties(mesh);
    MovingMesh moving(domain, std::move(mesh), 0);
    for (int step = 1; step <= 10; ++step) {
        step_to(moving, step / 10.0);
        const Mesh& now = moving.reference();
        ASSERT_EQ(verify(now), "") << "step " << step;
        EXPECT_LE(worst_of(now), AdaptOptions{}.floor);
        EXPECT_TRUE(same_shape(properties(now), start));  // volumes of regions to 1e-12
        const Shape cube = shape_at(domain.bodies[0], moving.time());
        for (Vertex v : all_vertices(now)) {
            if (!on_interface(now, v)) continue;
            EXPECT_NEAR(signed_distance(cube, now.position[v]), 0, 1e-14);
        }
    }
}

TEST(OwnMesh, ABodyOnItsWayIntoAFixedWallIsRefusedInWords) {
    Mesh mesh = cube_in_a_cylinder();
    const Domain domain = domain_with_cube(mesh, [](double t) { return Pose{{t, 0, 0}, {}}; });
    EXPECT_NEAR(surface_limit(domain, 0.4, 0.25).most, 4 * (1 - std::hypot(0.65, 0.25)), 0.2);
    EXPECT_NE(surface_limit(domain, 0.4, 0.25).why.find("from the fixed walls, too close"), std::string::npos);
    EXPECT_NE(message_of([&] { check_placement(domain, 0.72, 0.25); }).find("touches the fixed walls"), std::string::npos);
    const auto look = [&](double end) { return look_at_paths(domain, {.start = 0, .end = end, .steps = 10, .near = 0.3}); };
    const PathLook seen = look(0.6);
    ASSERT_EQ(seen.closest.size(), 2u);  // to the box, and nearer to the wall within it
    EXPECT_EQ(seen.closest[0].wall, fixed_walls);
    EXPECT_NEAR(seen.closest[0].gap, 1 - std::hypot(0.85, 0.25), 0.02);  // which has corners
    EXPECT_NE(message_of([&] { (void)look(0.75); }).find("motion takes it into the fixed walls at t = 7"), std::string::npos);
    MovingMesh moving(domain, std::move(mesh), 0, {.clusters = false, .largest_ring = 2, .whole_region = false});
    try {
        for (int step = 1; step <= 5; ++step) step_to(moving, 0.15 * step);
        ADD_FAILURE() << "it went through the wall";
    } catch (const FloorError& error) {
        EXPECT_NE(std::string(error.what()).find("from the fixed walls"), std::string::npos) << error.what();
    }
    EXPECT_GT(moving.time(), 0.3);
    EXPECT_EQ(verify(moving.reference()), "");
}

}  // namespace kropla
