// Surfaces that end on faces of the box: operators keep the line on the face, and the volume; bodies that move through faces.

#include "adapt/adapt_surface.h"
#include "adapt/cases.h"
#include "adapt/surface.h"
#include "base/random.h"
#include <kropla/domain/solids.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace kropla {
namespace {

constexpr Region body{1};
const Box box = {{-1, -1, 0}, {1, 1, 1.5}};

Domain with(const Shape& shape, Deformation deformation = {}) {
    Domain domain{box, {}, {0.2, 0.3, 0.4}};
    Body one{"body", shape};
    one.deformation = std::move(deformation);
    domain.bodies.push_back(cut_body(std::move(one)));
    return domain;
}
Shape wire() { return cylinder(box, {0, 0, 0.7}, {0, 0, 1.5}, 0.4); }

BodySurface surface_of(const Domain& domain, const Mesh& mesh) { return deforming_surfaces(domain, mesh).front(); }

/// The open edges of the surface.
std::vector<Edge> line_of(const BodySurface& surface) {
    std::set<std::pair<Vertex, Vertex>> seen;
    std::vector<Edge> line;
    for (const auto& [a, b, c] : surface.triangles)
        for (const Edge e : {Edge{a, b}, Edge{b, c}, Edge{c, a}}) seen.insert({e.a, e.b});
    for (const auto& [a, b] : seen)
        if (!seen.contains({b, a})) line.push_back({a, b});
    return line;
}

/// All of the line is in the face z max, and goes round once.
void expect_line(const Domain& domain, const Mesh& mesh) {
    std::set<Vertex> from, to;
    for (const auto& [a, b] : line_of(surface_of(domain, mesh))) {
        EXPECT_EQ(mesh.position[a].z, box.max.z);
        EXPECT_TRUE(from.insert(a).second);
        EXPECT_TRUE(to.insert(b).second);
    }
    EXPECT_EQ(from, to);
    EXPECT_GT(from.size(), 5u);
}

/// Carries out, on random edges with an end on the line, what `propose` says.
template <class Propose>
void expect_kept(int count, const Propose& propose) {
    constexpr std::uint64_t seed = 5;
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Domain domain = with(wire());
    Mesh mesh = initial_mesh(domain, seed);
    const double before = region_volume(mesh, body);
    Random random{seed};
    Changes changes;
    int done = 0;
    for (int tries = 0; tries < 60 * count && done < count; ++tries) {
        const BodySurface surface = surface_of(domain, mesh);
        const auto& t = surface.triangles[random.below(surface.triangles.size())];
        const Edge edge{t[0], t[1]};
        if (mesh.position[edge.a].z != box.max.z && mesh.position[edge.b].z != box.max.z) continue;
        const auto around = surface_shell(mesh, edge, body);
        ASSERT_TRUE(around);
        const std::optional<SurfaceChange> change = propose(mesh, *around, edge);
        if (!change || !(change->worst_after < 1000)) continue;
        (void)carry_out_surface(mesh, *change, changes);
        ASSERT_NEAR(region_volume(mesh, body), before, 1e-14);
        ASSERT_NEAR(region_volume(mesh, body) + region_volume(mesh, surroundings), 6, 1e-13);
        ASSERT_EQ(verify(mesh), "");
        expect_line(domain, mesh);
        ++done;
    }
    EXPECT_EQ(done, count);
}

TEST(LinesOnFaces, AreKeptByTheOperatorsOfSurfaces) {
    expect_kept(10, [](const Mesh& mesh, const Shell& shell, Edge edge) { return std::optional(surface_split(mesh, shell, edge)); });
    expect_kept(5, [](const Mesh& mesh, const Shell&, Edge edge) { return surface_collapse(mesh, edge, {body}, 1); });
    expect_kept(5, [](const Mesh& mesh, const Shell& shell, Edge edge) { return surface_swap(mesh, shell, edge, {body}); });
    expect_kept(5, [](const Mesh& mesh, const Shell&, Edge edge) { return slide(mesh, edge.a, {body}); });
    expect_kept(5, [](const Mesh& mesh, const Shell&, Edge edge) { return slide_for_cells(mesh, edge.a, {body}); });
}

TEST(LinesOnFaces, EdgesOfTheLineSplitAndCollapse) {
    const Domain domain = with(wire());
    Mesh mesh = initial_mesh(domain, 1);
    const double before = region_volume(mesh, body);
    Changes changes;
    const auto edges = line_of(surface_of(domain, mesh));
    for (const Edge edge : edges) {
        const auto around = surface_shell(mesh, edge, body);
        ASSERT_TRUE(around && !around->closed);
        EXPECT_FALSE(surface_swap(mesh, *around, edge, {body}));
        (void)carry_out_surface(mesh, surface_split(mesh, *around, edge), changes);
    }
    EXPECT_EQ(line_of(surface_of(domain, mesh)).size(), 2 * edges.size());
    std::size_t collapsed = 0;
    for (const Edge edge : line_of(surface_of(domain, mesh))) {
        if (!alive(mesh, edge.a) || !alive(mesh, edge.b)) continue;
        const auto change = surface_collapse(mesh, edge, {body}, 1);
        if (!change) continue;
        (void)carry_out_surface(mesh, *change, changes);
        ++collapsed;
    }
    EXPECT_GE(collapsed, edges.size() / 2);
    EXPECT_EQ(line_of(surface_of(domain, mesh)).size(), 2 * edges.size() - collapsed);
    EXPECT_EQ(verify(mesh), "");
    expect_line(domain, mesh);
    EXPECT_NEAR(region_volume(mesh, body), before, 1e-14);
}

/// Goes on to `end` [s] in steps, and returns the worst R/r.
double follow(MovingMesh& moving, double end, int steps) {
    double worst = 0;
    for (int i = 1; i <= steps; ++i) {
        Fields none;
        while (moving.time() < end * i / steps - 1e-12) (void)advance(moving, none, end * i / steps - moving.time(), {});
        EXPECT_EQ(verify(moving.reference()), "") << "step " << i;
        worst = std::max(worst, worst_of(moving.reference()));
    }
    return worst;
}

TEST(ThroughFaces, AWireIsFed) {
    Domain domain = with(wire());
    domain.bodies[0].deformation = [](const Vec3& x, double t0, double t1) { return x + Vec3{0, 0, -0.5 * (t1 - t0)}; };
    Mesh mesh = initial_mesh(domain, 1);
    const double before = region_volume(mesh, body);
    MovingMesh moving(domain, std::move(mesh), 0);
    EXPECT_LE(follow(moving, 0.6, 6), 5.9);
    expect_line(domain, moving.reference());
    EXPECT_NEAR(region_volume(moving.reference(), body) / (before * 1.1 / 0.8), 1, 0.01);
    double lowest = 2;
    for (Vertex v : surface_of(domain, moving.reference()).vertices) lowest = std::min(lowest, moving.reference().position[v].z);
    EXPECT_NEAR(lowest, 0.4, 1e-12);
}

TEST(ThroughFaces, APoolWavesAndKeepsItsVolume) {
    const auto wave = [](const Vec3& x, double t0, double t1) {  // shifted up by what has the mean zero
        const double k = std::numbers::pi, by = 0.1 * (std::sin(6 * t1) - std::sin(6 * t0));
        return x + Vec3{0, 0, by * std::cos(k * x.x) * std::cos(k * x.y)};
    };
    const Domain domain = with(slab(box, {-1, -1, 0}, {1, 1, 0.5}), wave);
    MovingMesh moving(domain, initial_mesh(domain, 1), 0);
    EXPECT_LE(follow(moving, 1, 8), 5.9);
    EXPECT_NEAR(region_volume(moving.reference(), body), 2, 2e-4);
    for (const auto& [a, b] : line_of(surface_of(domain, moving.reference()))) {
        const Vec3& x = moving.reference().position[a];
        EXPECT_TRUE(std::abs(x.x) == 1 || std::abs(x.y) == 1);
    }
}

}  // namespace
}  // namespace kropla
