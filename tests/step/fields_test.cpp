#include <kropla/step/fields.h>

#include "adapt/cases.h"
#include <kropla/adapt/attempt.h>
#include <kropla/mesh/quality.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace kropla {
namespace {

double linear(const Vec3& x) { return 3 + x.x - 2 * x.y + 0.5 * x.z; }

/// What a user may have at a vertex.
struct Node {
    int kind = 7;
    double temperature = 0;
    Vec3 velocity;
};

struct Cell {
    double fraction = 0;
    float colour = 1;
};

/// A step of the falling sphere that changes cells, not yet accepted.
struct Step {
    Domain domain = [] {
        Domain falling = sphere_in_box();
        falling.bodies[0].motion = [](double t) { return Pose{{0, 0, -t}, {}}; };
        return falling;
    }();
    MovingMesh moving{domain, improved_mesh(domain, 1), 0};
    RemeshedAttempt done = remesh(move_bodies(Attempt(moving), 0.15));
    TransferPlan plan =
        plan_transfer(done.before(), done.current(), done.remeshed().cells, done.remeshed().vertices);
};

TEST(Fields, CarriesNumbersVectorsAndMembersOfStructs) {
    const Step step;
    const Mesh &before = step.done.before(), &after = step.done.current();
    ASSERT_GT(step.done.remeshed().vertices_inserted, 0);
    Array<Vertex, double> number(before.position.size());
    Array<Vertex, Vec3> vector(before.position.size());
    std::vector<Node> nodes(before.position.size());
    Array<Tet, double> of_cell(before.tets.size(), 2.5);
    std::vector<Cell> cells(before.tets.size(), Cell{2.5, 9});
    for (Vertex v : all_vertices(before)) {
        const double value = linear(before.position[v]);
        number[v] = value;
        vector[v] = {value, -value, 1};
        nodes[static_cast<std::size_t>(v.value)] = {3, value, {value, -value, 1}};
    }
    Fields fields;
    fields.per_vertex(number);
    fields.per_vertex(vector);
    fields.per_vertex(nodes, &Node::temperature, &Node::velocity);
    fields.per_cell(of_cell);
    fields.per_cell(cells, &Cell::fraction);
    const auto reports = fields.carry(step.plan);
    ASSERT_EQ(reports.size(), 5u);
    ASSERT_EQ(nodes.size(), after.position.size());
    for (Vertex v : all_vertices(after)) {
        const double expected = linear(after.position[v]);
        const Node& node = nodes[static_cast<std::size_t>(v.value)];
        ASSERT_NEAR(number[v], expected, 1e-12);
        ASSERT_EQ(vector[v].x, number[v]);
        ASSERT_EQ(node.temperature, number[v]);
        ASSERT_EQ(node.velocity.x, number[v]);
        ASSERT_NEAR(node.velocity.y, -expected, 1e-12);
    }
    for (Tet t : all_tets(after)) {
        ASSERT_NEAR(of_cell[t], 2.5, 1e-14);
        ASSERT_EQ(cells[static_cast<std::size_t>(t.value)].fraction, of_cell[t]);
    }
    for (const TransferReport& report : reports) EXPECT_LE(std::abs(report.error()), 1e-13);
    EXPECT_GT(reports[1].size, reports[0].size);
}

// A pressure, say, that has a value on each side of the surface; on the other side it has none.
TEST(Fields, CarriesEachSideOfAnInterfaceByItself) {
    const Step step;
    const Mesh &before = step.done.before(), &after = step.done.current();
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const Region body{1};
    Array<Vertex, double> outside(before.position.size(), nothing), inside(before.position.size(), nothing);
    const auto fill = [&](Array<Vertex, double>& values, Region region, double shift) {
        for (Tet t : all_tets(before))
            if (before.region[t] == region)
                for (Vertex v : before.tets[t]) values[v] = shift + linear(before.position[v]);
    };
    fill(outside, surroundings, 0);
    fill(inside, body, 100);
    Fields fields;
    fields.per_vertex(outside, {.only = surroundings});
    fields.per_vertex(inside, {.only = body});
    fields.carry(step.plan);
    for (Tet t : all_tets(after))
        for (Vertex v : after.tets[t]) {
            const bool is_out = after.region[t] == surroundings;
            ASSERT_NEAR((is_out ? outside : inside)[v], (is_out ? 0 : 100) + linear(after.position[v]), 1e-12);
        }
    Fields whole;
    whole.per_vertex(inside);
    EXPECT_THROW(whole.carry(step.plan), FieldError);  // who does not say so is told
}

TEST(Fields, AreKeptAndPutBackToTheBit) {
    std::vector<Node> nodes(3, Node{1, -0.0, {1, 2, 3}});
    Array<Tet, double> cells{0.1, 0.2};
    Fields fields;
    fields.per_vertex(nodes, &Node::temperature);
    fields.per_cell(cells);
    const Fields::Copy copy = fields.copy();
    nodes.assign(9, {});
    cells[Tet(0)] = 7;
    for (int again = 0; again < 2; ++again) {
        copy.put_back();
        ASSERT_EQ(nodes.size(), 3u);
        EXPECT_EQ(nodes[2].kind, 1);
        EXPECT_TRUE(std::signbit(nodes[2].temperature));
        EXPECT_EQ(cells[Tet(0)], 0.1);
        nodes.clear();
    }
}

TEST(Fields, AnArrayThatIsTooShortIsSaid) {
    const Domain domain = sphere_in_box();
    const Mesh mesh = improved_mesh(domain, 1);
    Array<Vertex, double> values(3);
    Fields fields;
    fields.per_vertex(values);
    EXPECT_THROW(fields.check_sizes(mesh), std::logic_error);
    values.resize(mesh.position.size());
    EXPECT_NO_THROW(fields.check_sizes(mesh));
}

}  // namespace
}  // namespace kropla
