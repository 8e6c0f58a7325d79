#include "generate/layers.h"

#include "domain/layer_room.h"
#include "generate/domains.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

using namespace kropla;

namespace {

using Side = LayerOptions::Side;

/// A ball of radius 1 with a layer 0.4 thick: three prisms, 0.1 and 0.1 * 1.25 and so on high.
Domain layered_ball(const Vec3& centre, Side side = Side::outside) {
    Domain domain = small_domain({ball(centre, 1)});
    domain.bodies[0].layer = LayerOptions{3, 0.1, 1.25, side, {}};
    return domain;
}

/// The heights of column c, from the wall.
std::vector<double> heights(const Stacks& stacks, std::size_t c) {
    std::vector<double> found;
    const auto step = static_cast<std::size_t>(stacks.layer.count) + 1;
    for (std::size_t k = 1; k < step; ++k)
        found.push_back(distance(stacks.places[c * step + k - 1], stacks.places[c * step + k]));
    return found;
}

double total(const std::vector<double>& values) {
    double sum = 0;
    for (double value : values) sum += value;
    return sum;
}

}  // namespace

TEST(Columns, AreOfTheHeightsAskedWhereThereIsRoom) {
    const Domain domain = layered_ball({0, 0, 4}, Side::both);
    const Snapshot at = snapshot(domain, 0);
    const Surface wall = triangulate_surface(at.shapes[0], 0.4, 1);
    for (const bool inside : {false, true}) {
        const auto stacks = stacks_on(wall, 0, inside, at);
        ASSERT_TRUE(stacks);
        for (std::size_t c = 0; c < wall.points.size(); ++c) {
            EXPECT_EQ(stacks->places[4 * c], wall.points[c]);
            const auto h = heights(*stacks, c);
            for (std::size_t k = 0; k < 3; ++k)
                EXPECT_NEAR(h[k] / (0.1 * std::pow(1.25, static_cast<double>(k))), 1, 1e-12);
            const Vec3& centre = at.shapes[0].centre;
            const double out = distance(stacks->places[4 * c + 3], centre) - distance(wall.points[c], centre);
            EXPECT_NEAR(out, (inside ? -1 : 1) * total(h), 6e-7);  // along the normal
        }
    }
}

TEST(Columns, AreThinnedByGapsAndGraded) {
    const double gap = 0.6;
    const Domain domain = layered_ball({0, 0, 1 + gap});
    const Snapshot at = snapshot(domain, 0);
    const Surface wall = triangulate_surface(at.shapes[0], 0.2, 1);
    const auto stacks = stacks_on(wall, 0, false, at);
    ASSERT_TRUE(stacks);
    std::vector<double> thick;
    for (std::size_t c = 0; c < wall.points.size(); ++c) {
        const auto h = heights(*stacks, c);
        EXPECT_NEAR(h[1] / h[0], 1.25, 1e-12);
        EXPECT_NEAR(h[2] / h[1], 1.25, 1e-12);
        thick.push_back(total(h));
        const Vec3 on_body = closest_point(at.shapes[0], wall.points[c]);
        EXPECT_LE(thick.back(), on_body.z / 3 + 1e-12);  // a third of the body's gap at most
    }
    EXPECT_NEAR(*std::ranges::min_element(thick), gap / 3, 0.01);
    EXPECT_NEAR(*std::ranges::max_element(thick), 0.38125, 1e-12);
    for (const auto& t : wall.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const auto a = static_cast<std::size_t>(t[i]), b = static_cast<std::size_t>(t[(i + 1) % 3]);
            EXPECT_LE(std::abs(thick[a] - thick[b]), distance(wall.points[a], wall.points[b]) / 3 + 1e-12);
        }
}

TEST(Columns, OfTwoBodiesNeverMeetAndLeaveHalfTheGap) {
    Domain domain = small_domain({ball({-1.1, 0, 4}, 1), turned_ellipsoid({1.3, 0, 4}, {1.2, 0.8, 0.9})});
    for (Body& body : domain.bodies) body.layer = LayerOptions{3, 0.1, 1.25, Side::outside, {}};
    const Snapshot at = snapshot(domain, 0);
    const double gap = gap_between(at.shapes[0], at.shapes[1]);
    ASSERT_GT(gap, 0.1);
    ASSERT_LT(gap, 0.7);
    double least = 1e9;
    std::vector<Surface> shells;
    for (std::size_t body = 0; body < 2; ++body) {
        const Surface wall = triangulate_surface(at.shapes[body], 0.2, 1);
        shells.push_back(shell_of(wall, *stacks_on(wall, body, false, at)));
    }
    for (const Vec3& a : shells[0].points)
        for (const Vec3& b : shells[1].points) least = std::min(least, distance(a, b));
    EXPECT_GT(least, 0.49 * gap);
}

TEST(Columns, GiveWayToABodyWithoutALayerAsToAWall) {
    Domain domain = small_domain({ball({-1.2, 0, 4}, 1), ball({1.2, 0, 4}, 1)});
    domain.bodies[0].layer = LayerOptions{3, 0.1, 1.25, Side::outside, {}};
    domain.bodies[1].layer = LayerOptions{3, 0.1, 1.25, Side::inside, {}};
    const double room = 0.4 - 2 * outward_shift(domain.bodies[0].shape, domain.size.surface);
    EXPECT_NEAR(layer_thickness(snapshot(domain, 0), 0, false, {-0.2, 0, 4}), room / 3, 1e-12);
    domain.bodies[1].layer->side = Side::both;
    EXPECT_NEAR(layer_thickness(snapshot(domain, 0), 0, false, {-0.2, 0, 4}), room / 4, 1e-12);
}

TEST(Columns, DependOnThePlaceNotOnTheWayThere) {
    Domain domain = layered_ball({0, 0, 4});
    domain.bodies[0].motion = [](double t) {
        return Pose{{0, 0, -2.7 * std::sin(t)}, rotation_about({1, 1, 0}, t)};
    };
    const Snapshot start = snapshot(domain, 0);
    const Surface wall = triangulate_surface(start.shapes[0], 0.3, 1);
    const PrismLayer layer = stacks_on(wall, 0, false, start)->layer;
    const auto places_at = [&](double t) {
        std::vector<Vec3> moved;
        for (const Vec3& x : wall.points)
            moved.push_back(placed(domain.bodies[0].shape, domain.bodies[0].motion(t), x));
        return column_places(layer, moved, snapshot(domain, t));
    };
    const auto far = places_at(0.2), near = places_at(1.5), far_again = places_at(0.2);
    EXPECT_EQ(far, far_again);
    double least = 1;
    for (std::size_t c = 0; c < wall.points.size(); ++c) {
        EXPECT_NEAR(distance(far[4 * c], far[4 * c + 3]), 0.38125, 1e-12);
        least = std::min(least, distance(near[4 * c], near[4 * c + 3]));
    }
    EXPECT_NEAR(least, (4 - 1 - 2.7 * std::sin(1.5)) / 3, 0.01);
}

TEST(Columns, InsideGiveWayToCurvature) {
    Domain domain = small_domain({turned_ellipsoid({0, 0, 4}, {2, 1, 1})});
    domain.bodies[0].layer =
        LayerOptions{3, 0.1, 1.25, Side::inside, {}};  // 0.38; the tips have a radius of 0.5
    const Snapshot at = snapshot(domain, 0);
    const Surface wall = triangulate_surface(at.shapes[0], 0.2, 1);
    const auto stacks = stacks_on(wall, 0, true, at);
    double least = 1, largest = 0;
    for (std::size_t c = 0; c < wall.points.size(); ++c) {
        const double thick = total(heights(*stacks, c));
        least = std::min(least, thick);
        largest = std::max(largest, thick);
        EXPECT_NEAR(signed_distance(at.shapes[0], stacks->places[4 * c + 3]), -thick,
                    0.008);  // no other wall is nearer
    }
    EXPECT_NEAR(least, 0.25, 0.0016);
    EXPECT_NEAR(largest, 0.38125, 1e-12);
}

TEST(Columns, TheShellIsSeenFromOutsideTheBody) {
    const Domain domain = layered_ball({0, 0, 4}, Side::both);
    const Snapshot at = snapshot(domain, 0);
    const Surface wall = triangulate_surface(at.shapes[0], 0.4, 1);
    for (const bool inside : {false, true}) {
        const Stacks stacks = *stacks_on(wall, 0, inside, at);
        EXPECT_EQ(stacks.layer.region, inside ? Region(1) : surroundings);
        EXPECT_EQ(stacks.layer.body, Region(1));
        const Surface shell = shell_of(wall, stacks);
        for (const auto& [a, b, c] : shell.triangles) {
            const auto place = [&](int i) {
                return shell.points[static_cast<std::size_t>(i)] - at.shapes[0].centre;
            };
            EXPECT_GT(determinant(place(a), place(b), place(c)), 0);
        }
    }
    Domain bare = domain;
    bare.bodies[0].layer = std::nullopt;
    EXPECT_FALSE(stacks_on(wall, 0, false, snapshot(bare, 0)));
}

TEST(NarrowestGap, SaysWhereAndToWhat) {
    Domain domain = small_domain({ball({0, 0, 4}, 1), ball({2.2, 0, 4}, 0.5)});
    domain.size = {0.4, 0.2, 0.9};
    domain.bodies[0].layer = LayerOptions{2, 0.02, 1.25, Side::outside, {}};
    Mesh mesh = generate_mesh(domain, 1);
    const auto gap = narrowest_gap(mesh, snapshot(domain, 0));
    ASSERT_TRUE(gap);
    EXPECT_EQ(gap->body, 0u);
    EXPECT_EQ(gap->wall, -1);
    EXPECT_EQ(gap->other, 1u);
    EXPECT_NEAR(gap->distance, 0.7, 0.022);  // at the vertices of a coarse wall
    EXPECT_EQ(gap->allowed, 0.02);
    EXPECT_NEAR(norm(gap->place - Vec3{1, 0, 4}), 0, 0.163);
    domain.bodies[0].motion = [](double) { return Pose{{0, 0, -2.99}, {}}; };
    domain.bodies[0].layer->min_gap = 0.05;
    for (Vertex v : mesh.layers[0].columns) mesh.position[v].z -= 2.99;
    const auto near = narrowest_gap(mesh, snapshot(domain, 0));
    EXPECT_EQ(near->wall, 4);
    EXPECT_EQ(near->allowed, 0.05);
    EXPECT_LT(near->distance, 0.0232);
    EXPECT_FALSE(narrowest_gap(generate_mesh(small_domain({ball({0, 0, 4}, 1)}), 1), snapshot(domain, 0)));
}
