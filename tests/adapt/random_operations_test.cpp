#include <kropla/adapt/adapt.h>
#include "adapt/cases.h"
#include "base/random.h"
#include "mesh/properties.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <bit>
#include <optional>

namespace kropla {
namespace {

constexpr double worst_allowed = 40;  // of collapses and splits, so that there is something to improve

/// An operation at the tet `t` or one of its corners, edges and facets, drawn at random; on something that
/// `held` faces of the box hold (0 inside, 1 within a face, 2 on an edge of the box). Returns whether it was
/// done.
using Operation = bool (*)(Mesh&, Tet t, int held, Random&);

bool take(Mesh& mesh, const std::optional<Cavity>& cavity) {
    if (cavity) replace_cells(mesh, *cavity);
    return cavity.has_value();
}

Edge edge_of(const Mesh& mesh, Tet t, Random& random) {
    const auto& [i, j] = tet_edges[random.below(6)];
    const Vertex a = mesh.tets[t][std::size_t(i)], b = mesh.tets[t][std::size_t(j)];
    return random.below(2) == 0 ? Edge{a, b} : Edge{b, a};
}

bool remove_face(Mesh& mesh, Tet t, int, Random& random) {
    return take(mesh, face_removal(mesh, {t, static_cast<int>(random.below(4))}));
}

bool remove_edge(Mesh& mesh, Tet t, int held, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    const Shell around = shell(mesh, e, t);
    if (std::popcount(constraint(mesh, around).patches) != held) return false;
    return take(mesh, edge_removal(mesh, around, e));
}

bool collapse_edge(Mesh& mesh, Tet t, int held, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    if (std::popcount(constraint(mesh, e.a, ball(mesh, e.a)).patches) != held) return false;
    return take(mesh, edge_collapse(mesh, e.a, e.b, worst_allowed));
}

bool split_edge(Mesh& mesh, Tet t, int held, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    const Shell around = shell(mesh, e, t);
    if (std::popcount(constraint(mesh, around).patches) != held) return false;
    return take(mesh, edge_split(mesh, around, e, worst_allowed));
}

bool remesh_ball(Mesh& mesh, Tet t, int, Random& random) {
    std::vector<Tet> cluster;
    for (Tet n : ball(mesh, mesh.tets[t][random.below(4)]))
        if (mesh.region[n] == mesh.region[t]) cluster.push_back(n);
    const AdaptOptions options{.seed = random.bits()};
    return take(mesh, cluster_remesh(mesh, cluster, snapshot(sphere_in_box(), 0), options));
}

bool smooth(Mesh& mesh, Tet t, int, Random& random) {
    const Vertex v = mesh.tets[t][random.below(4)];
    const bool volumes = random.below(2) == 0;
    return !smooth_guarded(mesh, {&v, 1}, volumes ? LaplaceWeights{0, 1} : LaplaceWeights{1, 0}).empty();
}

bool optimise(Mesh& mesh, Tet t, int, Random& random) {
    return optimise_vertex(mesh, mesh.tets[t][random.below(4)], 3);
}

/// Spoils what the others improve: moves a free vertex, if no tet becomes too bad.
bool displace(Mesh& mesh, Tet t, int, Random& random) {
    const Vertex v = mesh.tets[t][random.below(4)];
    const auto around = ball(mesh, v);
    if (!constraint(mesh, v, around).free()) return false;
    const Vec3 here = mesh.position[v];
    mesh.position[v] += 0.2 * Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    if (worst_aspect_ratio(mesh, around) < worst_allowed) return true;
    mesh.position[v] = here;
    return false;
}

struct Kind {
    const char* name;
    Operation operate;
    int held = 0;
    int done = 0;
};

/// Tries the operation at random tets until it is done somewhere, or `tries` are used up.
bool do_somewhere(Mesh& mesh, const Kind& kind, int tries, Random& random) {
    for (int i = 0; i < tries; ++i) {
        const Tet t(std::size_t(random.below(mesh.tets.size())));
        if (alive(mesh, t) && kind.operate(mesh, t, kind.held, random)) return true;
    }
    return false;
}

TEST(RandomOperations, KeepAMeshWithABodyAMesh) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = improved_mesh(sphere_in_box(), seed);
        const Properties before = properties(mesh);
        Random random{seed};
        Kind kinds[] = {{"face removal", remove_face},
                        {"edge removal", remove_edge},
                        {"edge removal in a face", remove_edge, 1},
                        {"collapse", collapse_edge},
                        {"collapse in a face", collapse_edge, 1},
                        {"collapse on an edge of the box", collapse_edge, 2},
                        {"split", split_edge},
                        {"split in a face", split_edge, 1},
                        {"split on an edge of the box", split_edge, 2},
                        {"remeshing", remesh_ball},
                        {"smoothing", smooth},
                        {"optimisation", optimise},
                        {"displacement", displace},
                        {"displacement", displace},
                        {"displacement", displace}};
        for (int round = 0; round < 60; ++round)
            for (Kind& kind : kinds) {
                const int tries = kind.operate == remesh_ball ? 2 : 500;  // it costs as much as hundreds
                if (!do_somewhere(mesh, kind, tries, random)) continue;
                ++kind.done;
                ASSERT_EQ(verify(mesh), "") << kind.name << ", round " << round;
            }
        EXPECT_TRUE(same_shape(properties(mesh), before));
        for (const Kind& kind : kinds) EXPECT_GE(kind.done, 36) << kind.name;
    }
}

}  // namespace
}  // namespace kropla
