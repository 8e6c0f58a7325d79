#include "adapt/cases.h"
#include "adapt/moving_mesh.h"
#include "base/random.h"
#include "mesh/meshes.h"
#include "mesh/verify.h"
#include "transfer/transfer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace kropla {
namespace {

using Field = Array<Vertex, double>;

double linear(const Vec3& x) { return 3 + 2 * x.x - 5 * x.y + 0.7 * x.z; }

Field values_of(const Mesh& mesh, const std::function<double(Vertex)>& value) {
    Field field(mesh.position.size());
    for (Vertex v : all_vertices(mesh)) field[v] = value(v);
    return field;
}

bool at_region(const Mesh& mesh, Vertex v, Region region) {
    return std::ranges::any_of(ball(mesh, v), [&](Tet t) { return mesh.region[t] == region; });
}

/// A mesh before and after it was adapted, inside the body too.
struct Adapted {
    Mesh before, after;
    Changes changes;
};

/// Spoilt, repaired, brought to another size than its own, improved and relaxed: every way in which vertices
/// come, move and go at a fixed time.
Adapted adapted(std::uint64_t seed) {
    Domain domain = sphere_in_box();
    domain.size.surface = 0.25;
    Adapted a;
    a.before = improved_mesh(domain, seed);
    spoil(a.before, surroundings, 5, seed);
    spoil(a.before, Region(1), 2, seed);
    a.after = a.before;
    Snapshot at = snapshot(domain, 0);
    const double factor = seed % 2 == 0 ? 1.3 : 0.8;
    at.size.surface *= factor;
    at.size.far *= factor;
    a.changes = repair(a.after, all_tets(a.after), at);
    a.changes += adapt_to_size(a.after, all_tets(a.after), at);
    a.changes += improve(a.after, all_tets(a.after), at);
    a.changes += optimise_places(a.after, all_tets(a.after));
    const auto relaxed = relax(a.after, all_vertices(a.after));
    a.changes.vertices.insert(a.changes.vertices.end(), relaxed.begin(), relaxed.end());
    return a;
}

bool stayed(const Adapted& a, Vertex v) {
    return v.value < static_cast<int>(a.before.position.size()) && alive(a.before, v) &&
           a.before.position[v] == a.after.position[v];
}

class CarryAfterAdaptation : public testing::TestWithParam<std::uint64_t> {
protected:
    void SetUp() override {
        ASSERT_EQ(verify(mesh.after), "");
        for (Vertex v : all_vertices(mesh.after)) (stayed(mesh, v) ? kept : changed).push_back(v);
        ASSERT_GE(kept.size(), 30u);
        ASSERT_GE(changed.size(), 30u);
        const auto in_body = [&](Vertex v) { return at_region(mesh.after, v, Region(1)); };
        ASSERT_GE(std::ranges::count_if(changed, in_body), 1);
    }
    [[nodiscard]] Field carried(const Field& values) const {
        return carry(values, mesh.after, interpolations(mesh.before, mesh.after, mesh.changes.vertices));
    }

    Adapted mesh = adapted(GetParam());
    std::vector<Vertex> kept, changed;
};

TEST_P(CarryAfterAdaptation, IsExactForLinearFields) {
    const auto at_start = [&](Vertex v) { return linear(mesh.before.position[v]); };
    const Field after = carried(values_of(mesh.before, at_start));
    ASSERT_EQ(after.size(), mesh.after.position.size());
    for (Vertex v : all_vertices(mesh.after)) EXPECT_NEAR(after[v], linear(mesh.after.position[v]), 1e-12);
    const Field constant = carried(values_of(mesh.before, [](Vertex) { return 1800.0; }));
    for (Vertex v : all_vertices(mesh.after)) EXPECT_NEAR(constant[v], 1800, 1800 * 1e-15);
}

TEST_P(CarryAfterAdaptation, KeepsTheValuesOfUnchangedVerticesBitForBit) {
    Random random{GetParam()};
    const Field before = values_of(mesh.before, [&](Vertex) { return random.uniform(); });
    const Field after = carried(before);
    for (Vertex v : kept) EXPECT_EQ(after[v], before[v]);
    for (Vertex v : changed) {  // between the bounds of what was there
        EXPECT_GE(after[v], -1e-8);
        EXPECT_LE(after[v], 1 + 1e-8);
    }
}

TEST_P(CarryAfterAdaptation, NeverCrossesAnInterface) {
    // With the surface's own values of the body, no other value may get into it; and the same from without.
    const auto carried_from = [&](Region region) {
        const auto one_there = [&](Vertex v) { return at_region(mesh.before, v, region) ? 1.0 : 0.0; };
        return carried(values_of(mesh.before, one_there));
    };
    for (Region region : {surroundings, Region(1)}) {
        const Field after = carried_from(region);
        for (Vertex v : all_vertices(mesh.after)) {
            if (!at_region(mesh.after, v, region)) continue;
            EXPECT_NEAR(after[v], 1, 1e-15) << "region " << region.value;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CarryAfterAdaptation, testing::Range(std::uint64_t{1}, std::uint64_t{5}));

TEST(Interpolations, AreOfVerticesThatAreThereAndDiffer) {
    Adapted a = adapted(1);
    std::vector<Vertex> named = a.changes.vertices;
    named.insert(named.end(), a.changes.vertices.begin(), a.changes.vertices.end());  // each more than once
    const auto found = interpolations(a.before, a.after, named);
    ASSERT_FALSE(found.empty());
    for (const Interpolation& i : found) {
        EXPECT_TRUE(alive(a.after, i.vertex));
        EXPECT_FALSE(stayed(a, i.vertex));
        for (Vertex v : i.from) EXPECT_TRUE(alive(a.before, v));
    }
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, &Interpolation::vertex));
    EXPECT_TRUE(std::ranges::adjacent_find(found, {}, &Interpolation::vertex) == found.end());  // each once
    EXPECT_TRUE(interpolations(a.before, a.before, all_vertices(a.before)).empty());
}

TEST(Carry, AlongTheStepsOfAMovingMesh) {
    Domain domain = sphere_in_box();
    domain.bodies.front().motion = [](double t) { return Pose{{0, 0, t}, {}}; };
    MovingMesh moving(domain, improved_mesh(domain, 1), 0);
    const auto here = [](const Mesh& mesh) {
        return values_of(mesh, [&](Vertex v) { return linear(mesh.position[v]); });
    };
    std::size_t carried = 0;
    for (int i = 0; i < 8; ++i) {
        moving.begin_step();
        moving.refine();
        moving.move_boundary(moving.time() + 0.1);
        moving.optimise();
        ASSERT_FALSE(moving.refusal());
        const auto changed = moving.accept().vertices;
        const auto plan = interpolations(moving.before(), moving.reference(), changed);
        const Field after = carry(here(moving.before()), moving.reference(), plan);
        for (Vertex v : all_vertices(moving.reference()))
            ASSERT_NEAR(after[v], linear(moving.reference().position[v]), 1e-12);
        carried += plan.size();
    }
    EXPECT_GE(carried, 50u);
}

}  // namespace
}  // namespace kropla
