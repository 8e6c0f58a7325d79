#include "adapt/zone.h"
#include "adapt/cases.h"
#include "adapt/stepping.h"
#include "adapt/way.h"
#include "base/random.h"
#include "domain/surfaces.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

const Tet only{0};

/// The volume of a one-tet mesh at the fraction `s` of the way.
double volume_on_the_way(Mesh mesh, const Array<Vertex, Vec3>& displacement, double s) {
    for (Vertex v : mesh.position.indices()) mesh.position[v] += s * displacement[v];
    return volume(mesh, only);
}

double safe_fraction_of(const Mesh& mesh, const Array<Vertex, Vec3>& displacement, double least) {
    Array<Vertex, Vec3> place = mesh.position;
    for (Vertex v : place.indices()) place[v] += displacement[v];
    return safe_fraction(mesh, all_tets(mesh), mesh.position, place, least);
}

TEST(SafeFraction, AgreesWithSamplingTheWay) {
    constexpr int samples = 1000;
    constexpr double least = 0.05;
    Random random{1};
    int stopped = 0, arrived = 0;
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE("seed 1, round " + std::to_string(round));
        Mesh mesh = one_tet();
        Array<Vertex, Vec3> displacement(4);
        for (Vertex v : mesh.position.indices())
            for (int axis = 0; axis < 3; ++axis) {
                mesh.position[v][axis] += random.uniform(-0.2, 0.2);
                displacement[v][axis] = random.uniform(-0.7, 0.7);
            }
        const double kept = least * volume(mesh, only);
        int first_bad = samples + 1;
        for (int i = samples; i >= 0; --i)
            if (volume_on_the_way(mesh, displacement, double(i) / samples) < kept) first_bad = i;
        const double fraction = safe_fraction_of(mesh, displacement, least);
        if (first_bad <= samples) {
            EXPECT_LE(fraction, double(first_bad) / samples);
            ++stopped;
        }
        if (fraction == 1) {
            EXPECT_EQ(first_bad, samples + 1);
            ++arrived;
            continue;
        }
        // Just there, and not before, the volume falls to the least; the fraction is found to 2^-16.
        EXPECT_GE(volume_on_the_way(mesh, displacement, fraction), kept * (1 - 1e-9));
        EXPECT_NEAR(volume_on_the_way(mesh, displacement, fraction), kept, 7.3e-6);
    }
    EXPECT_GE(stopped, 50);
    EXPECT_GE(arrived, 200);
}

TEST(SafeFraction, SeesACellThatOnlyTouchesZero) {
    // Two edges turn round at once: the volume is (1 - 2 s)^2 / 2, positive on both sides of its double root.
    // All numbers on the way to the root are exact.
    Mesh mesh = one_tet();
    mesh.position[Vertex(3)].z = 3;
    const Array<Vertex, Vec3> displacement = {{0, 0, 0}, {-2, 0, 0}, {0, -2, 0}, {0, 0, 0}};
    EXPECT_GT(volume_on_the_way(mesh, displacement, 1), 0.4);
    const double fraction = safe_fraction_of(mesh, displacement, 0);
    EXPECT_LE(fraction, 0.5);
    EXPECT_GE(fraction, 0.5 - 1e-4);
    EXPECT_NEAR(safe_fraction_of(mesh, displacement, 0.25), 0.25, 1.7e-5);
}

TEST(SafeFraction, IsTheWholeWayWithoutMotionOrAllTogether) {
    const Mesh mesh = cube_of_tets(3);
    Array<Vertex, Vec3> displacement(mesh.position.size());
    EXPECT_EQ(safe_fraction_of(mesh, displacement, 0.05), 1);
    for (Vec3& d : displacement) d = {1, -2, 0.5};
    EXPECT_EQ(safe_fraction_of(mesh, displacement, 0.05), 1);
    EXPECT_EQ(safe_fraction(mesh, {}, mesh.position, mesh.position, 0.05), 1);
}

TEST(SafeFraction, IsTheLeastOfAllCells) {
    Mesh mesh = ball_of_vertex();
    Array<Vertex, Vec3> displacement(mesh.position.size());
    displacement[Vertex(0)] = {2, 0, 0};  // through the facets at (1, 0, 0): their tets are flat half-way
    const double fraction = safe_fraction_of(mesh, displacement, 0);
    EXPECT_NEAR(fraction, 0.5, 1.7e-5);  // it is found to 2^-16
    double least = 1;
    Array<Vertex, Vec3> place = mesh.position;
    place[Vertex(0)] += displacement[Vertex(0)];
    for (Tet t : all_tets(mesh)) least = std::min(least, safe_fraction(mesh, {&t, 1}, mesh.position, place, 0));
    EXPECT_EQ(fraction, least);
}

/// sphere_in_box, or an ellipsoid there, that moves along x by t and turns about y by `turns` t.
Domain moving_body(const Vec3& semi_axes, double turns) {
    Domain domain = sphere_in_box();
    domain.bodies.front().shape.semi_axes = semi_axes;
    domain.bodies.front().motion = [turns](double t) {
        return Pose{{t, 0, 0}, rotation_about({0, 1, 0}, turns * t)};
    };
    return domain;
}

std::vector<Vertex> vertices_of_body(const Mesh& mesh) {
    std::vector<Vertex> vertices;
    for (Vertex v : all_vertices(mesh))
        if (std::ranges::any_of(ball(mesh, v), [&](Tet t) { return mesh.region[t] == Region(1); }))
            vertices.push_back(v);
    return vertices;
}

TEST(MoveBoundary, MovesBodiesRigidlyAndNoWall) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Domain domain = moving_body({0.6, 0.7, 0.5}, 2);
        Mesh mesh = improved_mesh(domain, seed);
        const Mesh before = mesh;
        const MovedBodies bodies{{vertices_of_body(mesh)}};
        Zone zone;
        ZoneMotion motion;
        const MoveReport report = move_boundary(mesh, domain, bodies, 0, 0.04, zone, motion);
        ASSERT_TRUE(report.arrived);
        EXPECT_EQ(report.fraction, 1);
        EXPECT_EQ(verify(mesh), "");
        EXPECT_EQ(mesh.tets, before.tets);
        EXPECT_EQ(mesh.neighbour, before.neighbour);

        const Body& body = domain.bodies.front();
        for (Vertex v : bodies.vertices.front()) {
            const Vec3 there = placed(body.shape, body.motion(0.04), before.position[v]);
            EXPECT_LE(distance(mesh.position[v], there), 1e-14);
        }
        int free_moved = 0;
        for (Vertex v : all_vertices(mesh)) {
            if (mesh.position[v] == before.position[v]) continue;
            const Freedom slides = freedom(constraint(mesh, v, ball(mesh, v)));
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_TRUE(slides.along[static_cast<std::size_t>(axis)] ||
                            mesh.position[v][axis] == before.position[v][axis] || on_interface(mesh, v));
            if (std::ranges::find(bodies.vertices.front(), v) != bodies.vertices.front().end()) continue;
            EXPECT_TRUE(zone.has.contains(v));
            ++free_moved;
        }
        EXPECT_GE(free_moved, 190);
        for (Tet t : motion.cells) EXPECT_EQ(mesh.region[t], surroundings);
        const auto old_shape = properties(before), new_shape = properties(mesh);
        EXPECT_TRUE(same(new_shape, old_shape));  // all volumes to 1e-12 of the box's
        EXPECT_NEAR(new_shape.volume.at(Region(1)), old_shape.volume.at(Region(1)),
                    1e-13 * old_shape.volume.at(Region(1)));
    }
}

TEST(MoveBoundary, TellsHowFarItCouldGoAndLeavesTheMesh) {
    const Domain domain = moving_body({0.6, 0.6, 0.6}, 0);
    Mesh mesh = improved_mesh(domain, 1);
    const Mesh before = mesh;
    const MovedBodies bodies{{vertices_of_body(mesh)}};
    Zone zone;
    ZoneMotion motion;
    const MoveReport report = move_boundary(mesh, domain, bodies, 0, 1.5, zone, motion);
    EXPECT_FALSE(report.arrived);
    EXPECT_EQ(mesh, before);
    EXPECT_GT(report.fraction, 0);
    EXPECT_LT(report.fraction, 1);
    ASSERT_TRUE(report.limiting.exists());
    EXPECT_EQ(mesh.region[report.limiting], surroundings);

    // As far as it said it does go.
    EXPECT_TRUE(move_boundary(mesh, domain, bodies, 0, 0.99 * report.fraction * 1.5, zone, motion).arrived);
    EXPECT_EQ(verify(mesh), "");
}

TEST(MoveBoundary, AtRestNothingMoves) {
    const Domain domain = sphere_in_box();
    Mesh mesh = improved_mesh(domain, 1);
    const Mesh before = mesh;
    const MovedBodies bodies{{vertices_of_body(mesh)}};
    Zone zone;
    ZoneMotion motion;
    EXPECT_TRUE(move_boundary(mesh, domain, bodies, 0, 1, zone, motion).arrived);
    for (Vertex v : all_vertices(mesh)) EXPECT_EQ(mesh.position[v], before.position[v]);
}

// Places of the body come from the places before, step by step; nothing may add up on the way.
TEST(MoveBoundary, ABodyThatComesBackIsTheSameBitForBit) {
    for (const double offset : {0.0, 1000.0}) {
        SCOPED_TRACE("offset " + std::to_string(offset));
        Domain domain = moving_body({0.6, 0.7, 0.5}, 0);
        for (Vec3* x : {&domain.box.min, &domain.box.max, &domain.bodies[0].shape.centre})
            *x += offset * Vec3{1, -0.7, 0.3};
        constexpr int lap = 5;
        domain.bodies[0].motion = [](double t) {
            const double turn = 2 * std::numbers::pi * std::remainder(t, lap) / lap;
            return Pose{{0.03 * std::sin(turn), 0.02 * std::cos(turn) - 0.02, 0},
                        rotation_about({1, 2, 3}, 0.05 * std::sin(turn))};
        };
        Mesh mesh = improved_mesh(domain, 1);
        const double start = region_volume(mesh, Region(1)) / volume(domain.bodies[0].shape);
        EXPECT_NEAR(start, 1, 1e-12);
        const MovedBodies bodies{{vertices_of_body(mesh)}};
        Zone zone;
        ZoneMotion motion;
        std::vector<Vec3> seen;
        for (int i = 0; i < 40 * lap; ++i) {
            ASSERT_TRUE(move_boundary(mesh, domain, bodies, i, i + 1, zone, motion).arrived) << "step " << i;
            ASSERT_NEAR(region_volume(mesh, Region(1)) / volume(domain.bodies[0].shape), 1, 1e-12) << i;
            if (i % lap != 0) continue;
            std::vector<Vec3> here;
            for (Vertex v : bodies.vertices.front()) here.push_back(mesh.position[v]);
            if (i > 0) {
                ASSERT_EQ(here, seen) << "step " << i;
            }
            seen = std::move(here);
        }
    }
}

// What is in a hollow body goes with it, and is looked after as what is around.
TEST(Move, OfAHollowBodyTakesAlongWhatIsInIt) {
    const Triangles hollow = together(box_of_triangles({-0.6, -0.6, -0.6}, {0.6, 0.6, 0.6}),
                                      turned_round(box_of_triangles({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3})));
    Domain domain{{{-1.5, -1.5, -1.5}, {1.5, 1.5, 2}}, {{"hollow", shape_within(hollow.points, hollow.triangles)}}, {0.3, 0.3, 0.8}};
    domain.bodies[0].motion = [](double t) { return Pose{{0, 0, t}, rotation_about({0, 0, 1}, t)}; };
    MovingMesh moving(domain, initial_mesh(domain, 1), 0);
    for (int step = 1; step <= 4; ++step) {
        (void)step_to(moving, 0.125 * step);
        EXPECT_LE(summarise_quality(moving.reference()).max_aspect_ratio, 5.83);
    }
    EXPECT_EQ(verify(moving.reference()), "");
    EXPECT_NEAR(region_volume(moving.reference(), Region(1)), 1.512, 1e-12);
}

}  // namespace
}  // namespace kropla
