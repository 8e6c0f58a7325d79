#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "base/random.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

using Key = std::array<Vertex, 3>;

/// The facets that bound the cells added to it, by their vertices, but for those on the boundary.
class OuterFacets {
public:
    void add(const std::array<Vertex, 4>& v, const std::array<Patch, 4>& patch) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (patch[corner].exists()) continue;
            const auto& [i, j, k] = tet_facets[corner];
            Key key = {v[std::size_t(i)], v[std::size_t(j)], v[std::size_t(k)]};
            std::ranges::sort(key);
            if (!once_.insert(key).second) once_.erase(key);
        }
    }
    [[nodiscard]] const std::set<Key>& keys() const { return once_; }

private:
    std::set<Key> once_;
};

std::set<Key> outer_facets_removed(const Mesh& mesh, const Cavity& cavity) {
    OuterFacets facets;
    for (Tet t : cavity.removed) facets.add(mesh.tets[t], mesh.patch[t]);
    return facets.keys();
}

std::set<Key> outer_facets_added(const Cavity& cavity) {
    OuterFacets facets;
    for (const NewTet& t : cavity.added) facets.add(t.vertices, t.patch);
    return facets.keys();
}

bool touches_the_box(const Mesh& mesh, const Cavity& cavity) {
    return std::ranges::any_of(cavity.removed, [&](Tet t) {
        return std::ranges::any_of(mesh.patch[t], [](Patch p) { return p.exists(); });
    });
}

/// The tets at the tets of the region at `v`.
std::vector<Tet> cluster_at(const Mesh& mesh, Vertex v, Region region) {
    std::set<Tet> cluster;
    for (Tet t : ball(mesh, v))
        for (Vertex w : mesh.tets[t])
            for (Tet n : ball(mesh, w))
                if (mesh.region[n] == region) cluster.insert(n);
    return {cluster.begin(), cluster.end()};
}

/// All that is not of the cluster stays as it is, bit for bit.
void expect_others_untouched(const Mesh& before, const Mesh& after, const Cavity& cavity) {
    const std::set<Tet> removed(cavity.removed.begin(), cavity.removed.end());
    for (Tet t : all_tets(before)) {
        if (removed.contains(t)) continue;
        EXPECT_EQ(after.tets[t], before.tets[t]);
        EXPECT_EQ(after.region[t], before.region[t]);
        EXPECT_EQ(after.patch[t], before.patch[t]);
        for (Vertex v : before.tets[t]) EXPECT_EQ(after.position[v], before.position[v]);
    }
}

TEST(ClusterRemesh, KeepsAllButTheInsideOfTheCluster) {
    const Domain domain = sphere_in_box();
    const Snapshot at = snapshot(domain, 0);
    int done[2] = {0, 0}, grown = 0, at_box = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const Mesh good = improved_mesh(domain, seed);
        for (std::uint64_t round = 0; round < 12; ++round) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", round " + std::to_string(round));
            Mesh mesh = good;
            const Region region(round % 3 == 0 ? 1 : 0);
            const auto spoilt = spoil(mesh, region, 1, 100 * seed + round);
            if (spoilt.empty()) continue;
            const Mesh before = mesh;
            const auto cluster = cluster_at(mesh, spoilt.front(), region);
            const auto cavity = cluster_remesh(mesh, cluster, at);
            if (!cavity) continue;
            const std::set<Tet> removed(cavity->removed.begin(), cavity->removed.end());
            for (Tet t : cluster) EXPECT_TRUE(removed.contains(t));
            for (Tet t : cavity->removed) EXPECT_EQ(mesh.region[t], region);
            for (const NewTet& t : cavity->added) EXPECT_EQ(t.region, region);
            EXPECT_EQ(outer_facets_removed(mesh, *cavity), outer_facets_added(*cavity));
            EXPECT_LT(cavity->worst_after, cavity->worst_before);
            const auto added = replace_cells(mesh, *cavity).cells;
            EXPECT_EQ(verify(mesh), "");
            EXPECT_TRUE(same_shape(properties(mesh), properties(before)));
            if (touches_the_box(before, *cavity)) ++at_box;
            else EXPECT_TRUE(same(properties(mesh), properties(before)));
            EXPECT_NEAR(cavity->worst_after, worst_aspect_ratio(mesh, added), 1e-9);
            expect_others_untouched(before, mesh, *cavity);
            ++done[region.value];
            grown += cavity->removed.size() > cluster.size() ? 1 : 0;
        }
    }
    EXPECT_GE(done[0], 21);
    EXPECT_GE(done[1], 10);
    EXPECT_GE(grown, 1);
    EXPECT_GE(at_box, 21);
}

const Snapshot wide_box{{{-9, -9, -9}, {9, 9, 9}}, {9, 0, 9}, {}};  // no room for points in small clusters

TEST(ClusterRemesh, RefusesWithoutGain) {
    Mesh mesh = regular_tet();
    rename_patch(mesh, Patch(0), rigid_patch);
    EXPECT_FALSE(cluster_remesh(mesh, {Tet(0)}, wide_box));
}

/// Six tets around the long edge 0-1 in rigid_patch. Of the half with the tets 0, 1, 2 alone, the two facets
/// at the edge in the plane y = 0 are not Delaunay: those at the edge 2-5, which is shorter, are.
Mesh long_shell() {
    Mesh mesh = shell_of_edge(6);
    mesh.position[Vertex(0)].z = -1.7;
    mesh.position[Vertex(1)].z = 1.7;
    mesh.position[Vertex(5)].y = 0;  // without rounding
    rename_patch(mesh, Patch(0), rigid_patch);
    return mesh;
}

TEST(ClusterRemesh, GrowsWhereAFacetIsNotRecovered) {
    Mesh mesh = long_shell();
    mesh.position[Vertex(0)].x = mesh.position[Vertex(1)].x = 0.8;  // so that there is something to gain
    ASSERT_EQ(verify(mesh), "");
    const Properties before = properties(mesh);
    const auto cavity = cluster_remesh(mesh, {Tet(0), Tet(1), Tet(2)}, wide_box);
    ASSERT_TRUE(cavity);
    EXPECT_GE(cavity->removed.size(), 5u);
    replace_cells(mesh, *cavity);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same(properties(mesh), before));
}

TEST(ClusterRemesh, DoesNotGrowAcrossAnInterface) {
    Mesh mesh = long_shell();
    mesh.position[Vertex(0)].x = mesh.position[Vertex(1)].x = 0.8;
    for (int i : {3, 4, 5}) mesh.region[Tet(i)] = Region(1);
    EXPECT_FALSE(cluster_remesh(mesh, {Tet(0), Tet(1), Tet(2)}, wide_box));
}

TEST(ClusterRemesh, SameSeedSameProposal) {
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    const auto spoilt = spoil(mesh, surroundings, 1, 1);
    ASSERT_EQ(spoilt.size(), 1u);
    const auto cluster = cluster_at(mesh, spoilt.front(), surroundings);
    const auto propose = [&] { return cluster_remesh(mesh, cluster, snapshot(domain, 0), {.seed = 7}); };
    const auto first = propose(), second = propose();
    ASSERT_TRUE(first);
    ASSERT_TRUE(second);
    Mesh a = mesh, b = mesh;
    replace_cells(a, *first);
    replace_cells(b, *second);
    EXPECT_EQ(a, b);
}

TEST(Repair, BringsSpoiltCellsBelowTheFloor) {
    const Domain domain = sphere_in_box();
    const Snapshot at = snapshot(domain, 0);
    const AdaptOptions options;
    int local = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = improved_mesh(domain, seed);
        ASSERT_FALSE(spoil(mesh, surroundings, 3, seed).empty());
        ASSERT_GT(worst_of(mesh), 2 * options.floor);
        const Properties before = properties(mesh);
        const Changes changes = repair(mesh, all_tets(mesh), at, options);
        EXPECT_LE(worst_of(mesh), options.floor);
        EXPECT_GE(changes.local_remeshes, 1);
        EXPECT_GE(changes.largest_ring, 1);
        EXPECT_EQ(changes.global_remeshes, 0);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_TRUE(same_shape(properties(mesh), before));
        local += changes.local_remeshes;
    }
    EXPECT_GE(local, 9);
}

TEST(Repair, LeavesAGoodMeshAlone) {
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    const Mesh before = mesh;
    ASSERT_LE(worst_of(mesh), AdaptOptions{}.floor);
    const Changes changes = repair(mesh, all_tets(mesh), snapshot(domain, 0));
    EXPECT_EQ(mesh, before);
    EXPECT_EQ(changes.local_remeshes, 0);
}

TEST(Repair, TakesTheWholeRegionLast) {
    // No ring is allowed, so that only the whole of the surroundings is left.
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    ASSERT_FALSE(spoil(mesh, surroundings, 1, 1).empty());
    const double worst = worst_of(mesh);
    const Properties before = properties(mesh);
    const Changes changes = repair(mesh, all_tets(mesh), snapshot(domain, 0), {.largest_ring = 0});
    EXPECT_EQ(changes.local_remeshes, 0);
    EXPECT_GE(changes.global_remeshes, 1);
    EXPECT_LT(worst_of(mesh), worst);
    EXPECT_EQ(verify(mesh), "");
    EXPECT_TRUE(same_shape(properties(mesh), before));
}

}  // namespace
}  // namespace kropla
