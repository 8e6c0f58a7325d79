#include "generate/normals.h"

#include "generate/domains.h"
#include <kropla/generate/generate.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace kropla;

namespace {

/// The normal of the ellipsoid at a point of it.
Vec3 true_normal(const Shape& shape, const Vec3& x) {
    const Vec3 p = rotated_back(shape.orientation, x - shape.centre), &a = shape.semi_axes;
    return normalised(rotated(shape.orientation, {p.x / (a.x * a.x), p.y / (a.y * a.y), p.z / (a.z * a.z)}));
}

/// The largest angle between the normals and the true ones [rad].
double worst_angle(const Shape& shape, double size) {
    const Surface surface = triangulate_surface(shape, size, 1);
    const auto normals = surface_normals(surface.points, surface.triangles);
    double worst = 0;
    for (std::size_t i = 0; i < normals.size(); ++i)
        worst = std::max(worst, norm(cross(normals[i], true_normal(shape, surface.points[i]))));
    return worst;
}

/// The least cosine of the angle between a point's normal and those of its triangles.
double least_cosine(const Surface& surface, const std::vector<Vec3>& normals) {
    double least = 1;
    for (const auto& [a, b, c] : surface.triangles) {
        const auto place = [&](int i) { return surface.points[static_cast<std::size_t>(i)]; };
        const Vec3 side = normalised(cross(place(b) - place(a), place(c) - place(a)));
        for (int v : {a, b, c}) least = std::min(least, dot(side, normals[static_cast<std::size_t>(v)]));
    }
    return least;
}

}  // namespace

TEST(Normals, OfSpheresAreThoseOfTheSphere) {
    EXPECT_LT(worst_angle(ball({1, 2, 3}, 1), 0.2), 2.3e-4);  // 0.012 degrees; the triangles lean by 7
}

TEST(Normals, OfEllipsoidsGrowBetterWithTheSize) {
    const Shape shape = turned_ellipsoid({0, 0, 0}, {2, 1, 1});
    const double coarse = worst_angle(shape, 0.3), fine = worst_angle(shape, 0.15);
    EXPECT_LT(coarse, 0.06);
    EXPECT_LT(fine, 0.33 * coarse);
}

TEST(Normals, OfAPlaneAndOfAParaboloidAreExact) {
    // a fan of six triangles around the origin on z = 0.3 x^2 - 0.2 x y + 0.1 y^2 + 0.4 x - 0.5 y
    std::vector<Vec3> points = {{0, 0, 0}};
    std::vector<std::array<int, 3>> triangles;
    for (int i = 0; i < 6; ++i) {
        const double turn = i * std::numbers::pi / 3, r = 1 + 0.1 * (i % 3), x = r * std::cos(turn),
                     y = r * std::sin(turn);
        // in the frame of the tangent plane a paraboloid over another plane is none: small heights, a near
        // one
        points.push_back({x, y, 1e-5 * (0.3 * x * x - 0.2 * x * y + 0.1 * y * y + 0.4 * x - 0.5 * y)});
        triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
    }
    const Vec3 expected = normalised({-0.4e-5, 0.5e-5, 1});
    EXPECT_NEAR(norm(surface_normals(points, triangles)[0] - expected), 0, 1e-9);
    for (Vec3& p : points) p.z = 0.4 * p.x - 0.5 * p.y;
    EXPECT_NEAR(norm(surface_normals(points, triangles)[0] - normalised({-0.4, 0.5, 1})), 0, 1e-12);
}

TEST(Normals, SeeAllTrianglesAtASharpTip) {
    // a needle: the tip's neighbours lie on a ring far below it, shifted, so that the fit alone leans out
    std::vector<Vec3> points = {{0.9, 0, 3}};
    std::vector<std::array<int, 3>> triangles;
    for (int i = 0; i < 6; ++i) {
        points.push_back({std::cos(i * std::numbers::pi / 3), std::sin(i * std::numbers::pi / 3), 0});
        triangles.push_back({0, 1 + i, 1 + (i + 1) % 6});
    }
    points.push_back({0, 0, -1});
    for (int i = 0; i < 6; ++i) triangles.push_back({7, 1 + (i + 1) % 6, 1 + i});
    const Surface needle{points, triangles};
    EXPECT_GT(least_cosine(needle, surface_normals(points, triangles)), 0.23);
}

TEST(Normals, TurnWithTheSurface) {
    const Shape shape = turned_ellipsoid({0, 0, 0}, {2, 1, 1});
    const Pose pose{{1, 2, 3}, rotation_about({1, -1, 2}, 1.1)};
    Surface surface = triangulate_surface(shape, 0.3, 1);
    const auto before = surface_normals(surface.points, surface.triangles);
    for (Vec3& p : surface.points) p = placed(shape, pose, p);
    const auto after = surface_normals(surface.points, surface.triangles);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_NEAR(norm(after[i] - rotated(pose.rotation, before[i])), 0, 1e-12);
}
