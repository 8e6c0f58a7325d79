#include "adapt/cases.h"
#include <kropla/adapt/attempt.h>
#include <kropla/base/error.h>
#include "base/random.h"
#include <kropla/base/watch.h>
#include <kropla/generate/generate.h>
#include "mesh/meshes.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/mesh/verify.h>
#include "transfer/adapted.h"
#include "transfer/geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

double linear(const Vec3& x) { return 3 + 2 * x.x - 5 * x.y + 0.7 * x.z; }
double jump(const Vec3& x) { return x.x + 0.3 * x.y > 0.1 ? 1 : 0; }

TransferPlan plan_of(const AdaptedMesh& mesh) {
    return plan_transfer(mesh.before, mesh.after, mesh.changes.cells, mesh.changes.vertices);
}

NodalValues values_at(const Mesh& mesh, double (*field)(const Vec3&)) {
    return nodal_values(mesh, [&](Vertex v) { return field(mesh.position[v]); });
}

// Nothing is written where a transfer is ended from outside, and the fields have the values they had.
TEST(Project, IsEndedByItsWatch) {
    const AdaptedMesh mesh = adapted_mesh(1);
    Watch watch;
    watch.stop = true;
    EXPECT_THROW(static_cast<void>(plan_transfer(mesh.before, mesh.after, &watch)), Interrupted);
    EXPECT_THROW(static_cast<void>(plan_transfer(mesh.before, mesh.after, mesh.changes.cells, mesh.changes.vertices,
                                                 &watch)),
                 Interrupted);
    const TransferPlan plan = plan_of(mesh);
    EXPECT_THROW(static_cast<void>(overlaps(mesh.before, mesh.after, plan.geometry->changed, &watch)), Interrupted);
    NodalValues field = values_at(mesh.before, jump);
    Array<Vertex, Vec3> vectors(mesh.before.position.size(), Vec3{1, 2, 3});
    Array<Tet, double> cells(mesh.before.tets.size(), 4.0);
    const auto old_field = field;
    const auto old_vectors = vectors;
    const auto old_cells = cells;
    EXPECT_THROW(project(plan, field, {.watch = &watch}), Interrupted);
    EXPECT_THROW(project(plan, vectors, {.watch = &watch}), Interrupted);
    EXPECT_THROW(project(plan, cells, {.watch = &watch}), Interrupted);
    EXPECT_EQ(field, old_field);
    EXPECT_EQ(vectors, old_vectors);
    EXPECT_EQ(cells, old_cells);
    watch.stop = false;
    EXPECT_NO_THROW(project(plan, field, {.watch = &watch}));
    EXPECT_NE(field, old_field);
}

// A component that cannot be carried leaves the others as they were.
TEST(Project, OfAVectorIsWrittenWholeOrNotAtAll) {
    const AdaptedMesh mesh = adapted_mesh(1);
    const TransferPlan plan = plan_of(mesh);
    Array<Vertex, Vec3> vectors(mesh.before.position.size());
    for (Vertex v : vectors.indices()) vectors[v] = {jump(mesh.before.position[v]), 1, 1};
    vectors[mesh.before.tets[plan.geometry->changed.gone.front()][0]].z = INFINITY;
    const auto old_vectors = vectors;
    EXPECT_THROW(project(plan, vectors), FieldError);
    EXPECT_EQ(vectors, old_vectors);
}

class ProjectAfterAdaptation : public testing::TestWithParam<std::uint64_t> {
protected:
    void SetUp() override {
        ASSERT_EQ(verify(mesh.after), "");
        ASSERT_GE(plan.geometry->changed.come.size(), 1700u);
    }
    void expect_integrals_kept(const NodalValues& old, const NodalValues& fresh) const {
        for (Region region : {surroundings, Region(1)}) {
            const double before = field_integral(mesh.before, old, region);
            EXPECT_NEAR(field_integral(mesh.after, fresh, region), before,
                        1e-12 * std::max(1.0, std::abs(before)))
                << "region " << region.value;
        }
    }

    AdaptedMesh mesh = adapted_mesh(GetParam());
    TransferPlan plan = plan_of(mesh);
};

TEST_P(ProjectAfterAdaptation, IsExactForLinearFields) {
    NodalValues field = values_at(mesh.before, linear);
    const TransferReport report = project(plan, field);
    ASSERT_EQ(field.size(), mesh.after.position.size());
    for (Vertex v : all_vertices(mesh.after)) EXPECT_NEAR(field[v], linear(mesh.after.position[v]), 1e-12);
    EXPECT_LE(std::abs(report.error()), 1e-14);
    EXPECT_LE(report.limited, 1e-12);
    NodalValues constant = nodal_values(mesh.before, [](Vertex) { return 1800.7; });
    (void)project(plan, constant);
    for (Vertex v : all_vertices(mesh.after)) EXPECT_EQ(constant[v], 1800.7);  // to the bit
}

TEST_P(ProjectAfterAdaptation, KeepsTheIntegralOfEachRegion) {
    Random random{GetParam()};
    for (const bool limited : {true, false}) {
        const NodalValues old = nodal_values(mesh.before, [&](Vertex) { return random.uniform(); });
        NodalValues fresh = old;
        const TransferReport report = project(plan, fresh, {.limit = limited, .weight = {}});
        expect_integrals_kept(old, fresh);
        EXPECT_LE(std::abs(report.error()), 1e-14);
    }
}

TEST_P(ProjectAfterAdaptation, KeepsADiscontinuousFieldInItsBounds) {
    const NodalValues old = values_at(mesh.before, jump);
    NodalValues free = old, limited = old;
    (void)project(plan, free, {.limit = false, .weight = {}});
    const TransferReport report = project(plan, limited);
    EXPECT_GT(report.limited, 0.11);
    EXPECT_LE(report.beyond, 1e-12);
    double worst = 0;
    for (Vertex v : all_vertices(mesh.after)) {
        EXPECT_GE(limited[v], -1e-12);
        EXPECT_LE(limited[v], 1 + 1e-12);
        worst = std::max({worst, -free[v], free[v] - 1});
    }
    EXPECT_GT(worst, 0.11);  // without the limiter it does overshoot
    expect_integrals_kept(old, limited);
}

TEST_P(ProjectAfterAdaptation, ChangesNothingAwayFromTheCellsThatTakePart) {
    Random random{GetParam()};
    const NodalValues old = nodal_values(mesh.before, [&](Vertex) { return random.uniform(); });
    NodalValues fresh = old;
    (void)project(plan, fresh, {.limit = false, .weight = {}});
    std::vector<bool> free(mesh.after.position.size(), false);
    for (const MassBlock& block : plan.geometry->blocks)
        for (Vertex v : block.free) free[static_cast<std::size_t>(v.value)] = true;
    int kept = 0;
    for (Vertex v : all_vertices(mesh.after)) {
        if (free[static_cast<std::size_t>(v.value)]) continue;
        EXPECT_EQ(fresh[v], old[v]);
        EXPECT_TRUE(same_vertex(mesh.before, mesh.after, v));
        ++kept;
    }
    EXPECT_GE(kept, 75);
}

TEST_P(ProjectAfterAdaptation, NeverCrossesAnInterface) {
    // With the surface's own values of the body, no other value may get into it; and the same from without.
    for (Region region : {surroundings, Region(1)}) {
        NodalValues field = nodal_values(
            mesh.before, [&](Vertex v) { return at_region(mesh.before, v, region) ? 1.0 : 0.0; });
        (void)project(plan, field);
        for (Vertex v : all_vertices(mesh.after)) {
            if (!at_region(mesh.after, v, region)) continue;
            EXPECT_NEAR(field[v], 1, 1e-15) << "region " << region.value;
        }
    }
}

TEST_P(ProjectAfterAdaptation, MeansOfCellsKeepIntegralAndBounds) {
    Random random{GetParam()};
    Array<Tet, double> field(mesh.before.tets.size());
    for (double& x : field) x = random.uniform(2, 3);
    const auto content = [&](const Mesh& of, Region region) {
        double sum = 0;
        for (Tet t : all_tets(of, region)) sum += field[t] * volume(of, t);
        return sum;
    };
    const double outside = content(mesh.before, surroundings), inside = content(mesh.before, Region(1));
    const TransferReport report = project(plan, field);
    EXPECT_NEAR(content(mesh.after, surroundings), outside, 1e-12 * outside);
    EXPECT_NEAR(content(mesh.after, Region(1)), inside, 1e-12 * inside);
    EXPECT_LE(std::abs(report.error()), 1e-13);
    for (Tet t : all_tets(mesh.after)) {
        EXPECT_GE(field[t], 2 - 1e-12);
        EXPECT_LE(field[t], 3 + 1e-12);
    }
}

TEST_P(ProjectAfterAdaptation, TakesPartsOfAUsersDataOneByOne) {
    struct Own {  // two numbers per vertex at two times
        double now[2], old[2];
    };
    Random random{GetParam()};
    const std::size_t slots = std::max(mesh.before.position.size(), mesh.after.position.size());
    std::vector<Own> own(slots);
    Array<Vertex, Vec3> vectors(slots);
    NodalValues alone(slots);
    for (std::size_t i = 0; i < slots; ++i) {
        own[i] = {{random.uniform(), random.uniform()}, {random.uniform(), random.uniform()}};
        alone[Vertex(i)] = own[i].old[0];
        vectors[Vertex(i)] = {own[i].now[0], own[i].now[1], own[i].old[0]};
    }
    (void)project(plan, NodalData{&own[0].now[1], 4});
    (void)project(plan, NodalData{&own[0].old[0], 4});
    (void)project(plan, alone);
    (void)project(plan, vectors);
    for (Vertex v : all_vertices(mesh.after)) {
        EXPECT_EQ(own[static_cast<std::size_t>(v.value)].old[0], alone[v]);
        EXPECT_EQ(own[static_cast<std::size_t>(v.value)].now[1], vectors[v].y);
        EXPECT_EQ(vectors[v].z, alone[v]);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ProjectAfterAdaptation, testing::Range(std::uint64_t{1}, std::uint64_t{5}));

TEST(Project, KeepsTheIntegralWhereASwapLeavesNoVertexFree) {
    Mesh cubes = cube_in_cube(8);
    jiggle(cubes, 0.1 / 8, 1);
    const AdaptedMesh mesh = swapped_mesh(std::move(cubes));
    ASSERT_EQ(mesh.changes.cells.size(), 6u);  // a swap in each region
    const TransferPlan plan = plan_of(mesh);
    EXPECT_GT(plan.cells, plan.geometry->changed.come.size());
    EXPECT_LT(plan.cells, mesh.after.tets.size() / 3);
    Random random{1};
    const NodalValues old = nodal_values(mesh.before, [&](Vertex) { return random.uniform(); });
    NodalValues fresh = old;
    (void)project(plan, fresh);
    for (Region region : {surroundings, Region(1)}) {
        const double before = field_integral(mesh.before, old, region);
        EXPECT_GT(std::abs(field_integral(mesh.after, old, region) - before),
                  1e-6);  // it has to do something
        EXPECT_NEAR(field_integral(mesh.after, fresh, region), before, 1e-14);
    }
}

TEST(Project, LeavesTheValuesOfLayersAlone) {
    Domain domain = sphere_in_box();
    domain.bodies.front().layer = LayerOptions{.count = 2, .first_height = 0.05, .growth = 1.3};
    AdaptedMesh mesh;
    mesh.before = generate_mesh(domain, 1);
    spoil(mesh.before, surroundings, 20, 1);
    mesh.after = mesh.before;
    mesh.changes = improve(mesh.after, all_tets(mesh.after), snapshot(domain, 0));
    ASSERT_GE(mesh.changes.cells.size(), 530u);
    const TransferPlan plan = plan_of(mesh);
    Random random{1};
    const NodalValues old = nodal_values(mesh.before, [&](Vertex) { return random.uniform(); });
    NodalValues fresh = old;
    (void)project(plan, fresh);
    for (Vertex v : mesh.after.layers.front().columns) EXPECT_EQ(fresh[v], old[v]);
    const double before = field_integral(mesh.before, old);  // of the tets; that of the prisms did not change
    EXPECT_NEAR(field_integral(mesh.after, fresh), before, 1e-12 * before);
}

TEST(Project, WeighsTheReportByRegion) {
    const AdaptedMesh mesh = adapted_mesh(1);
    const TransferPlan plan = plan_of(mesh);
    const std::vector<double> weight = {2, 100};
    NodalValues one = nodal_values(mesh.before, [](Vertex) { return 1.0; });
    const TransferReport report = project(plan, one, {.limit = true, .weight = weight});
    double expected = 0;
    for (const MassBlock& block : plan.geometry->blocks)
        for (const MassCell& cell : block.cells)
            expected += cell.volume * weight[static_cast<std::size_t>(mesh.after.region[cell.tet].value)];
    EXPECT_NEAR(report.after, expected, 1e-12 * expected);
    EXPECT_NEAR(report.before, expected, 1e-12 * expected);
}

/// The error in the mean square over the mesh, by the values at vertices and at the middles of edges.
double error_of(const Mesh& mesh, const NodalValues& values, double (*field)(const Vec3&)) {
    double sum = 0;
    for (Tet t : all_tets(mesh)) {
        const auto& c = mesh.tets[t];
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Vec3 x = (mesh.position[c[i]] + mesh.position[c[j]]) / 2;
                sum += volume(mesh, t) / 6 * std::pow((values[c[i]] + values[c[j]]) / 2 - field(x), 2);
            }
    }
    return std::sqrt(sum);
}

TEST(Project, IsOfSecondOrderBetweenUnrelatedMeshes) {
    const auto wave = [](const Vec3& x) { return std::sin(3 * x.x) * std::cos(2 * x.y) + x.z * x.z; };
    std::vector<double> errors;
    for (int n : {4, 8, 16}) {
        const Mesh a = jittered_cube(n, 1), b = jittered_cube(n, 2);
        NodalValues field = values_at(a, wave);
        const TransferReport report = project(plan_transfer(a, b), field, {.limit = false, .weight = {}});
        EXPECT_LE(std::abs(report.error()), 1e-13);
        errors.push_back(error_of(b, field, wave));
    }
    for (std::size_t i = 1; i < errors.size(); ++i) EXPECT_GE(errors[i - 1] / errors[i], 3) << i;
}

TEST(Project, StaysMonotoneToAndFro) {
    const Mesh a = jittered_cube(6, 1), b = jittered_cube(6, 2);
    const TransferPlan there = plan_transfer(a, b), back = plan_transfer(b, a);
    NodalValues field = nodal_values(a, [&](Vertex v) { return a.position[v].x > 0.5 ? 1.0 : 0.0; });
    const double content = field_integral(a, field);
    for (int i = 0; i < 10; ++i) {
        (void)project(there, field);
        (void)project(back, field);
        for (double x : field) {
            ASSERT_GE(x, -1e-12);
            ASSERT_LE(x, 1 + 1e-12);
        }
    }
    EXPECT_NEAR(field_integral(a, field), content, 1e-12 * content);
}

TEST(Project, AlongTheStepsOfAMovingMesh) {
    Domain domain = sphere_in_box();
    domain.bodies.front().motion = [](double t) { return Pose{{0, 0, t}, {}}; };
    MovingMesh moving(domain, improved_mesh(domain, 1), 0);
    std::size_t changed = 0;
    for (int i = 0; i < 8; ++i) {
        MovedAttempt moved = move_bodies(Attempt(moving), moving.time() + 0.1);
        ASSERT_FALSE(moved.refusal());
        RemeshedAttempt remeshed = remesh(std::move(moved));
        const Mesh before = remeshed.before();
        const Changes changes = remeshed.remeshed();
        accept(std::move(remeshed));
        const TransferPlan plan =
            plan_transfer(before, moving.reference(), changes.cells, changes.vertices);
        NodalValues field = values_at(before, linear);
        const double content = field_integral(before, field);
        (void)project(plan, field);
        for (Vertex v : all_vertices(moving.reference()))
            ASSERT_NEAR(field[v], linear(moving.reference().position[v]), 1e-12);
        ASSERT_NEAR(field_integral(moving.reference(), field), content, 1e-12 * content);
        changed += plan.geometry->changed.come.size();
    }
    EXPECT_GE(changed, 1300u);
}

}  // namespace
}  // namespace kropla
