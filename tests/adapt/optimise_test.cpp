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

MovableCells zone_of(const Mesh& mesh) {
    const Snapshot at_time = snapshot(sphere_in_box(), 0);
    return movable(mesh, all_tets(mesh, surroundings), &at_time);
}

TEST(OptimisePlacesOfAZone, HeldVerticesStayAndOthersSlide) {
    const Mesh mesh = spoilt_mesh(1);
    auto [zone, motion] = zone_of(mesh);
    EXPECT_GT(optimise_places(zone, motion, mesh, AdaptOptions{.floor = 5}).value().moved, 0);
    int moved = 0, on_walls = 0;
    for (Vertex v : motion.vertices) {
        const Freedom free = freedom(zone, motion, v);
        for (int axis = 0; axis < 3; ++axis)
            if (!free.along[static_cast<std::size_t>(axis)]) {
                EXPECT_EQ(motion.place[v][axis], mesh.position[v][axis]) << "vertex " << v.value;
            }
        if (motion.place[v] == mesh.position[v]) continue;
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
        auto [zone, motion] = zone_of(mesh);
        const double worst = worst_aspect_ratio(mesh, motion.cells);
        EXPECT_TRUE(optimise_places(zone, motion, mesh, AdaptOptions{.good_enough = worst, .floor = worst}));
        EXPECT_NE(motion.place, mesh.position);
        for (Tet t : motion.cells) EXPECT_LE(motion.ratio[t], worst);
    }
}

TEST(OptimisePlacesOfAZone, LeavesFewBadCellsAndKnowsTheirRatios) {
    const AdaptOptions options{.relaxations = 2};  // one is enough for what a step spoils
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = spoilt_mesh(seed);
        auto [zone, motion] = zone_of(mesh);
        measure(motion, mesh);
        const auto ratio = [&motion = motion](Tet t) { return motion.ratio[t]; };
        const auto is_bad = [&motion = motion, &options](Tet t) { return motion.ratio[t] > options.good_enough; };
        const auto bad_before = std::ranges::count_if(motion.cells, is_bad);
        const double worst_before = motion.ratio[std::ranges::max(motion.cells, {}, ratio)];
        EXPECT_TRUE(optimise_places(zone, motion, mesh, options));
        EXPECT_LT(11 * std::ranges::count_if(motion.cells, is_bad), bad_before);
        EXPECT_LT(motion.ratio[std::ranges::max(motion.cells, {}, ratio)], worst_before);
        write_places(motion, mesh);
        EXPECT_EQ(verify(mesh), "");
        for (Tet t : motion.cells) EXPECT_EQ(motion.ratio[t], aspect_ratio(mesh, t));
    }
}

TEST(OptimisePlacesOfAZone, MovesNothingIfACellIsTurnedOver) {
    const Mesh mesh = shaken_mesh(1, 5);
    auto [zone, motion] = zone_of(mesh);
    const auto is_free = [&zone = zone, &motion = motion](Vertex v) {
        return freedom(zone, motion, v).along == std::array{true, true, true};
    };
    const Vertex v = *std::ranges::find_if(motion.vertices, is_free);
    motion.place[v] += Vec3{2, 0, 0};  // through its link
    const auto places = motion.place;
    EXPECT_FALSE(optimise_places(zone, motion, mesh, AdaptOptions{}));
    EXPECT_EQ(motion.place, places);
}

TEST(OptimisePlacesOfAZone, EqualisesVolumes) {
    const Mesh mesh = spoilt_mesh(2);
    auto [zone, motion] = zone_of(mesh);
    const auto mean_ratio = [&mesh, &motion = motion] {
        double sum = 0;
        for (Tet t : motion.cells) sum += aspect_ratio(motion, mesh, t);
        return sum / static_cast<double>(motion.cells.size());
    };
    const double before = mean_ratio();
    EXPECT_TRUE(optimise_places(zone, motion, mesh, AdaptOptions{}));
    EXPECT_LT(mean_ratio(), 0.33 * before);
}

TEST(OptimisePlacesOfAZone, SameBitsForAnyNumberOfThreads) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Mesh mesh = spoilt_mesh(seed);
        const auto optimised = [&] {
            auto [zone, motion] = zone_of(mesh);
            EXPECT_TRUE(optimise_places(zone, motion, mesh, AdaptOptions{}));
            return motion;
        };
        const ZoneMotion by_one = with_threads(1, optimised), by_two = with_threads(2, optimised);
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
