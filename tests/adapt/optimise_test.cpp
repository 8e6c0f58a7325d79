#include "adapt/cases.h"
#include "adapt/threads.h"
#include "adapt/zone.h"
#include "base/random.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

/// The sphere's mesh with its inner vertices moved at random where no cell becomes worse than `worst`.
Mesh shaken_mesh(std::uint64_t seed, double worst) {
    Mesh mesh = improved_mesh(sphere_in_box(), seed);
    Random random{seed};
    for (Vertex v : all_vertices(mesh)) {
        const auto around = ball(mesh, v);
        if (!constraint(mesh, v, around).free()) continue;
        const Vec3 here = mesh.position[v];
        mesh.position[v] += 0.08 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        if (worst_aspect_ratio(mesh, around) > worst) mesh.position[v] = here;
    }
    return mesh;
}

/// The same with some cells spoilt.
Mesh spoilt_mesh(std::uint64_t seed) {
    Mesh mesh = shaken_mesh(seed, 40);
    spoil(mesh, surroundings, 10, seed);
    return mesh;
}

Zone zone_of(const Mesh& mesh) {
    Zone zone;
    gather(zone, mesh, all_tets(mesh, surroundings));
    find_sizes(zone, snapshot(sphere_in_box(), 0));
    return zone;
}

TEST(OptimisePlacesOfAZone, HeldVerticesStayAndOthersSlide) {
    const Mesh mesh = spoilt_mesh(1);
    Zone zone = zone_of(mesh);
    EXPECT_GT(optimise_places(zone, mesh, AdaptOptions{.floor = 5}).value().moved, 0);
    int moved = 0, on_walls = 0;
    for (Vertex v : zone.vertices) {
        const Freedom free = freedom(zone, v);
        for (int axis = 0; axis < 3; ++axis)
            if (!free.along[static_cast<std::size_t>(axis)]) {
                EXPECT_EQ(zone.place[v][axis], mesh.position[v][axis]) << "vertex " << v.value;
            }
        if (zone.place[v] == mesh.position[v]) continue;
        ++moved;
        on_walls += std::ranges::count(free.along, true) < 3;
    }
    EXPECT_GE(moved, 190);
    EXPECT_GE(on_walls, 99);
}

TEST(OptimisePlacesOfAZone, TakesNoCellNearTheFloorIfNoneIs) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = shaken_mesh(seed, 5);
        Zone zone = zone_of(mesh);
        const double worst = worst_aspect_ratio(mesh, zone.cells);
        EXPECT_TRUE(optimise_places(zone, mesh, AdaptOptions{.good_enough = worst, .floor = worst}));
        EXPECT_NE(zone.place, mesh.position);
        for (Tet t : zone.cells) EXPECT_LE(zone.ratio[t], worst);
    }
}

TEST(OptimisePlacesOfAZone, LeavesFewBadCellsAndKnowsTheirRatios) {
    const AdaptOptions options{.relaxations = 2};  // one is enough for what a step spoils
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = spoilt_mesh(seed);
        Zone zone = zone_of(mesh);
        measure(zone, mesh);
        const auto ratio = [&](Tet t) { return zone.ratio[t]; };
        const auto is_bad = [&](Tet t) { return zone.ratio[t] > options.good_enough; };
        const auto bad_before = std::ranges::count_if(zone.cells, is_bad);
        const double worst_before = zone.ratio[std::ranges::max(zone.cells, {}, ratio)];
        EXPECT_TRUE(optimise_places(zone, mesh, options));
        EXPECT_LT(11 * std::ranges::count_if(zone.cells, is_bad), bad_before);
        EXPECT_LT(zone.ratio[std::ranges::max(zone.cells, {}, ratio)], worst_before);
        write_places(zone, mesh);
        EXPECT_EQ(verify(mesh), "");
        for (Tet t : zone.cells) EXPECT_EQ(zone.ratio[t], aspect_ratio(mesh, t));
    }
}

TEST(OptimisePlacesOfAZone, MovesNothingIfACellIsTurnedOver) {
    const Mesh mesh = shaken_mesh(1, 5);
    Zone zone = zone_of(mesh);
    const auto is_free = [&](Vertex v) { return freedom(zone, v).along == std::array{true, true, true}; };
    const Vertex v = *std::ranges::find_if(zone.vertices, is_free);
    zone.place[v] += Vec3{2, 0, 0};  // through its link
    const auto places = zone.place;
    EXPECT_FALSE(optimise_places(zone, mesh, AdaptOptions{}));
    EXPECT_EQ(zone.place, places);
}

TEST(OptimisePlacesOfAZone, EqualisesVolumes) {
    const Mesh mesh = spoilt_mesh(2);
    Zone zone = zone_of(mesh);
    const auto mean_ratio = [&] {
        double sum = 0;
        for (Tet t : zone.cells) sum += aspect_ratio(zone, mesh, t);
        return sum / static_cast<double>(zone.cells.size());
    };
    const double before = mean_ratio();
    EXPECT_TRUE(optimise_places(zone, mesh, AdaptOptions{}));
    EXPECT_LT(mean_ratio(), 0.33 * before);
}

TEST(OptimisePlacesOfAZone, SameBitsForAnyNumberOfThreads) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = spoilt_mesh(seed);
        const auto optimised = [&] {
            Zone zone = zone_of(mesh);
            EXPECT_TRUE(optimise_places(zone, mesh, AdaptOptions{}));
            return zone;
        };
        const Zone by_one = with_threads(1, optimised), by_two = with_threads(2, optimised);
        EXPECT_NE(by_one.place, mesh.position);
        EXPECT_EQ(by_one.place, by_two.place);
        EXPECT_EQ(by_one.ratio, by_two.ratio);
    }
}

TEST(AdaptToSize, SameBitsForAnyNumberOfThreads) {
    const Mesh mesh = spoilt_mesh(1);
    Domain uniform = sphere_in_box();  // crowded at the sphere, sparse far from it
    uniform.size = {0.6, 0, 0.6};
    const auto adapted = [&] {
        Mesh result = mesh;
        const Changes changes = adapt_to_size(result, all_tets(mesh, surroundings), snapshot(uniform, 0));
        EXPECT_GT(changes.splits, 0);
        EXPECT_GT(changes.collapses, 0);
        return result;
    };
    const Mesh by_one = with_threads(1, adapted);
    EXPECT_EQ(verify(by_one), "");
    EXPECT_EQ(by_one, with_threads(2, adapted));
}

TEST(Improve, SameBitsForAnyNumberOfThreads) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = spoilt_mesh(seed);
        const auto improved = [&] {
            Mesh result = mesh;
            const Changes changes = improve(result, all_tets(mesh), snapshot(sphere_in_box(), 0));
            EXPECT_GT(changes.swaps, 58);
            return result;
        };
        const Mesh by_one = with_threads(1, improved);
        EXPECT_NE(by_one, mesh);
        EXPECT_EQ(by_one, with_threads(2, improved));
    }
}

}  // namespace
}  // namespace kropla
