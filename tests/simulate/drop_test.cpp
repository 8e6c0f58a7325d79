// Liquids that meet: the pressure on each side, and surface tension.
#include "flow_problems.h"
#include "session.h"
#include "simulate/tension.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kropla {
namespace {

/// The mesh of a ball of radius 1 in one of radius 3, and the ball's surface.
struct Ball {
    Mesh mesh = ball_of_shells({0, 0.2, 0.4, 0.6, 0.8, 1, 1.3, 2, 3}, [](int shell) { return shell < 5 ? 1 : 0; });
    LiquidSurface surface = [this] {
        LiquidSurface of{Region(1), region_surface(mesh, Region(1)).interface, {}, {}};
        of.vertices = vertices_of(of.facets);
        return of;
    }();

    explicit Ball(const std::function<double(const Vec3&)>& tension) {
        for (Vertex v : surface.vertices) surface.tension.push_back(tension(mesh.position[v]));
    }
};

TEST(SurfaceTension, NeitherPullsNorTurnsAClosedSurface) {
    const Ball ball([](const Vec3& x) { return 2 + x.x - 0.5 * x.y * x.z; });
    const SurfaceTension acts = surface_tension(ball.surface, ball.mesh.position);
    Vec3 sum, moment;
    double size = 0;
    for (std::size_t i = 0; i < acts.force.size(); ++i) {
        sum += acts.force[i];
        moment += cross(ball.mesh.position[ball.surface.vertices[i]], acts.force[i]);
        size += norm(acts.force[i]);
    }
    EXPECT_LE(norm(sum), 1e-13 * size);
    EXPECT_LE(norm(moment), 1e-13 * size);
}

TEST(SurfaceTension, PullsInwardsByTwiceTheCurvature) {
    const Ball ball([](const Vec3&) { return 0.7; });
    const SurfaceTension acts = surface_tension(ball.surface, ball.mesh.position);
    double inwards = 0;
    for (std::size_t i = 0; i < acts.force.size(); ++i) inwards -= dot(acts.force[i], acts.normal[i]);
    EXPECT_NEAR(inwards / acts.area, 2 * 0.7, 4.7e-5);
}

TEST(SurfaceTension, PullsAlongItsGradient) {
    const Ball ball([](const Vec3& x) { return 1 + 0.1 * x.z; });
    const SurfaceTension even = surface_tension(Ball([](const Vec3&) { return 1.0; }).surface, ball.mesh.position);
    const SurfaceTension acts = surface_tension(ball.surface, ball.mesh.position);
    // Of the equator, along z: 0.1 per area there.
    double along = 0, area = 0;
    for (std::size_t i = 0; i < acts.force.size(); ++i) {
        if (std::abs(ball.mesh.position[ball.surface.vertices[i]].z) > 0.3) continue;
        along += acts.force[i].z - even.force[i].z;
        area += -dot(even.force[i], even.normal[i]) / 2;  // twice the curvature, which is 1
    }
    EXPECT_NEAR(along / area, 0.1, 0.0094);
}

TEST(SurfaceTension, IsBoundSymmetricallyAndLetsAShiftBe) {
    const Ball ball([](const Vec3& x) { return 1 + 0.2 * x.y; });
    const SurfaceTension acts = surface_tension(ball.surface, ball.mesh.position);
    std::vector<double> sum(acts.force.size(), 0);
    for (const auto& [row, column, stiffness] : acts.bonds) {
        sum[row] += stiffness;
        const auto back = std::ranges::find_if(acts.bonds, [row = row, column = column](const auto& bond) {
            return bond.row == column && bond.column == row;
        });
        ASSERT_NE(back, acts.bonds.end());
        EXPECT_NEAR(back->stiffness, stiffness, 1e-15);
    }
    for (double s : sum) EXPECT_NEAR(s, 0, 1e-13);
}

/// A pyramid of six sides on the floor z = 0, with its tip, vertex 0, above the middle of the floor, vertex 7.
struct Pyramid {
    Array<Vertex, Vec3> position = Array<Vertex, Vec3>(8);
    LiquidSurface surface{Region(1), {}, {}, std::vector<double>(7, 0.8)};

    explicit Pyramid(double angle) {
        ContactLine line{4, {}, {}, std::cos(angle)};
        position[Vertex(0)] = {0, 0, 0.6};
        surface.vertices = {Vertex(0)};
        surface.free = {{1, 1, 1}};
        for (int i = 1; i <= 6; ++i) {
            const double turn = i * std::numbers::pi / 3;
            const Vertex next(i % 6 + 1);
            position[Vertex(i)] = {std::cos(turn), std::sin(turn), 0};
            surface.facets.push_back({Vertex(0), Vertex(i), next});
            surface.vertices.push_back(Vertex(i));
            surface.free.push_back({1, 1, 0});
            line.vertices.push_back(Vertex(i));
            line.wetted.push_back({Vertex(7), next, Vertex(i)});
        }
        surface.lines = {line};
    }
};

TEST(SurfaceTension, PullsAContactLineToWhereItsEnergyIsLess) {
    constexpr double small = 1e-4;
    for (const double angle : {0.5, 1.0, 2.0}) {
        Pyramid pyramid(angle);
        const SurfaceTension acts = surface_tension(pyramid.surface, pyramid.position);
        for (int i = 1; i <= 6; ++i) {
            const Vec3 there = pyramid.position[Vertex(i)];  // outwards, its length is 1
            const auto energy = [&](double further) {
                pyramid.position[Vertex(i)] = (1 + further) * there;
                return surface_tension(pyramid.surface, pyramid.position).energy;
            };
            const double slope = (energy(small) - energy(-small)) / (2 * small);
            pyramid.position[Vertex(i)] = there;
            EXPECT_NEAR(dot(acts.force[as_size(i)], there), -slope, 1e-8) << angle;
        }
    }
}

TEST(SurfaceTension, PullsTheFloorUpAsTheTipDown) {
    Pyramid pyramid(1);
    pyramid.position[Vertex(0)] += {0.2, -0.1, 0};
    const SurfaceTension acts = surface_tension(pyramid.surface, pyramid.position);
    Vec3 sum;
    for (const Vec3& force : acts.force) sum += force;
    EXPECT_LE(norm(sum), 1e-14);
    EXPECT_LT(acts.force[0].z, -1);
}

FlowOptions drop_options(double tension) {
    FlowOptions options = fluid(0.1, 0.002, uniform({}));
    for (FlowFace& face : options.faces) face = {};
    options.regions.push_back(FlowRegion{.density = 1, .viscosity = 0.02});
    options.tension = {Property(tension)};
    options.tolerance = 1e-8;
    return options;
}

double mean(const LiquidSurface& surface, const Array<Vertex, double>& values) {
    double sum = 0;
    for (Vertex v : surface.vertices) sum += values[v];
    return sum / static_cast<double>(surface.vertices.size());
}

TEST(Drop, HoldsThePressureOfLaplace) {
    const Ball ball([](const Vec3&) { return 1.0; });
    FlowState state = still_flow(ball.mesh);
    const FlowReport report = step_flow(petsc().all_ranks(), ball.mesh, ball.mesh, drop_options(1), state, 0, 1e-3);
    const double jump = mean(ball.surface, state.within.at(0)) - mean(ball.surface, state.pressure);
    EXPECT_NEAR(jump, 2, 0.021);
    ASSERT_EQ(report.surfaces.size(), 1u);
    EXPECT_EQ(report.surfaces[0].vertices, ball.surface.vertices);
    double through = 0, size = 0;  // the volume that the surface sweeps
    for (const auto& [a, b, c] : ball.surface.facets) {
        const Vec3 area = 0.5 * cross(ball.mesh.position[b] - ball.mesh.position[a], ball.mesh.position[c] - ball.mesh.position[a]);
        through += dot(area, state.velocity[a] + state.velocity[b] + state.velocity[c]) / 3;
        size += norm(area) * norm(state.velocity[a]);
    }
    EXPECT_LE(std::abs(through), 1e-6 * size) << "what the tolerance leaves";
}

// Without tension and gravity nothing happens, with a pressure that is even.
TEST(Drop, RestsIfNothingPulls) {
    const Ball ball([](const Vec3&) { return 0.0; });
    FlowState state = still_flow(ball.mesh);
    (void)step_flow(petsc().all_ranks(), ball.mesh, ball.mesh, drop_options(0), state, 0, 0.1);
    for (Vertex v : ball.mesh.position.indices()) EXPECT_EQ(norm(state.velocity[v]), 0);
}

// Two liquids between walls of which the upper one goes: the same shear in both.
TEST(Drop, SharesTheShearOfCouette) {
    constexpr double of_lower = 3, of_upper = 0.5, speed = 2;
    const Mesh mesh = cube_grid(4, 4, 4, [](int i, int j, int k) { return Vec3{i / 4.0, j / 4.0, k / 4.0}; },
                                [](int, int, int k) { return k < 2 ? 0 : 1; });
    const double slope = speed / (0.5 / of_lower + 0.5 / of_upper);  // the shear stress
    const auto exact = [&](const Vec3& x, double) {
        return Vec3{x.z < 0.5 ? slope / of_lower * x.z : slope / of_lower * 0.5 + slope / of_upper * (x.z - 0.5), 0, 0};
    };
    FlowOptions options = fluid(1, of_lower, velocity_of(exact));
    options.regions.push_back(FlowRegion{.density = 7, .viscosity = of_upper});
    options.scheme = FlowScheme::steady;
    options.tolerance = 1e-10;
    FlowState state = still_flow(mesh);
    (void)step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 1);
    for (Vertex v : mesh.position.indices())
        EXPECT_LE(distance(state.velocity[v], exact(mesh.position[v], 0)), 1e-9 * speed);
}

// A force on one of them that is balanced by its pressure alone jumps at the interface, and moves nothing.
TEST(Drop, LetsThePressureJump) {
    const Mesh mesh = cube_grid(4, 4, 4, [](int i, int j, int k) { return Vec3{i / 4.0, j / 4.0, k / 4.0}; },
                                [](int, int, int k) { return k < 2 ? 0 : 1; });
    FlowOptions options = fluid(1, 1, uniform({}));
    for (FlowFace& face : options.faces) face = {};
    options.gravity = {0, 0, -10};
    options.regions.push_back(FlowRegion{.density = 1000, .viscosity = 0.1});
    options.tolerance = 1e-10;
    FlowState state = still_flow(mesh);
    const FlowReport report = step_flow(petsc().all_ranks(), mesh, mesh, options, state, 0, 0.01);
    for (Vertex v : mesh.position.indices()) EXPECT_LE(norm(state.velocity[v]), 1e-9);
    EXPECT_NEAR(report.face_force[1].x, 0, 1e-6) << "the pressure's mean; where the interface ends, it counts once";
    EXPECT_NEAR(report.face_force[4].z, -1253.75, 1e-5);
    const auto at = [&](double z, const Array<Vertex, double>& pressure) {
        for (Vertex v : mesh.position.indices())
            if (distance(mesh.position[v], {0.5, 0.5, z}) < 1e-9) return pressure[v];
        return std::numeric_limits<double>::quiet_NaN();
    };
    EXPECT_NEAR(at(0, state.pressure) - at(0.5, state.pressure), 5, 1e-6);
    EXPECT_NEAR(at(0.5, state.within[0]) - at(1, state.within[0]), 5000, 1e-5);
    EXPECT_NEAR(at(0.5, state.within[0]) - at(0.5, state.pressure), 0, 1e-5);
}

}  // namespace
}  // namespace kropla
