#include "adapt/way.h"

#include "adapt/cases.h"
#include "adapt/constants.h"
#include <kropla/adapt/attempt.h>
#include "base/random.h"
#include "base/tetrahedron.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

Vec3 random_vector(Random& random, double up_to) {
    return up_to * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
}

Vec3 between(const Vec3& a, const Vec3& b, double s) { return a + s * (b - a); }

TEST(VolumeKeptTurning, IsTheLeastOfACellOnItsWay) {
    Random random{1};
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE("seed 1, round " + std::to_string(round));
        const Shape from{random_vector(random, 3), {1, 2, 3}, rotation_about({1, 1, 0}, random.uniform(0, 3))};
        const Pose pose{random_vector(random, 5), rotation_about(random_vector(random, 1), random.uniform(-4, 4))};
        const Shape to = placed(from, pose);
        std::array<Vec3, 4> x, y;
        for (std::size_t i = 0; i < 4; ++i) {
            x[i] = random_vector(random, 1);
            y[i] = placed(from, pose, x[i]);
        }
        const double volume = tet_volume(x[0], x[1], x[2], x[3]);
        double least = 1;
        for (int k = 0; k <= 20; ++k) {
            const auto at = [&](std::size_t i) { return between(x[i], y[i], k / 20.0); };
            least = std::min(least, tet_volume(at(0), at(1), at(2), at(3)) / volume);
        }
        EXPECT_NEAR(volume_kept_turning(from, to), least, 1e-9 * (1 + 1 / std::abs(volume)));
    }
}

/// Six corners near those of a prism on the unit triangle.
std::array<Vec3, 6> random_prism(Random& random, double height, double astray) {
    std::array<Vec3, 6> x = {Vec3{0, 0, 0},      Vec3{1, 0, 0},      Vec3{0, 1, 0},
                             Vec3{0, 0, height}, Vec3{1, 0, height}, Vec3{0, 1, height}};
    for (Vec3& corner : x) corner += random_vector(random, astray);
    return x;
}

double jacobian_on_the_way(const std::array<Vec3, 6>& from, const std::array<Vec3, 6>& to, double s) {
    std::array<Vec3, 6> x;
    for (std::size_t i = 0; i < 6; ++i) x[i] = between(from[i], to[i], s);
    return scaled_corner_jacobian(x);
}

TEST(SafeFraction, OfAPrismAgreesWithSamplingTheWay) {
    constexpr int samples = 200;
    Random random{2};
    int stopped = 0, arrived = 0;
    for (int round = 0; round < 300; ++round) {
        SCOPED_TRACE("seed 2, round " + std::to_string(round));
        const double height = random.uniform(0.02, 1);
        const auto from = random_prism(random, height, 0.02 * height);
        const auto to = random_prism(random, height, random.uniform(0, 1.5) * height);
        const double fraction = safe_fraction(from, to, 0);
        int first_bad = samples + 1;
        for (int i = samples; i >= 0; --i)
            if (jacobian_on_the_way(from, to, double(i) / samples) <= 0) first_bad = i;
        if (first_bad <= samples) {
            EXPECT_LE(fraction, double(first_bad) / samples);
            EXPECT_NEAR(jacobian_on_the_way(from, to, fraction), 0, 2.1e-4);
            ++stopped;
        } else if (fraction == 1) {
            ++arrived;
        }
    }
    EXPECT_GE(stopped, 93);
    EXPECT_GE(arrived, 170);
}

/// An ellipsoid with a layer on both sides that turns by `angle` until t = 1.
Domain turning(double angle) {
    Body body{"top", {{0, 0, 0}, {0.6, 0.5, 0.55}, {}}};
    body.motion = [angle](double t) { return Pose{{0, 0, 0.1 * t}, rotation_about({0, 1, 0}, angle * t)}; };
    body.layer = LayerOptions{2, 0.03, 1.2, LayerOptions::Side::both};
    return {{{-1.5, -1.5, -2}, {1.5, 1.5, 2}}, {body}, {0.35, 0.4, 0.8}};
}

/// Goes on by `dt`, if it is not refused; then nothing is turned over anywhere on the way.
bool attempt(MovingMesh& moving, double dt) {
    MovedAttempt moved = move_bodies(Attempt(moving), moving.time() + dt);
    if (moved.refusal()) {
        refuse(std::move(moved));
        return false;
    }
    const Mesh &before = moved.before(), &current = moved.current();
    for (int k = 0; k <= 10; ++k) {
        Mesh mesh = before;
        for (Vertex v : all_vertices(before)) mesh.position[v] = between(before.position[v], current.position[v], k / 10.0);
        for (Tet t : all_tets(mesh)) EXPECT_GT(volume(mesh, t), 0) << "cell " << t.value;
        for (const Prism& prism : all_prisms(mesh)) EXPECT_GT(scaled_corner_jacobian(prism_corners(mesh, prism)), 0);
    }
    accept(remesh(std::move(moved)));
    EXPECT_EQ(verify(moving.reference()), "");
    return true;
}

TEST(MovingMesh, NoCellOfAnyKindIsTurnedOverOnItsWay) {
    const double full = 2 * std::numbers::pi;
    const Domain domain = turning(full);
    MovingMesh moving(domain, improved_mesh(domain, 1), 0);
    int accepted = 0, refused = 0;
    for (const double degrees : {10.0, 20.0, 40.0, 60.0, 90.0, 120.0, 150.0, 170.0, 180.0, 10.0})
        ++(attempt(moving, degrees / 360) ? accepted : refused);
    EXPECT_GE(accepted, 3);
    EXPECT_GE(refused, 5);
}

TEST(MovingMesh, AHalfTurnInOneStepIsRefused) {
    const Domain domain = turning(std::numbers::pi);
    const Mesh start = improved_mesh(domain, 1);
    MovingMesh moving(domain, start, 0);
    MovedAttempt moved = move_bodies(Attempt(moving), 1);
    const auto refusal = moved.refusal();
    ASSERT_TRUE(refusal);
    EXPECT_NE(refusal->why.find("\"top\""), std::string::npos) << refusal->why;
    EXPECT_NE(refusal->why.find("180 degrees"), std::string::npos) << refusal->why;
    const double most = std::acos(2 * least_volume_kept - 1);
    EXPECT_NEAR(refusal->advised_dt, most / std::numbers::pi, 1e-12);
    EXPECT_EQ(moved.current(), start);
    refuse(std::move(moved));
    EXPECT_TRUE(attempt(moving, 0.1));
}

}  // namespace
}  // namespace kropla
