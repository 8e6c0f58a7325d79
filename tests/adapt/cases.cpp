#include "adapt/cases.h"

#include <kropla/base/predicates.h>
#include "base/random.h"
#include <kropla/generate/generate.h>
#include "mesh/meshes.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace kropla {
namespace {

bool all_positive(const Mesh& mesh, std::span<const Tet> tets) {
    return std::ranges::all_of(tets, [&](Tet t) { return std::isfinite(aspect_ratio(mesh, t)); });
}

}  // namespace

Domain sphere_in_box() {
    Domain domain;
    domain.box = {{-1.5, -1.5, -2}, {1.5, 1.5, 2}};
    domain.size = {0.35, 0.4, 0.8};
    domain.bodies.push_back({"sphere", {{0, 0, 0}, {0.6, 0.6, 0.6}, {}}});
    return domain;
}

Mesh improved_mesh(const Domain& domain, std::uint64_t seed) {
    Mesh mesh = generate_mesh(domain, seed);
    const Snapshot at = snapshot(domain, 0);
    improve(mesh, all_tets(mesh), at);
    repair(mesh, all_tets(mesh), at);
    return compact(mesh).mesh;
}

Mesh random_ball(std::uint64_t seed) {
    Random random{seed};
    for (;;) {
        Mesh mesh = ball_of_vertex();
        for (Vertex v : mesh.position.indices()) {
            mesh.position[v] *= random.uniform(0.3, 3);
            for (int axis = 0; axis < 3; ++axis) mesh.position[v][axis] += random.uniform(-0.3, 0.3);
        }
        if (all_positive(mesh, all_tets(mesh))) return mesh;
    }
}

std::vector<Vertex> spoil(Mesh& mesh, Region region, int count, std::uint64_t seed) {
    Random random{seed};
    std::vector<Vertex> spoilt;
    for (int tries = 0; tries < 10000 && static_cast<int>(spoilt.size()) < count; ++tries) {
        const Vertex v(std::size_t(random.below(mesh.position.size())));
        if (!mesh.tet_at[v].exists()) continue;
        const auto around = ball(mesh, v);
        if (mesh.region[around.front()] != region || !constraint(mesh, v, around).free()) continue;
        const auto [a, b, c] = facet_vertices(mesh, link(mesh, v)[random.below(around.size())]);
        const Vec3 middle = (mesh.position[a] + mesh.position[b] + mesh.position[c]) / 3;
        const Vec3 there = mesh.position[v];
        mesh.position[v] = there + 0.97 * (middle - there);
        if (all_positive(mesh, around)) spoilt.push_back(v);
        else mesh.position[v] = there;
    }
    return spoilt;
}

void rename_patch(Mesh& mesh, Patch from, Patch to) {
    for (auto& patches : mesh.patch) std::ranges::replace(patches, from, to);
}

double worst_of(const Mesh& mesh) { return worst_aspect_ratio(mesh, all_tets(mesh)); }

std::vector<Vertex> all_vertices(const Mesh& mesh) {
    std::vector<Vertex> vertices;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v)) vertices.push_back(v);
    return vertices;
}

bool on_interface(const Mesh& mesh, Vertex v) { return constraint(mesh, v, ball(mesh, v)).on_interface; }

}  // namespace kropla
