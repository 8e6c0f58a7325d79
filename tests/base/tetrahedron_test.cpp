#include "base/tetrahedron.h"

#include <kropla/base/predicates.h>
#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kropla {
namespace {

constexpr std::uint64_t seed = 4;
using Corners = std::array<Vec3, 4>;

// Four corners of a cube, no two on one edge of it: all edges are diagonals of its faces.
constexpr Corners regular = {Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 1}, Vec3{1, 0, 1}};
constexpr Corners corner_of_cube = {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

double aspect_ratio(const Corners& t) { return tet_aspect_ratio(t[0], t[1], t[2], t[3]); }
double volume(const Corners& t) { return tet_volume(t[0], t[1], t[2], t[3]); }

Corners random_tet(Random& random) {
    Corners t;
    for (Vec3& p : t) p = {random.uniform(), random.uniform(), random.uniform()};
    if (orient3d(t[0], t[1], t[2], t[3]) < 0) std::swap(t[0], t[1]);
    return t;
}

TEST(TetShape, RegularTetIsPerfect) {
    EXPECT_NEAR(volume(regular), 1.0 / 3, 1e-15);
    for (const double size : {1e-9, 1.0, 1e9}) {
        Corners t = regular;
        for (Vec3& p : t) p *= size;
        EXPECT_NEAR(aspect_ratio(t), 3, 1e-14);
    }
}

TEST(TetShape, CornerOfACube) {
    const double circumradius = std::sqrt(3.0) / 2, inradius = 1 / (3 + std::sqrt(3.0));
    EXPECT_NEAR(aspect_ratio(corner_of_cube), circumradius / inradius, 1e-14);
    const auto& t = corner_of_cube;
    EXPECT_LT(distance(tet_circumcentre(t[0], t[1], t[2], t[3]), Vec3{0.5, 0.5, 0.5}), 1e-15);
}

TEST(TetShape, FourAtOnceHaveTheBitsOfEach) {
    SCOPED_TRACE("seed 4");
    Random random{seed};
    for (int round = 0; round < 2000; ++round) {
        std::array<Corners, 4> each;
        FourPlaces places;
        for (std::size_t i = 0; i < 4; ++i) {
            Corners& t = each[i] = random_tet(random);
            if (random.below(8) == 0) std::swap(t[0], t[1]);
            if (random.below(8) == 0) t[3] = t[0] + random.uniform() * (t[1] - t[0]) + random.uniform() * (t[2] - t[0]);
            places[i] = {&t[0], &t[1], &t[2], &t[3]};
        }
        std::vector<StarFacet> star;
        for (const Corners& t : each) star.push_back({t[1], t[2], t[3]});
        star.resize(round % 2 == 0 ? 3 : 4);
        auto facets = by_fours(star);
        const Vec3 x = each[0][0];
        find_ratios(facets.front(), x);
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& [a, b, c] = star[std::min(i, star.size() - 1)];
            ASSERT_EQ(facets.front().ratios[i], tet_aspect_ratio(x, a, b, c)) << "round " << round;
        }
        const FourNumbers by_place = tet_aspect_ratios(places);
        const auto [again, energies] = tet_energies(places);
        for (std::size_t i = 0; i < 4; ++i) {
            const auto& [a, b, c, d] = each[i];
            const double ratio = aspect_ratio(each[i]);
            ASSERT_EQ(by_place[i], ratio) << "round " << round;
            ASSERT_EQ(again[i], ratio) << "round " << round;
            if (std::isfinite(ratio)) {
                ASSERT_EQ(energies[i], tet_volume(a, b, c, d) * (ratio * ratio) * (ratio * ratio)) << "round " << round;
            }
        }
    }
}

TEST(TetShape, FlatOrTurnedIsInfinite) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(aspect_ratio({regular[1], regular[0], regular[2], regular[3]}), infinity);
    EXPECT_EQ(aspect_ratio({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{1, 1, 0}}), infinity);
    EXPECT_EQ(aspect_ratio({Vec3{}, Vec3{}, Vec3{}, Vec3{}}), infinity);
    // Rounded arithmetic sees a volume here, of either sign, though the four points are exactly coplanar or
    // almost.
    Random random{seed};
    for (int i = 0; i < 10000; ++i) {
        Corners t = random_tet(random);
        t[3] = t[0] + random.uniform() * (t[1] - t[0]) + random.uniform() * (t[2] - t[0]);
        const bool positive = orient3d(t[0], t[1], t[2], t[3]) > 0;
        const double value = aspect_ratio(t);
        ASSERT_TRUE(positive ? value > 1e6 : value == infinity) << i << " of seed " << seed;
    }
}

TEST(TetShape, RadiiByTheirDefinition) {
    Random random{seed};
    for (int i = 0; i < 1000; ++i) {
        const Corners t = random_tet(random);
        const Vec3 centre = tet_circumcentre(t[0], t[1], t[2], t[3]);
        const double radius = distance(centre, t[0]);
        for (const Vec3& p : t) EXPECT_NEAR(distance(centre, p) / radius, 1, 1e-14);
        const auto area = [&](int a, int b, int c) {
            const auto at = [&](int k) { return t[static_cast<std::size_t>(k)]; };
            return norm(cross(at(b) - at(a), at(c) - at(a))) / 2;
        };
        const double areas = area(1, 2, 3) + area(0, 2, 3) + area(0, 1, 3) + area(0, 1, 2);
        const double inradius = 3 * volume(t) / areas;
        EXPECT_NEAR(aspect_ratio(t) * inradius / radius, 1, 1e-14) << i << " of seed " << seed;
    }
}

TEST(TetShape, GradientIsTheSlope) {
    Random random{seed};
    for (int i = 0; i < 1000; ++i) {
        const Corners t = random_tet(random);
        const auto [value, gradient] = tet_aspect_gradient(t[0], t[1], t[2], t[3]);
        EXPECT_NEAR(value / aspect_ratio(t), 1, 6e-13);
        if (value > 100) continue;  // too steep for differences
        const double h = 1e-6;
        for (int axis = 0; axis < 3; ++axis) {
            Corners after = t, before = t;
            after[0][axis] += h;
            before[0][axis] -= h;
            const double slope = (aspect_ratio(after) - aspect_ratio(before)) / (2 * h);
            EXPECT_NEAR(gradient[axis], slope, 5e-9 * (norm(gradient) + 1)) << i << " of seed " << seed;
        }
    }
    EXPECT_LT(norm(tet_aspect_gradient(regular[0], regular[1], regular[2], regular[3]).gradient), 1e-13);
}

TEST(TetShape, DihedralAngles) {
    for (const double angle : tet_dihedral_angles(regular[0], regular[1], regular[2], regular[3]))
        EXPECT_NEAR(angle, std::acos(1.0 / 3), 1e-15);
    const auto& c = corner_of_cube;
    const auto angles = tet_dihedral_angles(c[0], c[1], c[2], c[3]);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(angles[i], std::numbers::pi / 2, 1e-15);
    for (std::size_t i = 3; i < 6; ++i) EXPECT_NEAR(angles[i], std::acos(1 / std::sqrt(3.0)), 1e-15);
}

TEST(TetShape, TheRangeIsThatOfItsDihedralAngles) {
    Random random{7};
    const auto point = [&] { return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
    for (int i = 0; i < 1000; ++i) {  // half of them turned over
        const Vec3 a = point(), b = point(), c = point(), d = point();
        const auto angles = tet_dihedral_angles(a, b, c, d);
        const auto [least, largest] = tet_dihedral_range(a, b, c, d);
        EXPECT_DOUBLE_EQ(least, std::ranges::min(angles)) << i << " of seed 7";
        EXPECT_DOUBLE_EQ(largest, std::ranges::max(angles)) << i << " of seed 7";
    }
}

// Almost flat over the unit square: 0 at its sides, pi at its diagonals, the edges 03 and 12.
TEST(TetShape, DihedralAnglesOfASliver) {
    const auto angles = tet_dihedral_angles({0, 0, 0}, {1, 0, 1e-9}, {0, 1, 1e-9}, {1, 1, 0});
    const std::array<double, 6> expected = {0, 0, std::numbers::pi, std::numbers::pi, 0, 0};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(std::abs(angles[i]), expected[i], 1e-8) << "edge " << i;
}

}  // namespace
}  // namespace kropla
