// Surfaces of triangles, sampled anew and meshed.
#include <kropla/adapt/moving_mesh.h>
#include "base/random.h"
#include "domain/surfaces.h"
#include "generate/creases.h"
#include <kropla/generate/generate.h>
#include "generate/resample.h"
#include "generate/sheet.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace kropla;

namespace {

Shape shape_of(const Triangles& t, const Vec3& centre = {}, const Rotation& turned = {}) {
    return shape_within(make_surface(t.points, t.triangles), centre, turned);
}

/// Two blocks that make an L of volume 3, in the plane z; its flat sides are of long triangles.
Triangles l_block() {
    const std::vector<Vec3> corners = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
    Triangles t;
    for (double z : {0.0, 1.0})
        for (Vec3 x : corners) t.points.push_back({x.x, x.y, z});
    for (auto [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}}) {
        t.triangles.push_back({a, c, b});
        t.triangles.push_back({a + 6, b + 6, c + 6});
    }
    for (int i = 0; i < 6; ++i) {
        const int j = (i + 1) % 6;
        t.triangles.push_back({i, j, j + 6});
        t.triangles.push_back({i, j + 6, i + 6});
    }
    return t;
}

Triangles torus(double large, double small, int around, int across) {
    Triangles t;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double a = 2 * std::numbers::pi * i / around, b = 2 * std::numbers::pi * j / across;
            const double r = large + small * std::cos(b);
            t.points.push_back({r * std::cos(a), r * std::sin(a), small * std::sin(b)});
            const auto at = [&](int k, int l) { return k % around * across + l % across; };
            t.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            t.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return t;
}

/// [degrees]
double least_angle(const Surface& s) {
    double least = 180;
    for (const auto& triangle : s.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto at = [&](std::size_t k) { return s.points[static_cast<std::size_t>(triangle[k % 3])]; };
            const Vec3 u = at(i + 1) - at(i), v = at(i + 2) - at(i);
            least = std::min(least, std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi);
        }
    return least;
}

int euler(const Surface& s) { return static_cast<int>(s.points.size()) - static_cast<int>(s.triangles.size()) / 2; }

Domain domain_with(Shape shape, double size) {
    Domain domain{{{-3, -3, -3}, {3, 3, 3}}, {}, {size, 0.3, 1}};
    domain.bodies.push_back({"body", std::move(shape)});
    return domain;
}

void expect_mesh(const Domain& domain, double volume) {
    const Mesh mesh = generate_mesh(domain, 1);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_NEAR(region_volume(mesh, Region(1)) / volume, 1, 1e-12);
    EXPECT_NEAR((region_volume(mesh, surroundings) + volume) / 216, 1, 1e-12);
}

}  // namespace

TEST(Sheet, IsTheSameSurfaceAfterAThousandOperations) {
    constexpr std::uint64_t seed = 3;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    const Triangles t = l_block();
    Sheet sheet = sheet_of(make_surface(t.points, t.triangles));
    int splits = 0, flips = 0, collapses = 0;
    for (int i = 0; i < 1000; ++i) {
        const Half h(random.below(sheet.origin.size()));
        if (!sheet.alive(h)) continue;
        const double what = random.uniform();
        if (what < 0.3) {
            split_edge(sheet, h, 0.5 * (sheet.place[sheet.origin[h]] + sheet.place[sheet.target(h)]));
            ++splits;
        } else if (what < 0.6 && may_flip(sheet, h)) {
            flip_edge(sheet, h);
            ++flips;
        } else if (what > 0.6 && may_collapse(sheet, h, 3)) {
            collapse_edge(sheet, h);
            ++collapses;
        }
        const Surface now = surface_of(sheet);
        ASSERT_NO_THROW((void)make_surface(now.points, now.triangles)) << i;
        ASSERT_NEAR(enclosed_volume(now, {}), 3, 1e-13) << i;
        ASSERT_EQ(euler(now), 2);
    }
    EXPECT_GT(splits, 100);
    EXPECT_GT(flips, 50);
    EXPECT_GT(collapses, 50);
}

TEST(Resampled, FlatFacesKeepVolumeEdgesAndCorners) {
    for (double size : {0.5, 0.2}) {
        const Shape shape = shape_of(l_block(), {0.3, -1, -0.5}, rotation_about({1, 2, 3}, 0.7));
        const Surface s = resampled(shape, {size});
        EXPECT_NEAR(enclosed_volume(s, shape.centre), 3, 1e-13);
        for (const Vec3& x : s.points) EXPECT_NEAR(signed_distance(shape, x), 0, 1e-14);
        double length = 0;
        for (const auto& [a, b] : s.creases)
            length += distance(s.points[static_cast<std::size_t>(a)], s.points[static_cast<std::size_t>(b)]);
        EXPECT_NEAR(length, 22, 1e-12);
        EXPECT_GT(least_angle(s), 25);
        EXPECT_EQ(euler(s), 2);
    }
}

TEST(Resampled, HasTheSizeOfEachPlace) {
    const Vec3 centre{0.3, -1, -0.5};
    const auto local = [&](const Vec3& x) { return 0.06 + 0.05 * norm(x - centre); };
    const Shape shape = shape_of(l_block(), centre, rotation_about({1, 2, 3}, 0.7));
    const Surface s = resampled(shape, {0.2, local});
    EXPECT_NEAR(enclosed_volume(s, shape.centre), 3, 1e-13);
    EXPECT_GT(least_angle(s), 25);
    double least = 1e300, most = 0;
    for (const auto& t : s.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 &a = s.points[static_cast<std::size_t>(t[i])], &b = s.points[static_cast<std::size_t>(t[(i + 1) % 3])];
            const double part = distance(a, b) / local(0.5 * (a + b));
            least = std::min(least, part);
            most = std::max(most, part);
        }
    EXPECT_GT(least, 0.45);
    EXPECT_LT(most, 1.6);
}

TEST(Resampled, SmoothSurfacesFineOrCoarseBecomeWellShapedTriangles) {
    const Shape ring = shape_of(torus(1, 0.4, 60, 30)), ball = shape_of(sphere_of_triangles(5)), few = shape_of(sphere_of_triangles(2));
    for (const auto& [shape, size, holes] : {std::tuple{ring, 0.15, 1}, {ball, 0.3, 0}, {few, 0.1, 0}}) {
        const Surface s = resampled(shape, {size});
        EXPECT_EQ(euler(s), holes == 1 ? 0 : 2);
        EXPECT_TRUE(s.creases.empty());
        for (const Vec3& x : s.points) EXPECT_NEAR(signed_distance(shape, x), 0, 1e-14);
        EXPECT_GT(least_angle(s), 27);
        EXPECT_NEAR(std::sqrt(shape.surface->area() / (std::sqrt(0.75) * static_cast<double>(s.points.size()))) / size, 1, 0.112);
    }
}

/// One row of long triangles, as CAD writes a wire, about z.
Triangles wire(double radius, double half_length, int around) {
    Triangles t;
    for (double z : {-half_length, half_length})
        for (int i = 0; i < around; ++i) {
            const double a = 2 * std::numbers::pi * i / around;
            t.points.push_back({radius * std::cos(a), radius * std::sin(a), z});
        }
    for (int i = 0; i < around; ++i) {
        const int j = (i + 1) % around;
        t.triangles.push_back({i, j, j + around});
        t.triangles.push_back({i, j + around, i + around});
        if (i == 0 || j == 0) continue;
        t.triangles.push_back({0, j, i});
        t.triangles.push_back({around, i + around, j + around});
    }
    return t;
}

TEST(Resampled, LongTrianglesOfAWireDoNotFold) {
    for (double size : {0.2, 0.1, 0.05})
        for (int around : {12, 24, 48}) {
            const Surface s = resampled(shape_of(wire(0.2, 1, around)), {size});
            EXPECT_NO_THROW((void)make_surface(s.points, s.triangles)) << size << ' ' << around;
        }
}

TEST(GenerateMesh, TakesAnyClosedSurface) {
    const Rotation turned = rotation_about({1, -2, 0.5}, 0.4);
    expect_mesh(domain_with(shape_of(box_of_triangles({-1, -1, -1}, {1, 1, 1})), 0.6), 8);
    expect_mesh(domain_with(shape_of(l_block(), {-1, -0.8, 0.1}, turned), 0.4), 3);
    const Triangles hollow = together(box_of_triangles({-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}),
                                      turned_round(box_of_triangles({-0.7, -0.7, -0.7}, {0.7, 0.7, 0.7})));
    const Triangles both = together(hollow, box_of_triangles({1.9, 0, 0}, {2.5, 0.6, 0.6}));
    expect_mesh(domain_with(shape_of(both), 0.5), 27 - 2.744 + 0.216);
    const Shape ring = shape_of(torus(1, 0.4, 40, 20), {0.2, 0.1, -0.3}, turned);
    expect_mesh(domain_with(ring, 0.25), enclosed_volume(resampled(ring, {0.25}), ring.centre));
}

/// How far vertices of the body's surface are off its shape, at most [m].
double off_its_shape(const Mesh& mesh, const Shape& shape) {
    double most = 0;
    for (const Tet t : all_tets(mesh, Region(1)))
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n.exists() || mesh.region[n] == Region(1)) continue;
            for (const Vertex v : facet_vertices(mesh, {t, corner}))
                most = std::max(most, std::abs(signed_distance(shape, mesh.position[v])));
        }
    return most;
}

TEST(InitialMesh, ExchangesTrianglesOfASurfaceWhereCellsAtItAreBad) {
    Domain domain;  // a ring hardly thicker than an edge: R/r 16.3, 12.8 and 8.96 with the triangles that it is sampled with
    domain.box = {{-3, -2, -2}, {3, 2, 2}};
    domain.bodies.push_back({.name = "ring", .shape = shape_of(torus(0.706, 0.2824, 32, 16), {-1.01, -0.04, 0.925})});
    for (const auto& [size, ratio] : {std::pair{0.25, 8.29}, {0.26, 7.27}, {0.28, 6.20}}) {
        domain.size = {.surface = size, .growth = 0.5, .far = 0.8};
        const Mesh raw = generate_mesh(domain, 1), mesh = initial_mesh(domain, 1);
        EXPECT_LT(worst_aspect_ratio(mesh, all_tets(mesh)), 1.1 * ratio) << size;
        EXPECT_NEAR(region_volume(mesh, Region(1)) / region_volume(raw, Region(1)), 1, 1e-12) << size;
        EXPECT_LT(off_its_shape(raw, domain.bodies[0].shape), 1e-9) << size;
        EXPECT_GT(off_its_shape(mesh, domain.bodies[0].shape), 1e-6) << size;
        EXPECT_LT(off_its_shape(mesh, domain.bodies[0].shape), 0.15 * size) << size;
        EXPECT_NO_THROW(MovingMesh(domain, mesh, 0)) << size;
    }
}

TEST(GenerateMesh, TakesThinBodiesAndSlots) {
    const auto with_room_for = [](Domain domain) {
        domain.size.least = 0.02;
        return domain;
    };
    const Shape plate = shape_of(box_of_triangles({-1, -1, -0.05}, {1, 1, 0.05}), {}, rotation_about({1, 2, 0}, 0.5));
    expect_mesh(with_room_for(domain_with(plate, 0.5)), 0.4);
    const Triangles slot = together(box_of_triangles({-1, -1, -1}, {-0.05, 1, 1}), box_of_triangles({0.05, -1, -1}, {1, 1, 1}));
    expect_mesh(with_room_for(domain_with(shape_of(slot), 0.5)), 2 * 0.95 * 4);
    const Triangles bar = box_of_triangles({-0.05, -0.05, -1}, {0.05, 0.05, 1});
    expect_mesh(with_room_for(domain_with(shape_of(bar), 0.5)), 0.02);
}

// Of four corners of a cube the Delaunay mesh may make a flat cell, and of those beside it too.
TEST(InitialMesh, HasNoFlatCellsInSquareBars) {
    for (const auto [half_width, half_length] : {std::array{0.05, 0.8}, {0.17, 1.0}, {0.25, 1.0}}) {
        const Vec3 half = {half_width, half_width, half_length};
        const Shape bar = shape_of(box_of_triangles(-half, half));
        const Mesh mesh = initial_mesh(domain_with(bar, 0.4));
        double worst = 0;
        for (Tet t : mesh.tets.indices()) worst = std::max(worst, alive(mesh, t) ? aspect_ratio(mesh, t) : 0);
        EXPECT_LE(worst, 10) << half_width;
    }
}
