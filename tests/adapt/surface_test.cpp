// Operators on the surface of a region: each keeps the volume inside, and leaves a mesh.

#include "adapt/adapt_surface.h"
#include "adapt/cases.h"
#include "adapt/surface.h"
#include "base/random.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

constexpr Region body{1};

Domain finer_sphere() {
    Domain domain = sphere_in_box();
    domain.size.surface = 0.25;
    domain.bodies.front().deformation = [](const Vec3& x, double, double) { return x; };
    return domain;
}

std::vector<Edge> edges_of(const BodySurface& surface) {
    std::vector<Edge> edges;
    for (const auto& [a, b, c] : surface.triangles)
        for (const Edge e : {Edge{a, b}, Edge{b, c}, Edge{c, a}})
            if (e.a < e.b) edges.push_back(e);
    return edges;
}

/// Carries out what `propose` says of random edges of the surface, `count` times at least.
template <class Propose>
void expect_volume_kept(int count, const Propose& propose) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Domain domain = finer_sphere();
        Mesh mesh = initial_mesh(domain, seed);
        const double before = region_volume(mesh, body), whole = before + region_volume(mesh, surroundings);
        Random random{seed};
        Changes changes;
        int done = 0;
        for (int tries = 0; tries < 40 * count && done < count; ++tries) {
            const auto edges = edges_of(deforming_surfaces(domain, mesh).front());
            const Edge edge = edges[random.below(edges.size())];
            const auto around = surface_shell(mesh, edge, body);
            ASSERT_TRUE(around);
            const std::optional<SurfaceChange> change = propose(mesh, *around, edge);
            if (!change) continue;
            const double here = region_volume(mesh, body);
            (void)carry_out_surface(mesh, *change, changes);
            ASSERT_NEAR(region_volume(mesh, body), here, 1e-15 * whole);
            ASSERT_EQ(verify(mesh), "");
            double worst = 0;
            for (Tet t : changes.cells)
                if (alive(mesh, t)) worst = std::max(worst, aspect_ratio(mesh, t));
            ASSERT_LT(worst, std::numeric_limits<double>::infinity());
            ++done;
        }
        EXPECT_EQ(done, count);
        EXPECT_NEAR(region_volume(mesh, body) + region_volume(mesh, surroundings), whole, 1e-13 * whole);
    }
}

TEST(SurfaceOperators, ASplitKeepsTheVolume) {
    expect_volume_kept(20, [](const Mesh& mesh, const Shell& around, Edge edge) {
        return std::optional(surface_split(mesh, around, edge));
    });
}
TEST(SurfaceOperators, ACollapseKeepsTheVolume) {
    expect_volume_kept(10, [](const Mesh& mesh, const Shell&, Edge edge) { return surface_collapse(mesh, edge, {body}, 1); });
}
TEST(SurfaceOperators, ASwapKeepsTheVolume) {
    expect_volume_kept(20, [](const Mesh& mesh, const Shell& around, Edge edge) {
        return surface_swap(mesh, around, edge, {body});
    });
}
TEST(SurfaceOperators, SlidesAndRaisesKeepTheVolume) {
    expect_volume_kept(20, [](const Mesh& mesh, const Shell&, Edge edge) { return slide(mesh, edge.a, {body}); });
    expect_volume_kept(5, [](const Mesh& mesh, const Shell&, Edge edge) { return slide_for_cells(mesh, edge.a, {body}); });
    expect_volume_kept(20, [](const Mesh& mesh, const Shell&, Edge edge) { return raise_to_quadric(mesh, edge.a, {body}); });
}

TEST(SurfaceOperators, AVertexOfASplitComesToBeOnTheSphere) {
    const Domain domain = finer_sphere();
    Mesh mesh = initial_mesh(domain, 1);
    Changes changes;
    double flat = 0, raised = 0;
    const auto out = [&](Vertex v) { return norm(mesh.position[v]); };
    const Edge edge = edges_of(deforming_surfaces(domain, mesh).front()).front();
    const double radius = (out(edge.a) + out(edge.b)) / 2;
    const auto done = carry_out_surface(mesh, surface_split(mesh, *surface_shell(mesh, edge, body), edge), changes);
    const Vertex v = done.vertices.front();
    flat = std::abs(out(v) - radius);
    const auto change = raise_to_quadric(mesh, v, {body});
    ASSERT_TRUE(change);
    (void)carry_out_surface(mesh, *change, changes);
    raised = std::abs(out(v) - radius);
    EXPECT_GE(flat, 0.01);
    EXPECT_LE(raised, 0.25 * flat);
}

double largest(const Vec3& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }
/// How many coordinates are those of the cube's faces: 2 on an edge, 3 in a corner.
int count_faces(const Vec3& x) {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis) count += std::abs(std::abs(x[axis]) - 0.5) < 1e-12 ? 1 : 0;
    return count;
}

TEST(SurfaceOperators, SharpEdgesStayWhereTheyAre) {
    std::vector<Vec3> corners;
    for (int i = 0; i < 8; ++i) corners.push_back({i % 2 - 0.5, i / 2 % 2 - 0.5, i / 4 - 0.5});
    const std::vector<std::array<int, 3>> triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    Domain domain = finer_sphere();
    domain.bodies.front().shape = shape_within(corners, triangles);
    const Mesh mesh = initial_mesh(domain, 1);
    int sharp = 0, smooth = 0, collapses = 0;
    for (const Edge edge : edges_of(deforming_surfaces(domain, mesh).front())) {
        const Vec3 &a = mesh.position[edge.a], &b = mesh.position[edge.b];
        ASSERT_NEAR(largest(a), 0.5, 1e-12);
        if (const auto change = surface_collapse(mesh, edge, {body}, 10)) {
            const Vec3 at = change->cavity.inserted.front();
            EXPECT_NEAR(largest(at), 0.5, 1e-12);
            EXPECT_GE(count_faces(at), std::max(count_faces(a), count_faces(b)));
            collapses += count_faces(at) > 1 ? 1 : 0;
        }
        if (!is_sharp(surface_star(mesh, edge.a, body), mesh, blunt)) {
            ++smooth;
            continue;
        }
        ++sharp;
        EXPECT_FALSE(slide(mesh, edge.a, {body}));
        EXPECT_FALSE(raise_to_quadric(mesh, edge.a, {body}));
    }
    EXPECT_GE(sharp, 60);
    EXPECT_GE(smooth, 60);
    EXPECT_GE(collapses, 60);
    int heights = 0;
    for (Vertex v : mesh.position.indices()) {
        const SurfaceStar star = surface_star(mesh, v, body);
        if (star.sides.empty() || is_sharp(star, mesh, blunt)) continue;
        if (const auto height = height_of_quadric(mesh, star, {body})) {
            EXPECT_NEAR(*height, 0, 1e-12);
            ++heights;
        }
    }
    EXPECT_GE(heights, 20);
}

}  // namespace
}  // namespace kropla
