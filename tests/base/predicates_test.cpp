// The predicates against integer arithmetic of any length: coordinates are scaled by a power of two until all
// are integers, which changes no sign and loses nothing.

#include <kropla/base/predicates.h>

#include "base/predicates_filter.h"
#include "base/random.h"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr std::uint64_t seed = 20;
using Points = std::array<Vec3, 5>;
using Rational = mpq_class;
using ExactPoint = std::array<mpz_class, 3>;

/// x * 2^160, an integer for all doubles of size 2^-100 and more.
mpz_class scaled(double x) {
    const Rational q = Rational(x) << 160;
    EXPECT_EQ(q.get_den(), 1);
    return q.get_num();
}

ExactPoint difference(const Vec3& a, const Vec3& b) {
    return {scaled(a.x) - scaled(b.x), scaled(a.y) - scaled(b.y), scaled(a.z) - scaled(b.z)};
}

mpz_class exact_determinant(const ExactPoint& u, const ExactPoint& v, const ExactPoint& w) {
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
           u[2] * (v[0] * w[1] - v[1] * w[0]);
}

/// Six times the volume of the tet of the first four points, scaled.
mpz_class exact_volume(const Points& p) {
    return exact_determinant(difference(p[1], p[0]), difference(p[2], p[0]), difference(p[3], p[0]));
}

int exact_orient3d(const Points& p) { return sgn(exact_volume(p)); }

int exact_insphere(const Points& p) {
    std::array<ExactPoint, 4> row;
    std::array<mpz_class, 4> lift;
    for (std::size_t i = 0; i < 4; ++i) {
        row[i] = difference(p[i], p[4]);
        lift[i] = row[i][0] * row[i][0] + row[i][1] * row[i][1] + row[i][2] * row[i][2];
    }
    mpz_class det = lift[0] * exact_determinant(row[1], row[2], row[3]);
    det -= lift[1] * exact_determinant(row[0], row[2], row[3]);
    det += lift[2] * exact_determinant(row[0], row[1], row[3]);
    det -= lift[3] * exact_determinant(row[0], row[1], row[2]);
    return sgn(det);
}

int orient3d(const Points& p) { return kropla::orient3d(p[0], p[1], p[2], p[3]); }
int insphere(const Points& p) { return kropla::insphere(p[0], p[1], p[2], p[3], p[4]); }
int insphere_perturbed(const Points& p, const std::array<std::int64_t, 5>& ranks) {
    return kropla::insphere_perturbed({&p[0], &p[1], &p[2], &p[3], &p[4]}, ranks);
}

/// x moved by up to `ulps` units in the last place.
double nudged(double x, int ulps, Random& random) {
    const auto steps = static_cast<int>(random.below(static_cast<std::uint64_t>(2 * ulps + 1))) - ulps;
    for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, steps > 0 ? 10.0 : -10.0);
    return x;
}

Vec3 nudged(const Vec3& p, int ulps, Random& random) {
    return {nudged(p.x, ulps, random), nudged(p.y, ulps, random), nudged(p.z, ulps, random)};
}

Vec3 in_cube(Random& random) { return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; }

Vec3 on_grid(std::uint64_t n, double spacing, Random& random) {
    const auto coordinate = [&] { return spacing * static_cast<double>(random.below(n)); };
    return {coordinate(), coordinate(), coordinate()};
}

Vec3 on_sphere(Random& random) { return normalised(in_cube(random)); }

Points each(auto make) {
    Points p;
    for (Vec3& x : p) x = make();
    return p;
}

/// The last two points nearly on the plane of the first three.
Points nearly_coplanar(Random& random) {
    Points p = each([&] { return in_cube(random); });
    for (std::size_t i = 3; i < 5; ++i) {
        const double s = random.uniform(-1, 1), t = random.uniform(-1, 1);
        p[i] = nudged(p[0] + s * (p[1] - p[0]) + t * (p[2] - p[0]), 3, random);
    }
    return p;
}

Points nearly_collinear(Random& random) {
    Points p = each([&] { return in_cube(random); });
    for (std::size_t i = 2; i < 5; ++i)
        p[i] = nudged(p[0] + random.uniform(-1, 1) * (p[1] - p[0]), 3, random);
    return p;
}

/// Makes the first four points positively oriented, if they are not coplanar.
void orient(Points& p) {
    if (exact_orient3d(p) < 0) std::swap(p[0], p[1]);
}

/// Compares both predicates on `count` inputs and returns how often the sign was zero.
int compare(int count, auto make) {
    int zeros = 0;
    for (int i = 0; i < count; ++i) {
        Points p = make();
        const int expected = exact_orient3d(p);
        EXPECT_EQ(orient3d(p), expected) << "input " << i << " of seed " << seed;
        if (expected == 0) ++zeros;
        orient(p);
        const int inside = exact_insphere(p);
        EXPECT_EQ(insphere(p), inside) << "input " << i << " of seed " << seed;
        if (inside == 0) ++zeros;
        if (testing::Test::HasFailure()) break;
    }
    return zeros;
}

TEST(Predicates, TellSidesAndInsides) {
    const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    EXPECT_EQ(kropla::orient3d(o, x, y, z), 1);
    EXPECT_EQ(kropla::orient3d(x, o, y, z), -1);
    EXPECT_EQ(kropla::orient3d(o, x, y, x + y), 0);
    EXPECT_EQ(kropla::insphere(o, x, y, z, {0.5, 0.5, 0.5}), 1);
    EXPECT_EQ(kropla::insphere(o, x, y, z, {2, 2, 2}), -1);
    EXPECT_EQ(kropla::insphere(o, x, y, z, x + y + z), 0);
}

TEST(Predicates, AreExactOnRandomPoints) {
    Random random{seed};
    compare(20000, [&] { return each([&] { return in_cube(random); }); });
}

TEST(Predicates, AreExactNearPlanesAndLines) {
    Random random{seed};
    compare(25000, [&] { return nearly_coplanar(random); });
    compare(15000, [&] { return nearly_collinear(random); });
}

TEST(Predicates, AreExactNearSpheres) {
    Random random{seed};
    compare(20000, [&] { return each([&] { return nudged(on_sphere(random), 2, random); }); });
    const Vec3 far{1, -2, 3};  // a small sphere far from the origin: differences are exact, roundings large
    compare(15000, [&] { return each([&] { return far + 1e-6 * on_sphere(random); }); });
}

TEST(Predicates, AreExactOnGrids) {
    Random random{seed};
    EXPECT_GT(compare(15000, [&] { return each([&] { return on_grid(4, 1.0, random); }); }), 5000);
    EXPECT_GT(compare(10000, [&] { return each([&] { return on_grid(4, 0.1, random); }); }), 3000);
    const Vec3 origin{1, 1, 1};
    compare(10000, [&] { return each([&] { return nudged(origin + on_grid(3, 0.1, random), 1, random); }); });
}

TEST(Predicates, AreExactOnMixedMagnitudes) {
    Random random{seed};
    compare(10000, [&] {
        return each([&] {
            const Vec3 p = in_cube(random);
            return Vec3{p.x, std::ldexp(p.y, -static_cast<int>(random.below(30))),
                        std::ldexp(p.z, -static_cast<int>(random.below(40)))};
        });
    });
}

TEST(Predicates, AreExactAtTheLimitsOfSize) {
    for (const double size : {1e-30, 1e-15, 1e15, 1e29}) {
        const Vec3 o{0, 0, 0}, x{size, 0, 0}, y{0, size, 0}, z{0, 0, size};
        EXPECT_EQ(kropla::orient3d(o, x, y, z), 1);
        EXPECT_EQ(kropla::insphere(o, x, y, z, x + y + z), 0);
        EXPECT_EQ(kropla::insphere(o, x, y, z, x + y + std::nextafter(1.0, 0.0) * z), 1);
        EXPECT_EQ(kropla::insphere(o, x, y, z, x + y + std::nextafter(1.0, 2.0) * z), -1);
    }
}

TEST(Predicates, FiltersNeverClaimAWrongSign) {
    Random random{seed};
    int decided = 0;
    for (int i = 0; i < 20000; ++i) {
        Points p = i % 2 == 0 ? nearly_coplanar(random)
                              : each([&] { return nudged(on_sphere(random), 50, random); });
        orient(p);
        const int side = filter::orient3d(p[0], p[1], p[2], p[3]);
        const int inside = filter::insphere(p[0], p[1], p[2], p[3], p[4]);
        ASSERT_TRUE(side == 0 || side == exact_orient3d(p)) << "input " << i << " of seed " << seed;
        ASSERT_TRUE(inside == 0 || inside == exact_insphere(p)) << "input " << i << " of seed " << seed;
        decided += std::abs(side) + std::abs(inside);
    }
    EXPECT_GT(decided, 9100);
}

TEST(Predicates, ChangeSignWithTheParityOfThePermutation) {
    Random random{seed};
    for (int i = 0; i < 1000; ++i) {
        const Points p = i % 2 == 0 ? nearly_coplanar(random) : each([&] { return on_grid(3, 0.1, random); });
        std::array<std::size_t, 4> order = {0, 1, 2, 3};
        do {
            int swaps = 0;
            for (std::size_t j = 0; j < 4; ++j)
                for (std::size_t k = 0; k < j; ++k) swaps += order[k] > order[j];
            const Points q = {p[order[0]], p[order[1]], p[order[2]], p[order[3]], p[4]};
            const int parity = swaps % 2 == 0 ? 1 : -1;
            ASSERT_EQ(orient3d(q), parity * orient3d(p)) << "input " << i << " of seed " << seed;
            ASSERT_EQ(insphere(q), parity * insphere(p)) << "input " << i << " of seed " << seed;
        } while (std::ranges::next_permutation(order).found);
    }
}

/// A tet of the cube's corners and a fifth corner, with ranks in random order.
struct Tie {
    Points points;
    std::array<std::int64_t, 5> ranks;
};
Tie random_tie(Random& random) {
    Tie tie{each([&] { return on_grid(2, 1.0, random); }), {3, 10, 7, 22, 15}};
    for (std::size_t i = 4; i > 0; --i) std::swap(tie.ranks[i], tie.ranks[random.below(i + 1)]);
    return tie;
}

bool distinct(const Points& p) {
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (p[i] == p[j]) return false;
    return true;
}

TEST(PerturbedInsphere, IsNeverZeroAndTheSameForEvenPermutations) {
    Random random{seed};
    int ties = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto [p, r] = random_tie(random);
        if (!distinct(p) || orient3d(p) <= 0) continue;
        ++ties;
        ASSERT_EQ(insphere(p), 0);
        const int s = insphere_perturbed(p, r);
        ASSERT_NE(s, 0);
        for (const auto& [a, b, c, d] : {std::array{1u, 2u, 0u, 3u}, {0u, 2u, 3u, 1u}, {1u, 0u, 3u, 2u}})
            ASSERT_EQ(insphere_perturbed({p[a], p[b], p[c], p[d], p[4]}, {r[a], r[b], r[c], r[d], r[4]}), s)
                << "input " << i << " of seed " << seed;
    }
    EXPECT_GT(ties, 1500);
}

TEST(PerturbedInsphere, AgreesFromBothSidesOfAFacet) {
    Random random{seed};
    int facets = 0;
    for (int i = 0; i < 20000; ++i) {
        const auto [p, r] = random_tie(random);
        const Points other = {p[0], p[2], p[1], p[4], p[3]};  // the tet across facet 0 1 2, and its apex
        if (orient3d(p) <= 0 || orient3d(other) <= 0) continue;
        ++facets;
        ASSERT_EQ(insphere_perturbed(p, r), insphere_perturbed(other, {r[0], r[2], r[1], r[4], r[3]}))
            << "input " << i << " of seed " << seed;
    }
    EXPECT_GT(facets, 420);
}

// The rule made real: raising the lifts by amounts that grow steeply with rank gives the same signs.
TEST(PerturbedInsphere, IsTheLimitOfRaisedLifts) {
    Random random{seed};
    int ties = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto [p, r] = random_tie(random);
        if (!distinct(p) || orient3d(p) <= 0) continue;
        ++ties;
        mpz_class det = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            Points replaced = p;
            replaced[k] = p[4];
            det += exact_volume(replaced) << static_cast<unsigned>(20 * r[k]);
        }
        det -= exact_volume(p) << static_cast<unsigned>(20 * r[4]);
        ASSERT_EQ(insphere_perturbed(p, r), sgn(det)) << "input " << i << " of seed " << seed;
    }
    EXPECT_GT(ties, 380);
}

}  // namespace
}  // namespace kropla
