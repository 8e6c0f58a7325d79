#include "mesh/index_set.h"

#include "base/random.h"
#include <kropla/mesh/mesh.h>

#include <gtest/gtest.h>

#include <set>

namespace kropla {
namespace {

std::vector<Tet> members(const IndexSet<Tet>& set) {
    std::vector<Tet> all;
    set.for_each([&](Tet t) { all.push_back(t); });
    return all;
}

TEST(IndexSet, HoldsWhatWasInsertedInAscendingOrder) {
    constexpr std::uint64_t seed = 5;
    SCOPED_TRACE("seed 5");
    Random random{seed};
    IndexSet<Tet> set;
    std::set<Tet> expected;
    for (int i = 0; i < 500; ++i) {
        const Tet t(static_cast<std::int32_t>(random.below(1000)));
        EXPECT_EQ(set.insert(t), expected.insert(t).second);
    }
    EXPECT_EQ(members(set), std::vector(expected.begin(), expected.end()));
    EXPECT_EQ(set.size(), expected.size());
    for (int i = 0; i < 2000; ++i) EXPECT_EQ(set.contains(Tet(i)), expected.contains(Tet(i))) << i;
}

TEST(IndexSet, HoldsBothEndsOfAWord) {
    IndexSet<Tet> set;
    for (int i : {128, 63, 64, 0, 127}) EXPECT_TRUE(set.insert(Tet(i)));
    EXPECT_EQ(members(set), (std::vector{Tet(0), Tet(63), Tet(64), Tet(127), Tet(128)}));
}

TEST(IndexSet, HoldsWhatIsFarApartAndForgetsWhatIsErased) {
    SCOPED_TRACE("seed 6");
    Random random{6};
    IndexSet<Tet> set;
    std::set<Tet> expected;
    for (int i = 0; i < 3000; ++i) {
        const Tet t(static_cast<std::int32_t>(random.below(100'000)));
        set.insert(t);
        expected.insert(t);
    }
    for (int i = 0; i < 30'000; ++i) {
        const Tet t(static_cast<std::int32_t>(random.below(200'000)));
        set.erase(t);
        expected.erase(t);
    }
    EXPECT_EQ(set.list(), std::vector(expected.begin(), expected.end()));
    EXPECT_EQ(set.size(), expected.size());
    EXPECT_FALSE(set.contains(Tet(10'000'000)));
    const IndexSet<Tet> copy = set;
    set.for_each([&](Tet t) {
        if (t.value % 2 == 0) set.erase(t);
    });
    std::erase_if(expected, [](Tet t) { return t.value % 2 == 0; });
    EXPECT_EQ(set.list(), std::vector(expected.begin(), expected.end()));
    EXPECT_GT(copy.size(), set.size());
}

TEST(IndexSet, IsEmptyWhenCleared) {
    IndexSet<Tet> set;
    set.insert(Tet(3));
    set.insert(Tet(30'000));
    set.clear();
    EXPECT_FALSE(set.contains(Tet(3)));
    EXPECT_FALSE(set.contains(Tet(30'000)));
    EXPECT_EQ(set.size(), 0u);
    EXPECT_TRUE(members(set).empty());
    EXPECT_TRUE(set.insert(Tet(3)));
}

}  // namespace
}  // namespace kropla
