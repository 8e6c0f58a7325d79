// Bodies that deform: the mesh follows, conforming, good, with what is carried kept.

#include "adapt/cases.h"
#include "adapt/threads.h"
#include "base/random.h"
#include "domain/body_surface.h"
#include <kropla/base/error.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace kropla {
namespace {

constexpr double pi = std::numbers::pi;
using Velocity = std::function<Vec3(const Vec3& x, double t)>;

/// By the classical method of Runge and Kutta, in a few parts.
Deformation along(Velocity u) {
    return [u = std::move(u)](Vec3 x, double t0, double t1) {
        constexpr int parts = 4;
        const double h = (t1 - t0) / parts;
        for (int i = 0; i < parts; ++i) {
            const double t = t0 + i * h;
            const Vec3 a = u(x, t), b = u(x + h / 2 * a, t + h / 2), c = u(x + h / 2 * b, t + h / 2), d = u(x + h * c, t + h);
            x += h / 6 * (a + 2 * b + 2 * c + d);
        }
        return x;
    };
}

/// [LeVeque 1996], turned back after half of the period.
Velocity vortex(double period) {
    return [period](const Vec3& x, double t) {
        const auto one = [](double a) { return std::sin(pi * a); };
        const auto two = [](double a) { return std::sin(2 * pi * a); };
        return std::cos(pi * t / period) * Vec3{2 * one(x.x) * one(x.x) * two(x.y) * two(x.z),
                                                -two(x.x) * one(x.y) * one(x.y) * two(x.z),
                                                -two(x.x) * two(x.y) * one(x.z) * one(x.z)};
    };
}

Domain body_in_unit_box(const Shape& shape, double size, Velocity u) {
    Domain domain;
    domain.box = {{0, 0, 0}, {1, 1, 1}};
    domain.size = {size, 0.3, 0.15};
    Body body{"drop", shape};
    body.deformation = along(std::move(u));
    domain.bodies.push_back(std::move(body));
    return domain;
}
Shape ball(const Vec3& centre, double radius) { return {centre, {radius, radius, radius}, {}}; }

/// What is carried, and the bounds it began with.
struct Carried {
    Array<Vertex, double> one, steep;

    explicit Carried(const Mesh& mesh) {
        for (const Vec3& x : mesh.position) {
            one.push_back(1);
            steep.push_back(std::tanh(20 * (x.x - 0.4)));
        }
    }
};

struct Seen {
    double worst = 0;           // R/r
    double transfer = 0;        // [-] error
    double off_one = 0, beyond = 0;
};

/// Goes on to `end` in steps, and looks at each.
Seen follow(MovingMesh& moving, Carried& carried, double end, int steps) {
    Seen seen;
    const double start = moving.time();
    for (int i = 1; i <= steps; ++i) {
        const double goal = start + (end - start) * i / steps;
        while (moving.time() < goal - 1e-12) {
            Fields fields;
            fields.per_vertex(carried.one);
            fields.per_vertex(carried.steep);
            const Advanced done = advance(moving, fields, goal - moving.time(), {});
            for (const TransferReport& report : done.transfer) seen.transfer = std::max(seen.transfer, std::abs(report.error()));
        }
        const Mesh& mesh = moving.reference();
        EXPECT_EQ(verify(mesh), "") << "step " << i;
        seen.worst = std::max(seen.worst, worst_of(mesh));
        for (Vertex v : all_vertices(mesh)) {
            seen.off_one = std::max(seen.off_one, std::abs(carried.one[v] - 1));
            seen.beyond = std::max(seen.beyond, std::abs(carried.steep[v]) - 1);
        }
    }
    return seen;
}

/// The volume between the surface of the mesh's body and that of the shape, of the shape's.
double difference(const Domain& domain, const Mesh& mesh, const Shape& shape) {
    constexpr int n = 6;  // parts of a side
    double sum = 0;
    const BodySurface surface = deforming_surfaces(domain, mesh).front();
    for (const auto& [a, b, c] : surface.triangles) {
        const Vec3 &p = mesh.position[a], &q = mesh.position[b], &r = mesh.position[c];
        double off = 0;
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n - i; ++k)
                off += std::abs(signed_distance(shape, p + (i + 1.0 / 3) / n * (q - p) + (k + 1.0 / 3) / n * (r - p)));
        sum += norm(cross(q - p, r - p)) / 2 * off / (n * (n + 1) / 2);
    }
    return sum / volume(shape);
}

// What a step of the vortex is: the same case, finer, is cases/vortex.toml.
TEST(Deforming, ASphereIsDrawnOutAndComesBack) {
    const Shape sphere = ball({0.35, 0.35, 0.35}, 0.15);
    const Domain domain = body_in_unit_box(sphere, 0.05, vortex(0.8));
    const Mesh start = initial_mesh(domain, 1);
    MovingMesh moving(domain, start, 0);
    Carried carried(start);
    const Seen half = follow(moving, carried, 0.4, 16);
    EXPECT_GE(difference(domain, moving.reference(), sphere), 0.9);  // it is somewhere else, and no sphere
    const Seen whole = follow(moving, carried, 0.8, 16);
    for (const Seen& seen : {half, whole}) {
        EXPECT_LE(seen.worst, 5.6);
        EXPECT_LE(seen.transfer, 1e-14);
        EXPECT_LE(seen.off_one, 2e-14);
        EXPECT_LE(seen.beyond, 1e-14);
    }
    EXPECT_NEAR(region_volume(moving.reference(), Region(1)) / volume(sphere), 1, 9.5e-5);
    EXPECT_LE(difference(domain, moving.reference(), sphere), 0.0204);
}

TEST(Deforming, AnAffineFlowIsFollowedExactly) {
    const Shape ellipsoid{{0.5, 0.5, 0.5}, {0.2, 0.15, 0.17}, {}};
    const auto rate = [](double t) { return 1.5 * std::cos(2 * pi * t); };
    const Domain domain = body_in_unit_box(ellipsoid, 0.07, [&](const Vec3& x, double t) {
        return rate(t) * (x - Vec3{0.5, 0.5, 0.5});
    });
    const Mesh start = initial_mesh(domain, 2);
    MovingMesh moving(domain, start, 0);
    Carried carried(start);
    for (const double t : {0.25, 0.75, 1.0}) {
        const Seen seen = follow(moving, carried, t, 8);
        EXPECT_LE(seen.worst, 5.5);
        EXPECT_LE(seen.transfer, 1e-14);
        const double grown = std::exp(3 * 1.5 * std::sin(2 * pi * t) / (2 * pi));
        EXPECT_NEAR(region_volume(moving.reference(), Region(1)) / volume(ellipsoid), grown, 1e-6 * grown) << t;
    }
}

// Where there is room: two prisms high as asked, along the wall's normals; the wall's triangles stay.
TEST(Deforming, LayersOnEachSideFollowTheirWall) {
    const Shape ellipsoid{{0.5, 0.5, 0.5}, {0.2, 0.15, 0.17}, {}};
    Domain domain = body_in_unit_box(ellipsoid, 0.07, [&](const Vec3& x, double t) {
        return std::cos(2 * pi * t) * Vec3{1.5 * (x.x - 0.5), -0.5 * (x.y - 0.5), x.z - 0.5 + 0.3 * (x.x - 0.5)};
    });
    domain.bodies[0].layer = LayerOptions{.count = 2, .first_height = 0.008, .growth = 1.3, .side = LayerOptions::Side::both};
    const Mesh start = initial_mesh(domain, 2);
    MovingMesh moving(domain, start, 0);
    Carried carried(start);
    for (const double t : {0.25, 0.75, 1.0}) {
        const Seen seen = follow(moving, carried, t, 8);
        const Mesh& mesh = moving.reference();
        EXPECT_LE(seen.worst, 5.6);
        EXPECT_LE(seen.transfer, 1e-14);
        EXPECT_LE(seen.off_one, 2e-14);
        EXPECT_LE(seen.beyond, 1e-14);
        const double grown = std::exp(2 * std::sin(2 * pi * t) / (2 * pi));
        EXPECT_NEAR(region_volume(mesh, Region(1)) / volume(ellipsoid), grown, 1e-6 * grown) << t;
        ASSERT_EQ(mesh.layers.size(), 2u);
        for (Layer l : {Layer(0), Layer(1)}) {
            EXPECT_EQ(layer_of(mesh, l), layer_of(start, l));
            const LayerSummary layer = summarise_layer(mesh, l);
            EXPECT_NEAR(layer.min_first_height, 0.008, 1e-12);
            EXPECT_NEAR(layer.max_thickness, 0.008 * 2.3, 1e-12);
            EXPECT_GE(layer.min_jacobian, 0.5);
        }
    }
}

/// A few waves of random direction and phase; at most half of the body's radius is gone in the time 1.
Velocity random_waves(double radius, Random& random) {
    struct Wave {
        Vec3 number, along;
        double phase, beat;
    };
    constexpr int count = 3;
    std::vector<Wave> waves;
    const auto any = [&] { return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
    for (int i = 0; i < count; ++i)
        waves.push_back({any() * (2 / radius), any(), random.uniform(0, 2 * pi), random.uniform(-3, 3)});
    return [waves, radius](const Vec3& x, double t) {
        Vec3 sum;
        for (const Wave& w : waves) sum += 0.5 * radius / count * std::sin(dot(w.number, x) + w.phase + w.beat * t) * w.along;
        return sum;
    };
}

// 200 of them: docs/reliability.md.
TEST(Deforming, RandomWavesAreFollowed) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed};
        const double radius = random.uniform(0.12, 0.22);
        const Domain domain = body_in_unit_box(ball({0.5, 0.5, 0.5}, radius), radius * random.uniform(0.25, 0.45),
                                               random_waves(radius, random));
        const Mesh start = initial_mesh(domain, seed);
        MovingMesh moving(domain, start, 0);
        Carried carried(start);
        const Seen seen = follow(moving, carried, 1, 6);
        EXPECT_LE(seen.worst, 5.5);
        EXPECT_LE(seen.transfer, 1e-14);
        EXPECT_LE(seen.off_one, 1e-14);
    }
}

TEST(Deforming, IsTheSameForAnyNumberOfThreads) {
    const Domain domain = body_in_unit_box(ball({0.35, 0.35, 0.35}, 0.15), 0.06, vortex(0.8));
    const Mesh start = initial_mesh(domain, 1);
    const auto run = [&] {
        MovingMesh moving(domain, start, 0);
        Carried carried(start);
        (void)follow(moving, carried, 0.2, 5);
        return std::pair(moving.reference(), carried.steep);
    };
    const auto [mesh, steep] = with_threads(1, run);
    const auto [other_mesh, other_steep] = with_threads(4, run);
    EXPECT_EQ(mesh, other_mesh);
    EXPECT_EQ(steep, other_steep);
}

// What would fold the mesh is refused, and nothing has changed: a body that would shrink to nothing.
TEST(Deforming, AStepThatCannotBeIsTakenBack) {
    const Domain domain = body_in_unit_box(ball({0.5, 0.5, 0.5}, 0.2), 0.09, [](const Vec3& x, double) {
        return -200 * (x - Vec3{0.5, 0.5, 0.5});
    });
    const Mesh start = initial_mesh(domain, 1);
    MovingMesh moving(domain, start, 0);
    Fields none;
    try {
        for (;;) (void)advance(moving, none, 0.01, {}, {.least_dt = 0.008});
    } catch (const StuckError& error) {
        EXPECT_NE(std::string(error.what()).find("body \"drop\""), std::string::npos) << error.what();
    }
    const Mesh left = moving.reference();
    EXPECT_EQ(verify(left), "");
    EXPECT_THROW((void)advance(moving, none, 0.01, {}, {.least_dt = 0.008}), StuckError);
    EXPECT_EQ(moving.reference(), left);
}

}  // namespace
}  // namespace kropla
