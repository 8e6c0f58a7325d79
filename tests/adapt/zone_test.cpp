#include "adapt/zone.h"

#include "adapt/cases.h"
#include "base/random.h"
#include "mesh/quality.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace kropla {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

Mesh sphere_mesh() { return improved_mesh(sphere_in_box(), 1); }

std::vector<Tet> ball_in(const Zone& zone, std::size_t v) {
    std::vector<Tet> tets;
    for (int i = zone.ball_begin[v]; i < zone.ball_begin[v + 1]; ++i)
        tets.push_back(zone.cells[at(zone.ball[at(i)])]);
    std::ranges::sort(tets);
    return tets;
}

/// A part of the surroundings, chosen at random.
std::vector<Tet> random_part(const Mesh& mesh, double share, Random& random) {
    std::vector<Tet> part;
    for (Tet t : all_tets(mesh, surroundings))
        if (random.uniform() < share) part.push_back(t);
    return part;
}

TEST(Zone, HasTheCellsTheirVerticesAndPlaces) {
    const Mesh mesh = sphere_mesh();
    Zone zone;
    const auto cells = all_tets(mesh, surroundings);
    gather(zone, mesh, cells);
    ASSERT_EQ(zone.cells, cells);
    for (std::size_t c = 0; c < cells.size(); ++c) {
        EXPECT_TRUE(zone.holds.contains(cells[c]));
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_EQ(zone.vertices[at(zone.corners[c][i])], mesh.tets[cells[c]][i]);
        EXPECT_EQ(aspect_ratio(zone, static_cast<int>(c)), aspect_ratio(mesh, cells[c]));
    }
    for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
        EXPECT_EQ(zone.number(zone.vertices[v]), static_cast<int>(v));
        EXPECT_EQ(zone.start[v], mesh.position[zone.vertices[v]]);
        EXPECT_EQ(zone.place[v], zone.start[v]);
    }
}

TEST(Zone, BallsAreThoseOfTheMeshWithinTheZone) {
    const Mesh mesh = sphere_mesh();
    Random random{1};
    for (double share : {0.1, 0.5, 1.0}) {
        SCOPED_TRACE("seed 1, share " + std::to_string(share));
        Zone zone;
        gather(zone, mesh, random_part(mesh, share, random));
        for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
            auto expected = ball(mesh, zone.vertices[v]);
            std::erase_if(expected, [&](Tet t) { return !zone.holds.contains(t); });
            std::ranges::sort(expected);
            ASSERT_EQ(ball_in(zone, v), expected);
        }
    }
}

TEST(Zone, VerticesOnTheBoxSlideOnItAndThoseOfInterfacesAreHeld) {
    const Mesh mesh = sphere_mesh();
    Zone zone;
    gather(zone, mesh, all_tets(mesh, surroundings));
    std::array<int, 4> count{};  // of vertices that slide along so many axes
    for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
        const Vertex vertex = zone.vertices[v];
        const Constraint held = constraint(mesh, vertex, ball(mesh, vertex));
        const Freedom free = freedom(zone, static_cast<int>(v));
        for (unsigned axis = 0; axis < 3; ++axis) {
            const bool on_wall = (held.patches >> (2 * axis) & 3) != 0;
            EXPECT_EQ(free.along[axis], !on_wall && !held.on_interface) << "vertex " << vertex.value;
        }
        ++count[static_cast<std::size_t>(std::ranges::count(free.along, true))];
    }
    EXPECT_GE(count[0], 8 + 20) << "corners of the box, the sphere";
    for (std::size_t axes = 1; axes < 4; ++axes) EXPECT_GE(count[axes], 10) << axes << " axes";
}

TEST(Zone, FacetsOfOtherPatchesHoldTheirVertices) {
    Mesh mesh = sphere_mesh();
    rename_patch(mesh, Patch(0), rigid_patch);
    Zone zone;
    gather(zone, mesh, all_tets(mesh, surroundings));
    int held = 0;
    for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
        if (zone.start[v].x != sphere_in_box().box.min.x) continue;
        EXPECT_TRUE(freedom(zone, static_cast<int>(v)).none());
        ++held;
    }
    EXPECT_GE(held, 10);
}

TEST(Zone, OnlyVerticesWithAllTheirCellsInTheZoneAreFree) {
    const Mesh mesh = sphere_mesh();
    Random random{2};
    int free = 0, rim = 0;
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE("seed 2, round " + std::to_string(round));
        Zone zone;
        gather(zone, mesh, random_part(mesh, random.uniform(0.6, 1), random));
        for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
            const auto whole = ball(mesh, zone.vertices[v]);
            const bool complete = ball_in(zone, v).size() == whole.size();
            const bool may_move = !freedom(constraint(mesh, zone.vertices[v], whole)).none();
            EXPECT_EQ(zone.axes[v] != 0, complete && may_move) << "vertex " << zone.vertices[v].value;
            if (may_move) ++(complete ? free : rim);
        }
    }
    EXPECT_GE(free, 100);
    EXPECT_GE(rim, 100);
}

TEST(Zone, HoldsWhatIsAddedHeld) {
    const Mesh mesh = sphere_mesh();
    const auto vertices = all_vertices(mesh);
    const auto is_free = [&](Vertex v) { return constraint(mesh, v, ball(mesh, v)).free(); };
    const Vertex v = *std::ranges::find_if(vertices, is_free);
    Zone zone;
    add_held(zone, mesh, v);
    for (Tet t : ball(mesh, v)) zone.holds.insert(t);
    close(zone, mesh);
    EXPECT_EQ(zone.number(v), 0);
    EXPECT_TRUE(freedom(zone, 0).none());
    gather(zone, mesh, ball(mesh, v));
    EXPECT_FALSE(freedom(zone, zone.number(v)).none());
}

TEST(Zone, WritePlacesMovesItsVerticesOnly) {
    Mesh mesh = sphere_mesh();
    const Mesh before = mesh;
    Zone zone;
    gather(zone, mesh, std::array{Tet(0), Tet(1)});
    for (Vec3& x : zone.place) x += Vec3{0.01, 0.02, 0.03};
    EXPECT_EQ(mesh, before) << "nothing before write_places";
    write_places(zone, mesh);
    for (Vertex v : mesh.position.indices()) {
        const Vec3 way = zone.number(v) >= 0 ? Vec3{0.01, 0.02, 0.03} : Vec3{};
        EXPECT_EQ(mesh.position[v], before.position[v] + way);
    }
    mesh.position = before.position;
    EXPECT_EQ(mesh, before);
}

TEST(Zone, OneThatWasUsedIsAsGoodAsNew) {
    const Mesh mesh = sphere_mesh();
    Random random{3};
    Zone used;
    for (int round = 0; round < 5; ++round) {
        const auto part = random_part(mesh, random.uniform(0.1, 1), random);
        Zone fresh;
        gather(fresh, mesh, part);
        gather(used, mesh, part);
        EXPECT_EQ(used.cells, fresh.cells);
        EXPECT_EQ(used.corners, fresh.corners);
        EXPECT_EQ(used.vertices, fresh.vertices);
        EXPECT_EQ(used.place, fresh.place);
        EXPECT_EQ(used.axes, fresh.axes);
        EXPECT_EQ(used.ball_begin, fresh.ball_begin);
        EXPECT_EQ(used.ball, fresh.ball);
    }
}

TEST(Zone, HoldsEachCellOnceInAscendingOrder) {
    const Mesh mesh = sphere_mesh();
    Zone zone;
    gather(zone, mesh, std::array{Tet(7), Tet(2), Tet(7), Tet(90), Tet(2)});
    EXPECT_EQ(zone.cells, (std::vector{Tet(2), Tet(7), Tet(90)}));
}

TEST(Zone, ItsWayIsAsSafeAsThatOfTheLeastSafeCell) {
    const Mesh mesh = sphere_mesh();
    SCOPED_TRACE("seed 4");
    Random random{4};
    int arrived = 0, stopped = 0;
    for (double reach : {0.01, 0.05, 0.1, 0.3}) {
        Zone zone;
        gather(zone, mesh, all_tets(mesh, surroundings));
        Array<Vertex, Vec3> displacement(mesh.position.size());
        const auto up_to = [&] { return random.uniform(-reach, reach); };
        for (std::size_t v = 0; v < zone.vertices.size(); ++v) {
            const Vec3 way = {up_to(), up_to(), up_to()};
            zone.place[v] += way;
            displacement[zone.vertices[v]] = way;
        }
        const MoveReport report = check_way(zone, 0.05);
        EXPECT_NEAR(report.fraction, safe_fraction(mesh, zone.cells, displacement, 0.05), 1e-4);
        EXPECT_EQ(report.arrived, report.fraction == 1);
        (report.arrived ? arrived : stopped)++;
        if (!report.arrived) {
            EXPECT_NEAR(report.fraction, safe_fraction(mesh, {&report.limiting, 1}, displacement, 0.05), 1e-4);
        }
    }
    EXPECT_GE(arrived, 1);
    EXPECT_GE(stopped, 1);
}

}  // namespace
}  // namespace kropla
