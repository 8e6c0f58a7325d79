#include "adapt/propose.h"

#include "adapt/cases.h"
#include "adapt/threads.h"
#include "mesh/meshes.h"
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

namespace kropla {
namespace {

/// The tets that are replaced, and by how many.
Cavity replacing(std::vector<Tet> removed, std::size_t added = 0) {
    Cavity cavity;
    cavity.removed = std::move(removed);
    cavity.added.resize(added);
    return cavity;
}

TEST(ProposeAll, AsksForEachAndKeepsTheOrder) {
    const auto third = [](std::size_t i) -> std::optional<Cavity> {
        if (i % 3 != 0) return std::nullopt;
        return replacing({Tet(i)});
    };
    EXPECT_TRUE(propose_all(0, third).empty());
    for (std::size_t threads : {1, 2}) {
        const auto proposals = with_threads(threads, [&] { return propose_all(1000, third); });
        ASSERT_EQ(proposals.size(), 334u);
        for (std::size_t i = 0; i < proposals.size(); ++i) {
            EXPECT_EQ(proposals[i].asked, 3 * i);
            EXPECT_EQ(proposals[i].what.removed, std::vector{Tet(3 * i)});
        }
    }
}

TEST(Replaced, OutdatesProposalsThatShareACell) {
    Replaced replaced;
    EXPECT_FALSE(replaced.outdates(replacing({Tet(1), Tet(2)})));
    replaced.add(replacing({Tet(1), Tet(2)}, 3));
    EXPECT_TRUE(replaced.outdates(replacing({Tet(2), Tet(3)})));
    EXPECT_TRUE(replaced.outdates(replacing({Tet(1)})));
    EXPECT_FALSE(replaced.outdates(replacing({Tet(0), Tet(3)})));
    replaced.add(replacing({Tet(3)}));
    EXPECT_TRUE(replaced.outdates(replacing({Tet(0), Tet(3)})));
}

/// The best edge removal at the tet, asked of the mesh as it is.
std::optional<Cavity> best_removal(const Mesh& mesh, Tet t) {
    std::optional<Cavity> best;
    for (const auto& [i, j] : tet_edges) {
        const Edge e{mesh.tets[t][std::size_t(i)], mesh.tets[t][std::size_t(j)]};
        auto cavity = edge_removal(mesh, shell(mesh, e, t), e);
        if (cavity && (!best || cavity->worst_after < best->worst_after)) best = std::move(cavity);
    }
    return best;
}

TEST(Replaced, WhatIsNotOutdatedIsAsGoodAsItWas) {
    Mesh mesh = improved_mesh(sphere_in_box(), 1);
    spoil(mesh, surroundings, 40, 1);
    const auto tets = all_tets(mesh);
    const auto propose = [&](std::size_t i) { return best_removal(mesh, tets[i]); };
    const auto proposals = propose_all(tets.size(), propose);
    Replaced replaced;
    int done = 0, outdated = 0;
    for (const auto& [i, cavity] : proposals) {
        if (replaced.outdates(cavity)) {
            ++outdated;
            continue;
        }
        const auto now = best_removal(mesh, tets[i]);
        ASSERT_TRUE(now);
        EXPECT_LE(now->worst_after, cavity.worst_after);  // another edge may have become better
        replaced.add(cavity);
        replace_cells(mesh, cavity);
        ASSERT_EQ(verify(mesh), "") << "proposal " << i;
        ++done;
    }
    EXPECT_GE(done, 92);
    EXPECT_GE(outdated, 440);
}

}  // namespace
}  // namespace kropla
