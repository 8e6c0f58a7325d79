// Sizes that fall where a body, or what it leaves open, is thin.
#include "domain/thin_places.h"

#include <kropla/base/error.h>
#include "domain/body_surface.h"
#include <kropla/domain/solids.h>
#include "domain/surfaces.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace kropla;

namespace {

/// A polygon in the plane of x and y, counter-clockwise and seen whole from its first corner, drawn along z.
Triangles prism_on(const std::vector<Vec3>& polygon, double half_length) {
    Triangles prism;
    const int n = static_cast<int>(polygon.size());
    for (const double z : {-half_length, half_length})
        for (const Vec3& corner : polygon) prism.points.push_back({corner.x, corner.y, z});
    for (int i = 0; i < n; ++i) {
        const int j = (i + 1) % n;
        prism.triangles.insert(prism.triangles.end(), {{i, j, n + j}, {i, n + j, n + i}});
        if (i > 0 && j > 0) prism.triangles.insert(prism.triangles.end(), {{0, j, i}, {n, n + i, n + j}});
    }
    return prism;
}

std::vector<Vec3> regular_polygon(int corners, double radius) {
    std::vector<Vec3> polygon;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        polygon.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    return polygon;
}

constexpr double least = 0.01, most = 0.5, growth = 0.2;

ThinPlaces thin_places(const Triangles& t, double largest = most) { return {surface_of(t), least, largest}; }

Domain with_body(const Triangles& t, double size, double least_size) {
    Domain domain{{{-4, -4, -4}, {4, 4, 4}}, {}, {size, 0.3, 2, least_size}};
    domain.bodies.push_back({"plate", shape_within(t.points, t.triangles)});
    return domain;
}

}  // namespace

TEST(ThinPlaces, APlateHasACellAcrossWhereverItIs) {
    const double thickness = 0.06;
    const ThinPlaces thin = thin_places(box_of_triangles({-1, -1, -thickness / 2}, {1, 1, thickness / 2}));
    ASSERT_TRUE(thin.any());
    for (const Vec3& x : {Vec3{0, 0, 0.03}, Vec3{0.9, -0.9, -0.03}, Vec3{-0.99, 0.2, 0.03}})
        EXPECT_NEAR(thin.size(x, growth), gap_share * thickness, 0.02 * gap_share * thickness);
    EXPECT_NEAR(thin.size({1.5, 0, 0.03}, growth), gap_share * thickness + growth * 0.5, 0.02);
    EXPECT_EQ(thin.size({9, 0, 0}, growth), most);
    EXPECT_NEAR(thin.narrowest().across, thickness, 0.01 * thickness);
    EXPECT_EQ(thin.narrowest().kind, ThinPlaces::Kind::body);
}

TEST(ThinPlaces, AThickBodyHasNone) {
    EXPECT_FALSE(thin_places(box_of_triangles({-1, -1, -1}, {1, 1, 1})).any());
    EXPECT_FALSE(thin_places(sphere_of_triangles(4)).any());
}

TEST(ThinPlaces, ARodHasItsRadiusAndABarACellAcross) {
    const double radius = 0.08;
    const ThinPlaces rod = thin_places(prism_on(regular_polygon(24, radius), 1));
    EXPECT_NEAR(rod.size({radius, 0, 0}, growth), radius, 0.1 * radius);
    const ThinPlaces bar = thin_places(prism_on(regular_polygon(4, radius), 1));
    EXPECT_NEAR(bar.size({radius, 0, 0}, growth), gap_share * std::numbers::sqrt2 * radius, 0.05 * radius);
}

TEST(ThinPlaces, ASlotIsOpenAndThin) {
    const double width = 0.1;
    const Triangles two = together(box_of_triangles({-1, -1, -1}, {-width / 2, 1, 1}), box_of_triangles({width / 2, -1, -1}, {1, 1, 1}));
    const ThinPlaces slot = thin_places(two);
    EXPECT_NEAR(slot.size({-width / 2, 0, 0}, growth), gap_share * width, 0.02 * width);
    EXPECT_EQ(slot.size({-1, 0, 0}, growth), std::min(most, gap_share * width + growth * (1 - width / 2)));
    EXPECT_EQ(slot.narrowest().kind, ThinPlaces::Kind::slot);
}

TEST(ThinPlaces, AnEdgeHoweverSharpIsNone) {
    const double slope = std::tan(10 * std::numbers::pi / 180);  // in all; nearer to it than `most` it does not count
    const ThinPlaces blade = thin_places(prism_on({{-1, 0, 0}, {1, -slope, 0}, {1, slope, 0}}, 1));
    EXPECT_GT(blade.size({-1, 0, 0}, growth), 0.8 * gap_share * most * 2 * slope);
    const ThinPlaces notch = thin_places(prism_on({{0, 0, 0}, {-0.1, 1, 0}, {-1, 1, 0}, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0.1, 1, 0}}, 1));
    EXPECT_GT(notch.narrowest().across, 0.05);
    const double blunt = 0.02;
    const ThinPlaces cut_off =
        thin_places(prism_on({{-1, -blunt, 0}, {1, -slope, 0}, {1, slope, 0}, {-1, blunt, 0}}, 1));
    EXPECT_LT(cut_off.size({-1, 0, 0}, growth), 2 * gap_share * 2 * blunt);
}

TEST(ThinPlaces, ABodyTurnsWithItsSizes) {
    Domain domain = with_body(box_of_triangles({-1, -1, -0.03}, {1, 1, 0.03}), 0.5, 0.01);
    domain.bodies[0].motion = [](double t) { return Pose{{t, 0, 0}, rotation_about({0, 1, 0}, std::numbers::pi / 2 * t)}; };
    const Snapshot at = snapshot(domain, 1);  // it stands across x = 1
    EXPECT_NEAR(surface_size(at, 0, {1.03, 0.5, 0.5}), gap_share * 0.06, 0.002);
    EXPECT_NEAR(target_size(at, {1.23, 0.5, 0.5}), gap_share * 0.06 + 0.3 * 0.2, 0.002);
}

TEST(ThinPlaces, APlateThroughWallsKeepsItsSizesAsItMoves) {
    Domain domain{{{-1, -1, -1}, {1, 1, 1}}, {}, {0.4, 0.4, 0.8}};
    domain.bodies.push_back({"plate", slab(domain.box, {-2, -2, -0.05}, {2, 2, 0.05})});
    domain.bodies[0].motion = [](double t) { return Pose{{0, 0, t}, {}}; };
    domain.bodies[0] = cut_body(domain.bodies[0]);
    const Mesh mesh = initial_mesh(domain);
    const Snapshot at = snapshot(domain, 0, deforming_surfaces(domain, mesh), mesh.position, false);
    EXPECT_NEAR(surface_size(at, 0, {0, 0, 0.05}), gap_share * 0.1, 0.01);
}

TEST(ThinPlaces, TooThinForTheLeastSizeIsSaidBefore) {
    const Domain domain = with_body(box_of_triangles({-1, -1, -0.01}, {1, 1, 0.01}), 0.5, 0.1);
    try {
        check_placement(domain, 0, least_gap_in_sizes);
        FAIL() << "0.02 m thick, and sizes of at least 0.1 m";
    } catch (const DomainError& error) {
        const std::string said = error.what();
        EXPECT_NE(said.find("body \"plate\" is 0.02"), std::string::npos) << said;
        EXPECT_NE(said.find("too thin for size.least = 0.1 m; at most 0.0"), std::string::npos) << said;
    }
    Domain finer = domain;
    finer.size.least = 0.05;
    EXPECT_NO_THROW(check_placement(finer, 0, least_gap_in_sizes));
}

/// A wedge whose edge is cut off: sharp edges this far from each other, along z.
Triangles blunted_wedge(double width) {
    return prism_on({{-1, -1, 0}, {1, -1, 0}, {width / 2, 0.5, 0}, {-width / 2, 0.5, 0}}, 1);
}

TEST(ThinPlaces, SharpEdgesThatAreNearMakeTrianglesSmall) {
    EXPECT_FALSE(thin_places(prism_on({{-1, -1, 0}, {1, -1, 0}, {0, 0.5, 0}}, 1)).any());
    for (const double largest : {most, 0.21, 0.108}) {
        const ThinPlaces none = thin_places(blunted_wedge(1.01 * 0.4 * most), largest);
        EXPECT_FALSE(none.any()) << largest;
        EXPECT_GT(none.narrowest().across, 0.4 * most) << largest;
    }
    const double width = 0.04;
    const ThinPlaces thin = thin_places(blunted_wedge(width));
    ASSERT_TRUE(thin.any());
    EXPECT_EQ(thin.narrowest().kind, ThinPlaces::Kind::edges);
    EXPECT_NEAR(thin.narrowest().across, width, 1e-15);
    for (const double z : {-1.0, 0.0, 0.3, 1.0}) EXPECT_NEAR(thin.size({width / 2, 0.5, z}, growth), gap_share * width, 1e-15);
    EXPECT_NEAR(thin.size({width / 2, 1.5, 0}, growth), gap_share * width + growth, 1e-15);
}

TEST(ThinPlaces, BodiesWithSharpEdgesThatAreNearAreMeshed) {
    Domain domain = with_body(blunted_wedge(0.03), 0.25, 0.0125);
    domain.bodies[0].shape.orientation = rotation_about({1, 2, 3}, 0.7);
    const Mesh mesh = initial_mesh(domain, 1);
    EXPECT_LT(worst_aspect_ratio(mesh, all_tets(mesh)), 1.1 * 6.1);
    EXPECT_NEAR(region_volume(mesh, Region(1)), 2 * 1.5 * (2 + 0.03) / 2, 1e-13);
}

TEST(ThinPlaces, SharpEdgesThatAreTooNearAreRefusedWithThePlace) {
    const auto refused = [](const Domain& domain) -> std::string {
        try {
            check_placement(domain, 0, least_gap_in_sizes);
        } catch (const DomainError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(refused(with_body(blunted_wedge(0.002), 0.25, 0.0125)),
              "body \"plate\" has sharp edges 0.002 m from each other at (-0.001, 0.5, -1) m, too near for "
              "size.least = 0.0125 m; at most 0.003 m would do");
    Domain cut = with_body(prism_on({{-1, -5, 0}, {0, -5, 0}, {1, -3.999, 0}, {1, -2, 0}, {-1, -2, 0}}, 1), 0.25, 0.0125);
    cut.bodies[0].shape = cut_by(cut.box, cut.bodies[0].shape);  // an edge is just above the floor, which cuts its side
    const std::string said = refused(cut);
    EXPECT_TRUE(said.starts_with("body \"plate\" has sharp edges 0.00141 m from each other at (1, -3.999")) << said;
}
