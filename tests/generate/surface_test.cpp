#include "generate/domains.h"
#include <kropla/generate/generate.h>
#include "generate/skin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

using namespace kropla;

namespace {

struct Shapeliness {
    double least_angle = 180, greatest_angle = 0;         // [deg]
    double shortest = 1e300, longest = 0, mean_edge = 0;  // [m]
    double largest_circumradius = 0;                      // [m]
};

Shapeliness shapeliness(const Surface& surface) {
    Shapeliness s;
    for (const auto& corners : surface.triangles) {
        std::array<Vec3, 3> p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = surface.points[static_cast<std::size_t>(corners[i])];
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
            const double angle = std::atan2(norm(cross(a, b)), dot(a, b)) * 180 / std::numbers::pi;
            s.least_angle = std::min(s.least_angle, angle);
            s.greatest_angle = std::max(s.greatest_angle, angle);
            s.shortest = std::min(s.shortest, norm(a));
            s.longest = std::max(s.longest, norm(a));
            s.mean_edge += norm(a) / static_cast<double>(3 * surface.triangles.size());
            s.largest_circumradius =
                std::max(s.largest_circumradius, norm(a - b) / norm(cross(a, b)) * norm(a) * norm(b) / 2);
        }
    }
    return s;
}

/// Each edge stands in two triangles, once each way, and Euler's formula gives a sphere.
bool is_closed_sphere(const Surface& surface) {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& t : surface.triangles)
        for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
    const bool mutual = std::ranges::all_of(edges, [&](const auto& edge) {
        const auto& [ends, count] = edge;
        return count == 1 && edges.contains({ends.second, ends.first});
    });
    return mutual && surface.points.size() + surface.triangles.size() == edges.size() / 2 + 2;
}

double signed_volume(const Surface& surface, const Vec3& about) {
    double sum = 0;
    for (const auto& [i, j, k] : surface.triangles) {
        const auto place = [&](int p) { return surface.points[static_cast<std::size_t>(p)] - about; };
        sum += determinant(place(i), place(j), place(k)) / 6;
    }
    return sum;
}

double volume_of(const Shape& shape) {
    return 4 * std::numbers::pi / 3 * shape.semi_axes.x * shape.semi_axes.y * shape.semi_axes.z;
}

}  // namespace

TEST(Surface, TrianglesAreWellShapedAndOfTheSizeAsked) {
    const double size = 2e-4;
    for (const Shape& shape : {ball({0, 0, 0.013}, 1e-3), turned_ellipsoid({0, 0, 0}, {1e-3, 1.5e-3, 1.2e-3}),
                               turned_ellipsoid({1, 1, 1}, {1e-3, 2e-3, 3e-3})})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const Surface surface = triangulate_surface(shape, size, seed);
            EXPECT_TRUE(is_closed_sphere(surface));
            const Shapeliness s = shapeliness(surface);
            // Seen over hundreds of surfaces: 28 ... 107 degrees, 0.55 ... 1.50 sizes, circumradius 0.77,
            // mean 1.01.
            EXPECT_GT(s.least_angle, 25);
            EXPECT_LT(s.greatest_angle, 115);
            EXPECT_GT(s.shortest, 0.5 * size);
            EXPECT_LT(s.longest, 1.6 * size);
            EXPECT_LT(s.largest_circumradius, 0.85 * size);
            EXPECT_NEAR(s.mean_edge, size, 0.0136 * size);
        }
}

TEST(Surface, HasTheSizeOfEachPlace) {
    const auto local = [](const Vec3& x) { return 0.05 + 0.1 * (x.z + 1); };  // from 0.05 to 0.25
    for (const Shape& shape : {ball({0, 0, 0}, 1), turned_ellipsoid({0, 0, 0}, {0.8, 1, 0.9})})
        for (std::uint64_t seed = 1; seed <= 3; ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            Surface surface = triangulate_surface(shape, {0.25, local}, seed);
            EXPECT_TRUE(is_closed_sphere(surface));
            EXPECT_NEAR(signed_volume(surface, shape.centre) / volume_of(shape), 1, 1e-14);
            EXPECT_GT(shapeliness(surface).least_angle, 25);
            double least = 1e300, most = 0, mean = 0;
            for (const auto& t : surface.triangles)
                for (std::size_t i = 0; i < 3; ++i) {
                    const Vec3 &a = surface.points[static_cast<std::size_t>(t[i])], &b = surface.points[static_cast<std::size_t>(t[(i + 1) % 3])];
                    const double part = distance(a, b) / local(0.5 * (a + b));
                    least = std::min(least, part);
                    most = std::max(most, part);
                    mean += part / static_cast<double>(3 * surface.triangles.size());
                }
            EXPECT_GT(least, 0.5);
            EXPECT_LT(most, 1.6);
            EXPECT_NEAR(mean, 1, 0.03);
        }
}

TEST(Surface, HoldsTheVolumeOfItsShape) {
    // Round, long, flat, with three axes, nearly round; from a size equal to the least radius of curvature on.
    const std::array axes_of = {Vec3{1, 1, 1}, Vec3{1, 1, 3}, Vec3{1, 3, 3}, Vec3{1, 1.5, 2}, Vec3{1, 1 + 1e-9, 1}};
    for (const Vec3& axes : axes_of)
        for (const double fineness : {1.0, 1.5, 2.0, 4.0})
            for (std::uint64_t seed = 1; seed <= 3; ++seed) {
                const Shape shape = turned_ellipsoid({3, -2, 1}, axes);
                const double size = least_curvature_radius(shape) / fineness;
                SCOPED_TRACE("axes " + std::to_string(axes.y) + " " + std::to_string(axes.z) + ", size " +
                             std::to_string(size) + ", seed " + std::to_string(seed));
                const Surface surface = triangulate_surface(shape, size, seed);
                EXPECT_NEAR(signed_volume(surface, shape.centre) / volume_of(shape), 1, 1e-14);
                // So its points lie on one larger ellipsoid, no farther out than is said.
                const Shape larger = through(shape, surface.points.front());
                for (const Vec3& x : surface.points) {
                    ASSERT_NEAR(signed_distance(larger, x), 0, 1e-14);
                    ASSERT_GT(signed_distance(shape, x), 0);
                    ASSERT_LT(signed_distance(shape, x), outward_shift(shape, size));
                }
            }
}

TEST(Surface, ItsVolumeIsSummedRightToRounding) {
    const Shape shape = ball({1e6, -1e6, 1e6}, 1024);  // all products of the sum are far apart in size
    Surface surface = triangulate_surface(shape, 60, 1);
    long double sum = 0;
    for (const auto& [i, j, k] : surface.triangles) {
        const auto place = [&](int p) { return surface.points[static_cast<std::size_t>(p)] - shape.centre; };
        sum += static_cast<long double>(determinant(place(i), place(j), place(k)) / 6);
    }
    EXPECT_NEAR(enclosed_volume(surface, shape.centre) / static_cast<double>(sum), 1, 3e-16);
}

TEST(Surface, HasThePointsThatItsAreaAsksFor) {
    const Surface surface = triangulate_surface(ball({0, 0, 0}, 1e-3), 2e-4, 1);
    EXPECT_EQ(surface.points.size(), 363u);  // 4 pi / (0.2^2 sqrt(3) / 2)
    EXPECT_EQ(surface.triangles.size(), 2 * 363u - 4);
}

TEST(Surface, TheCoarsestSizeStillGivesABody) {
    const Surface surface = triangulate_surface(ball({0, 0, 0}, 1), 1, 1);
    EXPECT_TRUE(is_closed_sphere(surface));
    EXPECT_GT(shapeliness(surface).least_angle, 25);
}

TEST(Surface, IsTheSameForTheSameSeedAndAnotherForAnother) {
    const Shape shape = turned_ellipsoid({1, 2, 3}, {1, 2, 1.5});
    const Surface first = triangulate_surface(shape, 0.3, 5), again = triangulate_surface(shape, 0.3, 5);
    EXPECT_EQ(first.points, again.points);
    EXPECT_EQ(first.triangles, again.triangles);
    EXPECT_NE(first.points, triangulate_surface(shape, 0.3, 6).points);
}

TEST(Skin, SplitsEdgesAndStaysASphere) {
    const Shape shape = ball({0, 0, 0}, 1);
    Skin skin = make_skin(triangulate_surface(shape, 0.5, 1), shape.centre);
    for (int i = 0; i < 200; ++i) {
        const std::size_t points = skin.points.size();
        const Vertex added = split_longest_edge(skin, shape, Triangle(i % 7));
        EXPECT_EQ(skin.points.size(), points + 1);
        EXPECT_NEAR(signed_distance(shape, skin.points[added]), 0, 1e-15);
        ASSERT_TRUE(is_closed_sphere(surface_of(skin)));
        EXPECT_EQ(make_skin(surface_of(skin), skin.inside).across, skin.across);
    }
    const double before = shapeliness(surface_of(skin)).least_angle;
    EXPECT_GT(flip_edges(skin), 6);
    EXPECT_TRUE(is_closed_sphere(surface_of(skin)));
    EXPECT_EQ(make_skin(surface_of(skin), skin.inside).across, skin.across);
    EXPECT_GE(shapeliness(surface_of(skin)).least_angle, before);
}
