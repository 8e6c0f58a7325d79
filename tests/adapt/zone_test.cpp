#include "adapt/zone.h"

#include "adapt/cases.h"
#include "adapt/way.h"
#include "base/random.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

Mesh sphere_mesh() { return improved_mesh(sphere_in_box(), 1); }

/// A part of the surroundings, chosen at random.
std::vector<Tet> random_part(const Mesh& mesh, double share, Random& random) {
    std::vector<Tet> part;
    for (Tet t : all_tets(mesh, surroundings))
        if (random.uniform() < share) part.push_back(t);
    return part;
}

TEST(Zone, HasTheCellsTheirVerticesAndPlaces) {
    const Mesh mesh = sphere_mesh();
    const auto cells = all_tets(mesh, surroundings);
    const auto [zone, motion] = movable(mesh, cells);
    ASSERT_EQ(motion.cells, cells);
    std::vector<Vertex> expected;
    for (Tet t : cells) {
        EXPECT_TRUE(zone.holds.contains(t));
        EXPECT_EQ(aspect_ratio(motion, mesh, t), aspect_ratio(mesh, t));
        expected.insert(expected.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    }
    std::ranges::sort(expected);
    expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
    EXPECT_EQ(motion.vertices, expected);
    for (Vertex v : motion.vertices) EXPECT_EQ(motion.place[v], mesh.position[v]);
}

std::vector<Tet> ball_within(const Mesh& mesh, const Zone& zone, Vertex v) {
    auto tets = ball(mesh, v);
    std::erase_if(tets, [&](Tet t) { return !zone.holds.contains(t); });
    std::ranges::sort(tets);
    return tets;
}

TEST(Zone, BallsAreThoseOfTheMeshWithinTheZone) {
    const Mesh mesh = sphere_mesh();
    Random random{1};
    for (double share : {0.1, 0.5, 1.0}) {
        SCOPED_TRACE("seed 1, share " + std::to_string(share));
        auto [zone, motion] = movable(mesh, random_part(mesh, share, random));
        for (Vertex v : motion.vertices) ASSERT_EQ(zone.ball[v], ball_within(mesh, zone, v));
    }
}

TEST(Zone, VerticesOnTheBoxSlideOnItAndThoseOfInterfacesAreHeld) {
    const Mesh mesh = sphere_mesh();
    auto [zone, motion] = movable(mesh, all_tets(mesh, surroundings));
    std::array<int, 4> count{};  // of vertices that slide along so many axes
    for (Vertex v : motion.vertices) {
        const Constraint held = constraint(mesh, v, ball(mesh, v));
        const Freedom free = freedom(zone, motion, v);
        for (unsigned axis = 0; axis < 3; ++axis) {
            const bool on_wall = (held.patches >> (2 * axis) & 3) != 0;
            EXPECT_EQ(free.along[axis], !on_wall && !held.on_interface) << "vertex " << v.value;
        }
        ++count[static_cast<std::size_t>(std::ranges::count(free.along, true))];
    }
    EXPECT_GE(count[0], 8 + 20) << "corners of the box, the sphere";
    for (std::size_t axes = 1; axes < 4; ++axes) EXPECT_GE(count[axes], 36) << axes << " axes";
}

TEST(Zone, FacetsOfOtherPatchesHoldTheirVertices) {
    Mesh mesh = sphere_mesh();
    rename_patch(mesh, Patch(0), rigid_patch);
    auto [zone, motion] = movable(mesh, all_tets(mesh, surroundings));
    int held = 0;
    for (Vertex v : motion.vertices) {
        if (mesh.position[v].x != sphere_in_box().box.min.x) continue;
        EXPECT_TRUE(freedom(zone, motion, v).none());
        ++held;
    }
    EXPECT_GE(held, 28);
}

TEST(Zone, OnlyVerticesWithAllTheirCellsInTheZoneAreFree) {
    const Mesh mesh = sphere_mesh();
    Random random{2};
    int free = 0, rim = 0;
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE("seed 2, round " + std::to_string(round));
        auto [zone, motion] = movable(mesh, random_part(mesh, random.uniform(0.6, 1), random));
        for (Vertex v : motion.vertices) {
            const auto whole = ball(mesh, v);
            const bool complete = zone.ball[v].size() == whole.size();
            const bool may_move = !freedom(constraint(mesh, v, whole)).none();
            EXPECT_EQ(!freedom(zone, motion, v).none(), complete && may_move) << "vertex " << v.value;
            if (!constraint(mesh, v, whole).on_interface) {
                EXPECT_EQ((zone.axes[v] & Zone::rim) != 0, !complete) << "vertex " << v.value;
            }
            if (may_move) ++(complete ? free : rim);
        }
    }
    EXPECT_GE(free, 740);
    EXPECT_GE(rim, 3400);
}

TEST(Zone, WhatMovesWithABodyOrNotAtAllIsNotFree) {
    const Mesh mesh = sphere_mesh();
    const auto vertices = all_vertices(mesh);
    const auto is_free = [&](Vertex v) { return constraint(mesh, v, ball(mesh, v)).free(); };
    const Vertex v = *std::ranges::find_if(vertices, is_free);
    auto [zone, motion] = movable(mesh, ball(mesh, v));
    EXPECT_FALSE(freedom(zone, motion, v).none());
    motion.moves[v] = ZoneMotion::with_body;
    EXPECT_TRUE(freedom(zone, motion, v).none());
    begin_motion(motion);
    EXPECT_TRUE(freedom(zone, motion, v).none());
    EXPECT_TRUE(motion.cells.empty());
    EXPECT_EQ(zone.holds.size(), ball(mesh, v).size());
}

/// Does the zone say what one would that was gathered from its cells?
void expect_as_fresh(const Zone& zone, const Mesh& mesh) {
    std::vector<Tet> cells;
    zone.holds.for_each([&](Tet t) { cells.push_back(t); });
    EXPECT_EQ(zone.holds.size(), cells.size());
    const auto [fresh, motion] = movable(mesh, cells);
    std::vector<Vertex> vertices;
    zone.has.for_each([&](Vertex v) { vertices.push_back(v); });
    ASSERT_EQ(vertices, motion.vertices);
    for (Vertex v : vertices) {
        ASSERT_EQ(zone.ball[v], fresh.ball[v]) << "vertex " << v.value;
        ASSERT_EQ(zone.axes[v], fresh.axes[v]) << "vertex " << v.value;
    }
}

TEST(Zone, ListsTheCellsWithAVertexThatMoves) {
    const Mesh mesh = sphere_mesh();
    auto [zone, motion] = movable(mesh, all_tets(mesh, surroundings));
    const Vertex v = motion.vertices[motion.vertices.size() / 2];
    begin_motion(motion);
    motion.moves[v] = ZoneMotion::by_itself;
    list_cells(zone, motion, mesh);
    EXPECT_EQ(motion.cells, ball_within(mesh, zone, v));
    IndexSet<Tet> stay;
    for (Tet t : motion.cells) stay.insert(t);
    shrink(zone, mesh, stay);
    EXPECT_EQ(zone.holds.list(), motion.cells);
    expect_as_fresh(zone, mesh);
}

TEST(Zone, FollowsAMeshThatIsTakenBack) {
    const Mesh before = sphere_mesh();
    Mesh mesh = compact(before).mesh;  // no free slots: what is inserted comes at the end
    const Mesh start = mesh;
    Zone zone;
    add_cells(zone, mesh, all_tets(mesh, surroundings));
    Domain finer = sphere_in_box();
    finer.size = {0.25, 0, 0.25};
    const Changes changes = adapt_to_size(mesh, all_tets(mesh, surroundings), snapshot(finer, 0));
    ASSERT_GT(mesh.position.size(), start.position.size());
    IndexSet<Tet> replaced;
    for (Tet t : changes.cells) replaced.insert(t);
    for (Tet t : changes.removed) replaced.insert(t);
    follow(zone, mesh, replaced);
    expect_as_fresh(zone, mesh);
    follow(zone, start, replaced);
    expect_as_fresh(zone, start);
    follow(zone, mesh, replaced);
    expect_as_fresh(zone, mesh);
}

TEST(Zone, FollowsAMeshWhoseCellsAreReplaced) {
    Domain crowded = sphere_in_box();
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed};
        Mesh mesh = improved_mesh(crowded, seed);
        Zone zone;
        add_cells(zone, mesh, seed == 1 ? all_tets(mesh, surroundings) : random_part(mesh, 0.7, random));
        int splits = 0, collapses = 0, swaps = 0;
        for (int round = 0; round < 12; ++round) {
            // Sizes that ask for other vertices in each round, so that slots are freed and taken again.
            crowded.size.surface = random.uniform(0.25, 0.5);
            crowded.size.far = random.uniform(0.5, 0.9);
            const Snapshot at_time = snapshot(crowded, 0);
            const auto part = random_part(mesh, 0.3, random);
            Changes changes = adapt_to_size(mesh, part, at_time);
            changes += improve(mesh, changes.cells, at_time);
            IndexSet<Tet> replaced;
            for (Tet t : changes.cells) replaced.insert(t);
            for (Tet t : changes.removed) replaced.insert(t);
            follow(zone, mesh, replaced);
            expect_as_fresh(zone, mesh);
            splits += changes.splits;
            collapses += changes.collapses;
            swaps += changes.swaps;
        }
        EXPECT_GE(splits, 420);
        EXPECT_GE(collapses, 320);
        EXPECT_GE(swaps, 790);
        ASSERT_EQ(verify(mesh), "");
    }
}

TEST(Zone, WritePlacesMovesItsVerticesOnly) {
    Mesh mesh = sphere_mesh();
    const Mesh before = mesh;
    auto [zone, motion] = movable(mesh, std::array{Tet(0), Tet(1)});
    for (Vertex v : motion.vertices) motion.place[v] += Vec3{0.01, 0.02, 0.03};
    EXPECT_EQ(mesh, before) << "nothing before write_places";
    write_places(motion, mesh);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 way = zone.has.contains(v) ? Vec3{0.01, 0.02, 0.03} : Vec3{};
        EXPECT_EQ(mesh.position[v], before.position[v] + way);
    }
    mesh.position = before.position;
    EXPECT_EQ(mesh, before);
}

TEST(Zone, HoldsEachCellOnceInAscendingOrder) {
    const Mesh mesh = sphere_mesh();
    auto [zone, motion] = movable(mesh, std::array{Tet(7), Tet(2), Tet(7), Tet(90), Tet(2)});
    EXPECT_EQ(motion.cells, (std::vector{Tet(2), Tet(7), Tet(90)}));
}

TEST(Zone, ItsWayIsAsSafeAsThatOfTheLeastSafeCell) {
    const Mesh mesh = sphere_mesh();
    SCOPED_TRACE("seed 4");
    Random random{4};
    int arrived = 0, stopped = 0;
    for (double reach : {0.01, 0.05, 0.1, 0.3}) {
        auto [zone, motion] = movable(mesh, all_tets(mesh, surroundings));
        const auto up_to = [&] { return random.uniform(-reach, reach); };
        for (Vertex v : motion.vertices) motion.place[v] += Vec3{up_to(), up_to(), up_to()};
        const MoveReport report = check_way(motion, mesh, mesh.position, 0.05);
        EXPECT_NEAR(report.fraction, safe_fraction(mesh, motion.cells, mesh.position, motion.place, 0.05), 1e-12);
        EXPECT_EQ(report.arrived, report.fraction == 1);
        (report.arrived ? arrived : stopped)++;
        if (!report.arrived) {
            EXPECT_NEAR(report.fraction, safe_fraction(mesh, {&report.limiting, 1}, mesh.position, motion.place, 0.05),
                        1e-12);
        }
    }
    EXPECT_GE(arrived, 2);
    EXPECT_GE(stopped, 1);
}

}  // namespace
}  // namespace kropla
