#include "mesh/numbering.h"

#include "base/random.h"
#include "mesh/mesh.h"

#include <gtest/gtest.h>

#include <map>

namespace kropla {
namespace {

TEST(Numbering, GivesConsecutiveNumbersInTheOrderOfAdding) {
    Numbering<Vertex> number;
    EXPECT_EQ(number(Vertex(7)), -1);
    EXPECT_EQ(number.add(Vertex(7)), 0);
    EXPECT_EQ(number.add(Vertex(0)), 1);
    EXPECT_EQ(number.add(Vertex(3)), 2);
    EXPECT_EQ(number(Vertex(7)), 0);
    EXPECT_EQ(number(Vertex(0)), 1);
    EXPECT_EQ(number(Vertex(3)), 2);
    EXPECT_EQ(number(Vertex(1)), -1) << "below one that is known";
    EXPECT_EQ(number(Vertex(1000)), -1) << "beyond all that are known";
}

TEST(Numbering, ForgetsAllWhenCleared) {
    Numbering<Vertex> number;
    for (int i = 0; i < 10; ++i) number.add(Vertex(i));
    number.clear();
    for (int i = 0; i < 10; ++i) EXPECT_EQ(number(Vertex(i)), -1);
    EXPECT_EQ(number.add(Vertex(4)), 0) << "numbers begin again";
    EXPECT_EQ(number(Vertex(4)), 0);
    EXPECT_EQ(number(Vertex(0)), -1);
}

TEST(Numbering, KeepsWhatItKnowsAsIndicesGrow) {
    Numbering<Tet> number;
    number.add(Tet(5));
    EXPECT_EQ(number.add(Tet(3'000'000)), 1);
    EXPECT_EQ(number.add(Tet(3'000'001)), 2);
    EXPECT_EQ(number(Tet(5)), 0);
    EXPECT_EQ(number(Tet(3'000'000)), 1);
    EXPECT_EQ(number(Tet(2'999'999)), -1);
}

TEST(Numbering, AgreesWithAMapOverManyRounds) {
    Random random{1};
    Numbering<Vertex> number;
    for (int round = 0; round < 50; ++round) {
        SCOPED_TRACE("seed 1, round " + std::to_string(round));
        std::map<Vertex, int> known;
        for (int i = 0; i < 40; ++i) {
            const Vertex v(std::size_t(random.below(60)));
            if (known.contains(v)) continue;
            const int next = static_cast<int>(known.size());
            known[v] = next;
            ASSERT_EQ(number.add(v), next);
        }
        for (int i = 0; i < 60; ++i) {
            const auto found = known.find(Vertex(i));
            ASSERT_EQ(number(Vertex(i)), found == known.end() ? -1 : found->second);
        }
        number.clear();
    }
}

}  // namespace
}  // namespace kropla
