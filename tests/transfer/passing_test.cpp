// Transfers where there is no room: in gaps of one cell between interfaces, and between bodies that pass.

#include "adapt/cases.h"
#include <kropla/adapt/attempt.h>
#include <kropla/base/error.h>
#include "base/random.h"
#include <kropla/mesh/cavity.h>
#include "mesh/meshes.h"
#include "mesh/proposals.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>
#include "transfer/adapted.h"
#include "transfer/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace kropla {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A cube of 8^3 cubes of tets. The gap, region 0, is one cube high between the regions 1 and 2, and opens
/// at `end`; all vertices left of it lie on interfaces.
///
///      +--------------+---+
///      |      2       |   |
///      +--------------+ 0 |  z
///      |  0 (the gap)     |  |
///      +--------------+   |  +-- x
///      |      1       |   |
///      +--------------+---+
Mesh narrow_gap(double end) {
    Mesh mesh = cube_of_tets(8);
    for (Tet t : mesh.tets.indices()) {
        const Vec3 x = centroid(mesh, t);
        const bool in_gap = x.x > end || (x.z > 0.375 && x.z < 0.5);
        mesh.region[t] = in_gap ? surroundings : Region(x.z < 0.4 ? 1 : 2);
    }
    jiggle(mesh, 0.1 / 8, 1);
    return mesh;
}

/// With 2-3 swaps in the gap near x = 0; no two share a cell.
AdaptedMesh swapped_in_gap(Mesh mesh) {
    AdaptedMesh a{mesh, std::move(mesh), {}};
    for (Tet t : all_tets(a.before, surroundings)) {
        if (centroid(a.before, t).x > 0.2) continue;
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = a.before.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n.exists() || a.before.region[n] != surroundings) continue;
            if (!same_tet(a.before, a.after, t) || !same_tet(a.before, a.after, n)) continue;
            const Cavity cavity = facet_removal(a.after, {t, corner});
            if (!all_positive(a.after, cavity)) continue;
            const auto added = replace_cells(a.after, cavity).cells;
            a.changes.cells.insert(a.changes.cells.end(), added.begin(), added.end());
        }
    }
    return a;
}

TransferPlan plan_of(const AdaptedMesh& mesh) {
    return plan_transfer(mesh.before, mesh.after, mesh.changes.cells, mesh.changes.vertices);
}

NodalValues noise(const Mesh& mesh, std::uint64_t seed) {
    Random random{seed};
    return nodal_values(mesh, [&](Vertex) { return random.uniform(); });
}

TEST(NarrowGap, AClusterGrowsAlongTheGapUntilItOpens) {
    const AdaptedMesh mesh = swapped_in_gap(narrow_gap(0.7));
    ASSERT_EQ(verify(mesh.after), "");
    ASSERT_GE(mesh.changes.cells.size(), 6u);
    const TransferPlan plan = plan_of(mesh);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const NodalValues old = noise(mesh.before, seed);
        NodalValues fresh = old;
        const TransferReport report = project(plan, fresh);
        const double before = field_integral(mesh.before, old, surroundings);
        EXPECT_GT(std::abs(field_integral(mesh.after, old, surroundings) - before), 1e-6);  // it has to do something
        EXPECT_NEAR(field_integral(mesh.after, fresh, surroundings), before, 1e-14) << "seed " << seed;
        EXPECT_LE(report.beyond, 1e-12) << "seed " << seed;
        for (Vertex v : all_vertices(mesh.after))
            if (on_interface(mesh.after, v)) {
                EXPECT_EQ(fresh[v], old[v]);
            }
    }
}

TEST(NarrowGap, WhatCannotBeKeptIsRefusedAndNothingWritten) {
    const AdaptedMesh mesh = swapped_in_gap(narrow_gap(1));  // never opens
    ASSERT_GE(mesh.changes.cells.size(), 6u);
    const TransferPlan plan = plan_of(mesh);
    const NodalValues old = noise(mesh.before, 1);
    NodalValues fresh = old;
    try {
        (void)project(plan, fresh);
        FAIL() << "nothing was refused";
    } catch (const TransferError& error) {
        EXPECT_NE(std::string(error.what()).find("over region 0 "), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("no vertex"), std::string::npos) << error.what();
    }
    EXPECT_EQ(fresh, old);
    NodalValues constant = nodal_values(mesh.before, [](Vertex) { return 7.3; });
    EXPECT_NO_THROW((void)project(plan, constant));  // is kept by itself
}

TEST(Project, RefusesWhatIsNotFinite) {
    const AdaptedMesh mesh = adapted_mesh(1);
    const TransferPlan plan = plan_of(mesh);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vertex some = mesh.before.tets[plan.geometry->changed.gone.front()][0];
    for (const double value : {nan, infinity, -infinity}) {
        NodalValues field = noise(mesh.before, 1);
        field[some] = value;
        EXPECT_THROW((void)project(plan, field), FieldError) << value;
        Array<Tet, double> cells(mesh.before.tets.size(), 1.0);
        cells[plan.geometry->changed.gone.back()] = value;
        EXPECT_THROW((void)project(plan, cells), FieldError) << value;
        NodalValues good = noise(mesh.before, 1);
        for (const auto& weight : {std::vector{1.0, value}, std::vector{1.0}})  // or one is missing
            EXPECT_THROW((void)project(plan, good, {.limit = true, .weight = weight}), FieldError) << value;
        good.resize(mesh.before.position.size());
        EXPECT_EQ(good, noise(mesh.before, 1));
    }
}

TEST(Project, KeepsValuesOfAnySize) {
    const AdaptedMesh mesh = adapted_mesh(2);
    const TransferPlan plan = plan_of(mesh);
    for (const double scale : {1e-308, 1e-300, 1e-30, 1e30, 1e300}) {
        NodalValues field = noise(mesh.before, 2);
        for (double& x : field) x *= scale;
        EXPECT_NO_THROW((void)project(plan, field)) << scale;
        for (Vertex v : all_vertices(mesh.after))
            EXPECT_TRUE(field[v] >= 0 && field[v] <= scale * (1 + 1e-12)) << scale;
    }
}

/// Two bodies that pass each other at `gap` surface sizes, on a line of any direction, or three of which the
/// third rests.
Domain passing_bodies(Random& random, double gap, bool three) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), up = random.uniform(-1, 1);
    const Vec3 along = {std::sqrt(1 - up * up) * std::cos(angle), std::sqrt(1 - up * up) * std::sin(angle), up};
    const Vec3 aside = normalised(cross(along, std::abs(up) < 0.7 ? Vec3{0, 0, 1} : Vec3{1, 0, 0}));
    Domain domain;
    domain.box = {{-2.2, -2.2, -2.2}, {2.2, 2.2, 2.2}};
    domain.size = {0.3, 0.4, 0.9};
    const double off = 0.5 + gap * domain.size.surface / 2, start = 0.35;
    for (const double side : {-1.0, 1.0})
        domain.bodies.push_back({.name = side < 0 ? "a" : "b",
                                 .shape = {(-side * start) * along + (side * off) * aside, {0.5, 0.5, 0.5}, {}},
                                 .motion = [=](double t) { return Pose{(side * t) * along, {}}; }});
    if (three) {
        const Vec3 across = cross(along, aside);
        domain.bodies.push_back({.name = "c", .shape = {1.05 * across, {0.4, 0.4, 0.4}, {}}});
    }
    return domain;
}

/// Hot bodies with a layer of a cell or so around them.
NodalValues temperatures(const Mesh& mesh, const Snapshot& at) {
    return nodal_values(mesh, [&](Vertex v) {
        const bool in_body = !at_region(mesh, v, surroundings);
        const double away = in_body ? 0 : distance_to_bodies(at, mesh.position[v]);
        return 300 + 2100 * std::exp(-away / at.size.surface);
    });
}

class Passing : public testing::TestWithParam<std::uint64_t> {};

/// A step of 0.1 or less, not yet accepted. Nothing: it went no further.
std::optional<RemeshedAttempt> attempt(MovingMesh& moving) {
    for (double dt = 0.1; dt > 0.01; dt /= 2) {
        MovedAttempt moved = move_bodies(Attempt(moving), moving.time() + dt);
        if (!moved.refusal()) return remesh(std::move(moved));
        refuse(std::move(moved));
    }
    return std::nullopt;
}

TEST_P(Passing, LosesNothingAndKeepsItsBounds) {
    Random random{GetParam()};
    const double gap = random.uniform(0.3, 0.5);
    const Domain domain = passing_bodies(random, gap, GetParam() % 3 == 0);
    SCOPED_TRACE("seed " + std::to_string(GetParam()) + ", gap " + std::to_string(gap));
    MovingMesh moving(domain, improved_mesh(domain, GetParam()), 0);
    std::size_t changed = 0;
    while (moving.time() < 0.7) {
        auto step = attempt(moving);
        ASSERT_TRUE(step) << "at t = " << moving.time();
        const Mesh &before_mesh = step->before(), &after_mesh = step->current();
        const TransferPlan plan =
            plan_transfer(before_mesh, after_mesh, step->remeshed().cells, step->remeshed().vertices);
        changed += plan.geometry->changed.come.size();
        EXPECT_LE(step->statistics().cells_touched, count_tets(before_mesh));
        const NodalValues hot = temperatures(before_mesh, snapshot(domain, moving.time()));
        for (const NodalValues& old : {noise(before_mesh, GetParam()), hot}) {
            NodalValues field = old;
            const TransferReport report = project(plan, field);
            EXPECT_LE(report.beyond, 1e-12 * *std::ranges::max_element(old));
            for (std::size_t r = 0; r <= domain.bodies.size(); ++r) {
                const double before = field_integral(before_mesh, old, Region(r));
                EXPECT_NEAR(field_integral(after_mesh, field, Region(r)), before, 1e-13 * before) << r;
            }
        }
        accept(std::move(*step));
    }
    EXPECT_GE(changed, 5800u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Passing, testing::Range(std::uint64_t{1}, std::uint64_t{7}));

}  // namespace
}  // namespace kropla
