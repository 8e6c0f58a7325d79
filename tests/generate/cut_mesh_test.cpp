// Meshes of bodies that reach through faces of the box.
#include "domain/surfaces.h"
#include <kropla/domain/solids.h>
#include <kropla/generate/generate.h>
#include "generate/resample.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>
#include "mesh/crossing.h"
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

using namespace kropla;

namespace {

const Box box = {{-2, -2, 0}, {2, 2, 3}};

Domain domain_with(std::initializer_list<Shape> shapes, double size) {
    Domain domain{box, {}, {size, 0.3, 0.8}};
    for (const Shape& shape : shapes) {
        Body body{"body " + std::to_string(domain.bodies.size()), shape};
        domain.bodies.push_back(body);
    }
    return domain;
}

Shape ball_at(const Vec3& centre, double radius, int levels) {
    Triangles t = sphere_of_triangles(levels);
    for (Vec3& x : t.points) x *= radius;
    return cut_by(box, shape_within(make_surface(t.points, t.triangles), centre));
}

/// What facets between the region and others bound in the box.
double volume_within_facets(const Mesh& mesh, Region region) {
    std::vector<Vec3> points(mesh.position.begin(), mesh.position.end());
    std::vector<std::array<int, 3>> triangles;
    for (Tet t : all_tets(mesh, region))
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = mesh.neighbour[t][as_size(corner)]; n.exists() && mesh.region[n] != region) {
                const auto [a, b, c] = facet_vertices(mesh, {t, corner});
                triangles.push_back({a.value, b.value, c.value});
            }
    const Bounds within{box.min, box.max};
    return volume(shape_of_facets(points, triangles, &within));
}

void expect_mesh(const Domain& domain, std::initializer_list<double> volumes, double inscribed) {
    const Mesh mesh = generate_mesh(domain, 1);
    EXPECT_EQ(verify(mesh), "");
    double all = region_volume(mesh, surroundings);
    Region region(1);
    for (double volume : volumes) {
        const double found = region_volume(mesh, region);
        EXPECT_NEAR(found / volume, 1, inscribed);
        EXPECT_NEAR(volume_within_facets(mesh, region) / found, 1, 1e-12);
        all += found;
        ++region.value;
    }
    EXPECT_NEAR(all / 48, 1, 1e-12);
}

}  // namespace

TEST(CutMesh, Slab) {
    expect_mesh(domain_with({slab(box, {-9, -9, -9}, {9, 9, 1.1})}, 0.4), {17.6}, 1e-12);
    expect_mesh(domain_with({slab(box, {-1, -9, -1}, {0.7, 0.5, 1.1})}, 0.3), {1.7 * 2.5 * 1.1}, 1e-12);
}

TEST(CutMesh, CylinderThroughTheTop) {
    expect_mesh(domain_with({cylinder(box, {0.3, 0.1, 1.7}, {0.3, 0.1, 3}, 0.4)}, 0.2), {0.65345}, 0.042);
    expect_mesh(domain_with({cylinder(box, {0.3, 0.1, 1.2}, {0.8, 0.1, 3}, 0.4)}, 0.2), {0.939}, 0.042);
    expect_mesh(domain_with({cylinder(box, {-5, 0.1, 1.2}, {5, 0.1, 1.2}, 0.4)}, 0.2), {2.0106}, 0.042);
}

TEST(CutMesh, SurfaceCutByAFaceAnEdgeAndACorner) {
    expect_mesh(domain_with({ball_at({0, 0, 0.3}, 1, 4)}, 0.25), {2.986}, 0.027);
    expect_mesh(domain_with({ball_at({0, 0, 0}, 1, 4)}, 0.25), {2.09}, 0.027);
    expect_mesh(domain_with({ball_at({2, 0, 0}, 1, 4)}, 0.25), {1.045}, 0.027);
    expect_mesh(domain_with({ball_at({2, 2, 0}, 1, 4)}, 0.25), {0.5225}, 0.027);
}

// One cell thick: points of the face stand right under those of the surface.
TEST(CutMesh, FilmsOnTheFloor) {
    for (const double thickness : {0.3, 0.2, 0.12})
        for (std::uint64_t seed = 1; seed <= 2; ++seed) {
            SCOPED_TRACE(std::to_string(thickness) + " m thick, seed " + std::to_string(seed));
            const Domain domain = domain_with({slab(box, {-9, -9, -9}, {0.9, 0.4, thickness})}, 0.5);
            const Mesh mesh = initial_mesh(domain, seed);
            EXPECT_NEAR(region_volume(mesh, Region(1)) / (2.9 * 2.4 * thickness), 1, 1e-12);
            EXPECT_LT(summarise_quality(mesh).max_aspect_ratio, 5.85);
        }
}

TEST(CutMesh, DropletBetweenPoolAndWire) {
    const Shape droplet{{0, 0, 1.75}, {0.4, 0.4, 0.4}, {}};
    expect_mesh(domain_with({slab(box, {-9, -9, -9}, {9, 9, 1}), droplet, cylinder(box, {0, 0, 2.4}, {0, 0, 3}, 0.3)}, 0.2),
                {16, 0.26808, 0.16965}, 0.082);
}
