#include <kropla/base/index.h>

#include "base/checks.h"
#include "base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

namespace kropla {
namespace {

using Apple = Index<struct AppleTag>;
using Pear = Index<struct PearTag>;

template <class Container, class I>
concept indexable = requires(Container c, I i) { c[i]; };
template <class A, class B>
concept comparable = requires(A a, B b) { a == b; };

static_assert(indexable<Array<Apple, double>, Apple>);
static_assert(!indexable<Array<Apple, double>, Pear>, "an array knows its kind of index");
static_assert(!indexable<Array<Apple, double>, int>, "a number is no index");
static_assert(!indexable<std::vector<double>, Apple>, "an index is no number");
static_assert(!comparable<Apple, Pear>);
static_assert(!std::is_convertible_v<Apple, Pear> && !std::is_constructible_v<Apple, Pear>);
static_assert(!std::is_convertible_v<int, Apple>);
static_assert(sizeof(Apple) == 4 && std::is_trivially_copyable_v<Apple>);

TEST(Index, NamesNothingByDefault) {
    EXPECT_FALSE(Apple{}.exists());
    EXPECT_TRUE(Apple{0}.exists());
    EXPECT_LT(Apple{1}, Apple{2});
}

TEST(Array, LooksAtItsIndexInDeveloperBuilds) {
    if constexpr (!checks) GTEST_SKIP() << "the release build does not look";
    const Array<Apple, double> weight{0.5, 1.5};
    EXPECT_DEATH((void)weight[Apple{2}], "at\\(");
    EXPECT_DEATH((void)weight[Apple{}], "at\\(");
}

TEST(Array, IsVisitedInOrder) {
    Array<Apple, double> weight{0.5, 1.5};
    EXPECT_EQ(weight.push_back(2.5), Apple{2});
    double sum = 0;
    for (Apple a : weight.indices()) sum = 10 * sum + weight[a];
    EXPECT_EQ(sum, 67.5);
}

TEST(Random, IsTheSameInAnyOrderOfAsking) {
    Random random{7};
    std::array<std::uint64_t, 3> drawn{};
    for (auto& bits : drawn) bits = random.bits();
    EXPECT_EQ(random_bits(7, 2), drawn[2]);
    EXPECT_EQ(random_bits(7, 0), drawn[0]);
    EXPECT_NE(random_bits(8, 0), drawn[0]);
}

TEST(Random, NeighbouringSeedsShareNothing) {
    std::vector<std::uint64_t> drawn;
    for (std::uint64_t seed = 0; seed < 100; ++seed)
        for (std::uint64_t n = 0; n < 100; ++n) drawn.push_back(random_bits(seed, n));
    std::ranges::sort(drawn);
    EXPECT_EQ(std::ranges::adjacent_find(drawn), drawn.end());
}

TEST(Random, IsUniform) {
    constexpr int draws = 100000, bins = 10;
    Random random{3};
    std::array<int, bins> count{};
    for (int i = 0; i < draws; ++i) {
        const double x = random.uniform();
        ASSERT_TRUE(x >= 0 && x < 1);
        ++count[static_cast<std::size_t>(bins * x)];
    }
    double chi_squared = 0;  // nine degrees of freedom: below 27.9 with probability 0.999
    for (const int c : count) chi_squared += (c - draws / bins) * (c - draws / bins) / (1.0 * draws / bins);
    EXPECT_LT(chi_squared, 27.9) << "seed " << random.seed;
    for (int i = 0; i < 1000; ++i) ASSERT_LT(random.below(6), 6u);
}

}  // namespace
}  // namespace kropla
