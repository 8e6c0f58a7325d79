#include <kropla/base/error.h>
#include "generate/box.h"
#include "generate/domains.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

using namespace kropla;

namespace {

double box_volume(const Box& box) {
    const Vec3 width = box.max - box.min;
    return width.x * width.y * width.z;
}

/// The volume that the interface of `region` encloses, seen from `about`.
double enclosed_volume(const Mesh& mesh, Region region, const Vec3& about) {
    double sum = 0;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) {
            const Tet next = mesh.neighbour[t][static_cast<std::size_t>(i)];
            if (mesh.region[t] != region || (next.exists() && mesh.region[next] == region)) continue;
            const auto [a, b, c] = facet_vertices(mesh, {t, i});
            sum +=
                determinant(mesh.position[a] - about, mesh.position[b] - about, mesh.position[c] - about) / 6;
        }
    return sum;
}

/// The vertices of the tets of `region` that also have a tet of another.
std::set<Vertex> interface_vertices(const Mesh& mesh, Region region) {
    std::set<Vertex> found;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) {
            const Tet next = mesh.neighbour[t][static_cast<std::size_t>(i)];
            if (mesh.region[t] != region || !next.exists() || mesh.region[next] == region) continue;
            for (Vertex v : facet_vertices(mesh, {t, i})) found.insert(v);
        }
    return found;
}

/// Everything that any initial mesh must be.
void expect_initial_mesh(const Domain& domain, const Mesh& mesh) {
    EXPECT_EQ(verify(mesh), "");
    double total = 0;
    for (std::size_t body = 0; body <= domain.bodies.size(); ++body)
        total += region_volume(mesh, Region(body));
    EXPECT_NEAR(total / box_volume(domain.box), 1, 1e-12);
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        const Shape shape = shape_at(domain.bodies[body], 0);
        const Region region = region_of_body(body);
        const double volume = region_volume(mesh, region);
        EXPECT_NEAR(enclosed_volume(mesh, region, shape.centre) / volume, 1, 1e-12);
        const Vec3& a = shape.semi_axes;
        EXPECT_NEAR(volume / (4 * std::numbers::pi / 3 * a.x * a.y * a.z), 1, 1e-12);
        const std::set<Vertex> on_surface = interface_vertices(mesh, region);
        ASSERT_FALSE(on_surface.empty());
        const Shape larger = through(shape, mesh.position[*on_surface.begin()]);
        for (Vertex v : on_surface) {
            EXPECT_NEAR(signed_distance(larger, mesh.position[v]) / a.x, 0, 1e-12);
            EXPECT_GT(signed_distance(shape, mesh.position[v]), 0);
            EXPECT_LT(signed_distance(shape, mesh.position[v]), outward_shift(shape, domain.size.surface));
        }
    }
    for (Tet t : mesh.tets.indices())
        for (std::size_t i = 0; i < 4; ++i) {
            if (mesh.neighbour[t][i].exists()) continue;
            for (Vertex v : facet_vertices(mesh, {t, static_cast<int>(i)}))
                EXPECT_TRUE(lies_on_face(domain.box, mesh.patch[t][i], mesh.position[v]));
        }
}

double share_of_bad_tets(const Mesh& mesh) {
    int bad = 0;
    for (Tet t : mesh.tets.indices()) bad += aspect_ratio(mesh, t) > 10;
    return static_cast<double>(bad) / count_tets(mesh);
}

}  // namespace

TEST(InitialMesh, OfAnEmptyBox) {
    const Domain domain = small_domain({});
    expect_initial_mesh(domain, generate_mesh(domain, 1));
}

TEST(InitialMesh, OfOneBodyIsOfTheSizeAskedAndNearlyGood) {
    const Domain domain = small_domain({ball({0, 0, 5}, 1.2)});
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = generate_mesh(domain, seed);
        expect_initial_mesh(domain, mesh);
        EXPECT_LT(share_of_bad_tets(mesh), 0.0042);  // 0.4 % seen
        const Snapshot at = snapshot(domain, 0);
        double sum = 0;
        for (Tet t : mesh.tets.indices())
            for (const auto& [i, k] : tet_edges) {
                const Vec3 a = mesh.position[mesh.tets[t][static_cast<std::size_t>(i)]];
                const Vec3 b = mesh.position[mesh.tets[t][static_cast<std::size_t>(k)]];
                sum += distance(a, b) / target_size(at, 0.5 * (a + b));
            }
        EXPECT_NEAR(sum / (6 * count_tets(mesh)), 1, 0.0098);
    }
}

TEST(InitialMesh, OfSeveralBodies) {
    const Domain domain =
        small_domain({ball({-1.2, -1.2, 2}, 1), turned_ellipsoid({0.5, 0.5, 5}, {1, 1.5, 1.2}),
                      ball({1.8, -1.8, 1.2}, 0.6), ball({2, 2, 2}, 0.5)});
    expect_initial_mesh(domain, generate_mesh(domain, 1));
}

TEST(InitialMesh, OfALongThinBody) {
    Domain domain = small_domain({turned_ellipsoid({0, 0, 4}, {0.5, 1.6, 0.7})});
    domain.size = {0.15, 0.4, 0.9};
    expect_initial_mesh(domain, generate_mesh(domain, 1));
}

TEST(InitialMesh, RefinesSurfacesThatAreAsCloseAsIsAllowed) {
    const Shape large = ball({0, 0, 0}, 1), small = ball({0, 0, 0}, 0.6);
    const double size = 0.4, out = outward_shift(large, size), small_out = outward_shift(small, size);
    const double gap = 0.251 * size + out, between = gap + small_out;
    const Domain domain = small_domain({ball({-2 + gap, -2 + gap, 1 + gap}, 1),  // in a corner of the box
                                        ball({-2 + gap, -2 + gap, 2 + gap + between + 0.6}, 0.6)});
    int refined = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = generate_mesh(domain, seed);
        expect_initial_mesh(domain, mesh);
        const PointSet sampled = sample_points(snapshot(domain, 0), seed);
        for (std::size_t body = 0; body < 2; ++body)
            refined +=
                interface_vertices(mesh, region_of_body(body)).size() > sampled.surfaces[body].points.size();
    }
    EXPECT_GT(refined, 0);
}

TEST(InitialMesh, OfSizesThatDifferFiftyfold) {
    Domain domain = small_domain({ball({1, 0, 4}, 0.1)});
    domain.size = {0.02, 0.3, 1};
    expect_initial_mesh(domain, generate_mesh(domain, 1));
}

TEST(InitialMesh, OfTheCoarsestSizeThatABodyAllows) {
    Domain domain = small_domain({ball({0, 0, 4}, 0.9)});
    domain.size = {0.9, 0, 0.9};
    expect_initial_mesh(domain, generate_mesh(domain, 1));
}

TEST(InitialMesh, FromMicrometresToKilometresAndFarFromTheOrigin) {
    for (double scale : {1e-6, 1e3}) {
        const Domain domain = scaled(small_domain({ball({0, 0, 5}, 1.2)}), scale);
        expect_initial_mesh(domain, generate_mesh(domain, 1));
    }
    Domain far = small_domain({ball({0, 0, 5}, 1.2)});
    for (Vec3* x : {&far.box.min, &far.box.max, &far.bodies[0].shape.centre}) *x += Vec3{128, -256, 512};
    expect_initial_mesh(far, generate_mesh(far, 1));
}

TEST(InitialMesh, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const Domain domain = small_domain({ball({0, 0, 5}, 1.2)});
    const Mesh mesh = generate_mesh(domain, 1);
    EXPECT_TRUE(mesh == generate_mesh(domain, 1));
    EXPECT_FALSE(mesh == generate_mesh(domain, 2));
}

TEST(InitialMesh, RefusesBodiesThatDoNotFit) {
    EXPECT_THROW((void)generate_mesh(small_domain({ball({0, 0, 1}, 1.2)}), 1), DomainError);
    EXPECT_THROW((void)generate_mesh(small_domain({ball({0, 0, 2}, 1), ball({0, 0, 4.1}, 1)}), 1),
                 DomainError);
    EXPECT_THROW((void)generate_mesh(small_domain({ball({0, 0, 4}, 0.39)}), 1), DomainError);  // too coarse
}

namespace {

/// The mean of how far apart in memory two cells are that share a facet.
double mean_distance_of_neighbours(const Mesh& mesh) {
    double sum = 0, count = 0;
    for (Tet t : all_tets(mesh))
        for (Tet n : mesh.neighbour[t])
            if (n.exists()) {
                sum += std::abs(n.value - t.value);
                ++count;
            }
    return sum / count;
}

}  // namespace

TEST(InSpatialOrder, IsTheSameMeshWithNeighboursNearInMemory) {
    const Mesh mesh = generate_mesh(small_domain({ball({0, 0, 4}, 1)}), 1);
    const Mesh ordered = in_spatial_order(mesh);
    EXPECT_EQ(verify(ordered), "");
    EXPECT_EQ(count_tets(ordered), count_tets(mesh));
    EXPECT_EQ(count_vertices(ordered), count_vertices(mesh));
    for (Region region : {surroundings, Region(1)})
        EXPECT_NEAR(region_volume(ordered, region), region_volume(mesh, region), 1e-12 * region_volume(mesh, region));
    EXPECT_LT(mean_distance_of_neighbours(ordered), 0.253 * mean_distance_of_neighbours(compact(mesh).mesh));
    EXPECT_EQ(in_spatial_order(ordered), ordered);
}
