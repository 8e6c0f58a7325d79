#include "generate/delaunay.h"

#include <kropla/base/predicates.h>
#include "base/random.h"
#include "base/tetrahedron.h"
#include "generate/hilbert.h"
#include <kropla/mesh/cells.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace kropla {
namespace {

constexpr std::uint64_t seed = 11;
using Points = std::vector<Vec3>;

const Vec3& at(const Points& points, Vertex v) { return points[static_cast<std::size_t>(v.value)]; }

Points random_points(int n) {
    Random random{seed};
    Points points(static_cast<std::size_t>(n));
    for (Vec3& p : points) p = {random.uniform(), random.uniform(), random.uniform()};
    return points;
}

/// n^3 points; a spacing that is no sum of powers of two makes them almost, not exactly, cospherical.
Points grid(int n, double spacing) {
    Points points;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            for (int k = 0; k < n; ++k) points.push_back({spacing * i, spacing * j, spacing * k});
    return points;
}

/// Points of integer coordinates with x^2 + y^2 + z^2 = 1881: hundreds, exactly on one sphere.
Points on_sphere() {
    Points points;
    for (int x = -43; x <= 43; ++x)
        for (int y = -43; y <= 43; ++y)
            for (int z = -43; z <= 43; ++z)
                if (x * x + y * y + z * z == 1881) points.push_back({1.0 * x, 1.0 * y, 1.0 * z});
    return points;
}

/// Random points in a box, on its faces, edges and corners.
Points box_with_faces(int inside, int per_face) {
    Points points = random_points(inside + 6 * per_face);
    for (int i = 0; i < 6 * per_face; ++i) points[static_cast<std::size_t>(i)][i % 3] = i % 6 < 3 ? 0 : 1;
    for (int i = 0; i < 8; ++i) points.push_back({1.0 * (i & 1), 1.0 * (i >> 1 & 1), 1.0 * (i >> 2)});
    for (int i = 1; i < 8; ++i) points.push_back({0.125 * i, 0, 1});
    return points;
}

using FacetVertices = std::array<Vertex, 3>;
FacetVertices outward_facet(const Triangulation& t, Tet tet, std::size_t corner) {
    FacetVertices facet;
    for (std::size_t i = 0; i < 3; ++i)
        facet[i] = t.tets[tet][static_cast<std::size_t>(tet_facets[corner][i])];
    return facet;
}

std::size_t mirror(const Triangulation& t, Tet from, Tet to) {
    return static_cast<std::size_t>(std::ranges::find(t.neighbour[to], from) - t.neighbour[to].begin());
}

/// Tets positive; neighbours mutual and sharing their facet; and no vertex inside the sphere of the tet
/// across a facet, ties by index, which makes it the one Delaunay triangulation.
void expect_delaunay(const Points& points, const Triangulation& t) {
    for (const Tet tet : t.tets.indices()) {
        const auto& v = t.tets[tet];
        ASSERT_GT(orient3d(at(points, v[0]), at(points, v[1]), at(points, v[2]), at(points, v[3])), 0);
        for (std::size_t i = 0; i < 4; ++i) {
            const Tet n = t.neighbour[tet][i];
            if (!n.exists()) continue;
            const std::size_t m = mirror(t, tet, n);
            ASSERT_LT(m, 4u) << "neighbours not mutual";
            FacetVertices here = outward_facet(t, tet, i), there = outward_facet(t, n, m);
            std::ranges::sort(here);
            std::ranges::sort(there);
            ASSERT_EQ(here, there);
            const Vertex e = t.tets[n][m];
            const auto p = [&](Vertex w) { return &at(points, w); };
            ASSERT_LT(insphere_perturbed({p(v[0]), p(v[1]), p(v[2]), p(v[3]), p(e)},
                                         {v[0].value, v[1].value, v[2].value, v[3].value, e.value}), 0);
        }
    }
}

/// Every point is a vertex or equal to one of lower index; the hull is one closed convex surface with the
/// volume of the tets; Euler's relation holds for the ball that they fill.
void expect_fills_hull(const Points& points, const Triangulation& t) {
    std::set<Vertex> vertices;
    std::set<std::pair<Vertex, Vertex>> edges, hull_edges;
    int hull_facets = 0;
    double volume = 0, hull_volume = 0;
    std::vector<FacetVertices> hull;
    for (const Tet tet : t.tets.indices()) {
        const auto& v = t.tets[tet];
        volume += tet_volume(at(points, v[0]), at(points, v[1]), at(points, v[2]), at(points, v[3]));
        vertices.insert(v.begin(), v.end());
        for (const auto& [i, j] : tet_edges)
            edges.insert(std::minmax(v[static_cast<std::size_t>(i)], v[static_cast<std::size_t>(j)]));
        for (std::size_t i = 0; i < 4; ++i) {
            if (t.neighbour[tet][i].exists()) continue;
            ++hull_facets;
            const FacetVertices f = outward_facet(t, tet, i);
            hull.push_back(f);
            for (std::size_t j = 0; j < 3; ++j) EXPECT_TRUE(hull_edges.insert({f[j], f[(j + 1) % 3]}).second);
            hull_volume += determinant(at(points, f[0]) - points[0], at(points, f[1]) - points[0],
                                       at(points, f[2]) - points[0]) / 6;
        }
    }
    EXPECT_NEAR(volume, hull_volume, 1e-12 * volume);
    for (const auto& [a, b] : hull_edges) EXPECT_TRUE(hull_edges.contains({b, a})) << "the hull has a gap";
    std::set<Vertex> on_hull;
    for (const FacetVertices& f : hull) on_hull.insert(f.begin(), f.end());
    EXPECT_EQ(static_cast<int>(on_hull.size()) - static_cast<int>(hull_edges.size()) / 2 + hull_facets, 2);
    for (std::size_t h = 0; h < hull.size(); h += 1 + hull.size() / 50)
        for (const Vec3& p : points)
            ASSERT_LE(orient3d(at(points, hull[h][0]), at(points, hull[h][1]), at(points, hull[h][2]), p), 0)
                << "a point beyond the hull";
    const int tets = static_cast<int>(t.tets.size()), facets = (4 * tets + hull_facets) / 2;
    EXPECT_EQ(static_cast<int>(vertices.size()) - static_cast<int>(edges.size()) + facets - tets, 1);
    ASSERT_EQ(t.same_as.size(), points.size());
    for (const Vertex v : t.same_as.indices()) {
        const Vertex same = t.same_as[v];
        EXPECT_EQ(same.exists(), !vertices.contains(v));
        EXPECT_TRUE(!same.exists() || (same < v && at(points, same) == at(points, v)));
    }
}

void expect_right(const Points& points) {
    SCOPED_TRACE(testing::Message() << points.size() << " points, seed " << seed);
    const Triangulation t = triangulate(points);
    ASSERT_FALSE(t.tets.empty());
    expect_delaunay(points, t);
    expect_fills_hull(points, t);
}

/// The tets as sorted vertices, sorted.
std::vector<std::array<Vertex, 4>> canonical(const Triangulation& t) {
    std::vector<std::array<Vertex, 4>> tets(t.tets.begin(), t.tets.end());
    for (auto& tet : tets) std::ranges::sort(tet);
    std::ranges::sort(tets);
    return tets;
}

std::vector<Vertex> shuffled(std::size_t n, std::uint64_t with_seed) {
    Random random{with_seed};
    std::vector<Vertex> order(n);
    for (std::size_t i = 0; i < n; ++i) order[i] = Vertex(i);
    for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    return order;
}

TEST(Delaunay, OneTet) {
    const Points points = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
    const Triangulation t = triangulate(points);
    EXPECT_EQ(t.tets.size(), 1u);
    expect_right(points);
}

TEST(Delaunay, RandomPoints) {
    for (const int n : {5, 10, 100, 5000}) expect_right(random_points(n));
}

TEST(Delaunay, GradedPoints) {
    Points points = random_points(3000);
    for (Vec3& p : points) p = {p.x * p.x * p.x, p.y * p.y * p.y * p.y, 1e-9 * p.z};
    expect_right(points);
}

TEST(Delaunay, Grids) {
    expect_right(grid(2, 1.0));
    expect_right(grid(8, 1.0));
    expect_right(grid(8, 0.1));
}

TEST(Delaunay, CosphericalPoints) {
    Points points = on_sphere();
    ASSERT_GT(points.size(), 640u);
    expect_right(points);
    points.push_back({0, 0, 0});  // one cavity of all tets: the way of large cavities
    points.push_back({5, 4, 3});
    expect_right(points);
}

TEST(Delaunay, PointsOnTheHullsPlanes) {
    expect_right(box_with_faces(500, 60));
    expect_right(box_with_faces(0, 60));
    Points points = grid(5, 1.0);
    for (Vec3 p : random_points(200)) points.push_back({4 * p.x, 4 * p.y, p.z < 0.5 ? 0.0 : 4.0});
    expect_right(points);
}

TEST(Delaunay, CoplanarAndOne) {
    Points points;
    for (const Vec3& p : grid(5, 1.0)) points.push_back({p.x + 5 * p.z, p.y, 0});  // 25 x 5, with duplicates
    for (const Vec3& p : random_points(100)) points.push_back({10 * p.x, 5 * p.y, 0});
    EXPECT_TRUE(triangulate(points).tets.empty());
    points.push_back({2, 2, 3});
    expect_right(points);
}

TEST(Delaunay, CollinearAndTwo) {
    Points points;
    for (int i = 0; i < 50; ++i) points.push_back({1.0 * i, 2.0 * i, 0.5 * i});
    EXPECT_TRUE(triangulate(points).tets.empty());
    points.push_back({1, 0, 0});
    EXPECT_TRUE(triangulate(points).tets.empty());
    points.push_back({0, 0, 1});
    expect_right(points);
}

TEST(Delaunay, Duplicates) {
    Points points = random_points(300);
    for (std::size_t i = 0; i < 300; i += 2) points.push_back(points[i]);
    for (std::size_t i = 0; i < 300; i += 3) points.push_back(points[i]);
    points.insert(points.begin(), 20, points[7]);
    expect_right(points);
}

TEST(Delaunay, TooFewPoints) {
    EXPECT_TRUE(triangulate({}).tets.empty());
    const Points same(10, Vec3{1, 2, 3});
    const Triangulation t = triangulate(same);
    EXPECT_TRUE(t.tets.empty());
    EXPECT_EQ(t.same_as[Vertex{9}], Vertex{0});
    EXPECT_FALSE(t.same_as[Vertex{0}].exists());
}

// The predicates are wrong there, and the walk to a point may go round and round.
TEST(Delaunay, EndsWhereCoordinatesUnderflow) {
    int refused = 0;
    for (unsigned drawn = 1; drawn <= 40; ++drawn) {
        Random random(drawn);
        std::vector<Vec3> points;
        for (int i = 0; i < 60; ++i) {
            Vec3& x = points.emplace_back();
            for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(0, 1) * (random.uniform(0, 1) < 0.5 ? 1e-160 : 1);
        }
        try {
            (void)triangulate(points);
        } catch (const std::invalid_argument&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(Delaunay, IsUniqueWhateverTheOrder) {
    for (const Points& points : {random_points(200), grid(5, 1.0), on_sphere(), box_with_faces(50, 20)}) {
        const auto tets = canonical(triangulate(points));
        for (std::uint64_t s = 1; s <= 5; ++s)
            EXPECT_EQ(canonical(triangulate_in_order(points, shuffled(points.size(), s))), tets)
                << points.size() << " points, order of seed " << s;
    }
}

TEST(Hilbert, GoesFromNeighbourToNeighbour) {
    constexpr std::uint32_t n = 8;
    std::map<std::uint64_t, Vec3> along;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t k = 0; k < n; ++k)
                along[hilbert_index({i, j, k})] = {1.0 * i, 1.0 * j, 1.0 * k};
    ASSERT_EQ(along.size(), n * n * n);
    EXPECT_EQ(along.rbegin()->first, n * n * n - 1);
    for (auto next = std::next(along.begin()); next != along.end(); ++next)
        EXPECT_EQ(distance(next->second, std::prev(next)->second), 1) << "after " << next->first;
}

TEST(Hilbert, RoundsHoldEveryPointOnce) {
    const std::vector<Vertex> order = shuffled(20000, seed);
    std::vector<Vertex> rounds = in_random_rounds(order);
    EXPECT_NE(rounds, order);
    std::ranges::sort(rounds);
    for (std::size_t i = 0; i < rounds.size(); ++i) ASSERT_EQ(rounds[i], Vertex(i));
}

}  // namespace
}  // namespace kropla
