#include "base/random.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include "mesh/proposals.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/verify.h>

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace kropla {
namespace {

/// A proposal, if the operation is legal at the tet `t` or one of its corners, edges and facets, drawn at
/// random.
using Operation = std::optional<Cavity> (*)(const Mesh&, Tet t, Random&);

Edge edge_of(const Mesh& mesh, Tet t, Random& random) {
    const auto& [i, j] = tet_edges[random.below(6)];
    const auto& v = mesh.tets[t];
    return {v[std::size_t(i)], v[std::size_t(j)]};
}

std::optional<Cavity> try_insertion(const Mesh& mesh, Tet t, Random&) {
    return insertion(mesh, t, centroid(mesh, t));
}

std::optional<Cavity> try_facet_removal(const Mesh& mesh, Tet t, Random& random) {
    const Facet f{t, static_cast<int>(random.below(4))};
    const Tet n = mesh.neighbour[t][std::size_t(f.corner)];
    if (!n.exists() || mesh.region[n] != mesh.region[t]) return std::nullopt;
    return facet_removal(mesh, f);
}

std::optional<Cavity> try_edge_removal(const Mesh& mesh, Tet t, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    const Shell s = shell(mesh, e, t);
    if (!s.closed || s.tets.size() != 3 || constraint(mesh, s).on_interface) return std::nullopt;
    return edge_removal(mesh, e);
}

std::optional<Cavity> try_wall_swap(const Mesh& mesh, Tet t, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    const Shell s = shell(mesh, e, t);
    const unsigned patches = constraint(mesh, s).patches;
    if (s.closed || s.tets.size() != 2 || (patches & (patches - 1)) != 0) return std::nullopt;
    return wall_swap(mesh, e);
}

std::optional<Cavity> try_edge_split(const Mesh& mesh, Tet t, Random& random) {
    return edge_split(mesh, edge_of(mesh, t, random));
}

/// The vertex that goes is held by nothing that does not hold the edge too.
std::optional<Cavity> try_edge_collapse(const Mesh& mesh, Tet t, Random& random) {
    const Edge e = edge_of(mesh, t, random);
    const auto of_vertex = constraint(mesh, e.a, ball(mesh, e.a));
    const auto of_edge = constraint(mesh, shell(mesh, e, t));
    if (of_vertex.on_interface || of_vertex != of_edge) return std::nullopt;
    return edge_collapse(mesh, e);
}

struct Kind {
    const char* name;
    Operation propose;
    bool adds_a_vertex = false;
    int done = 0;
};

std::vector<Kind> all_kinds() {
    return {{"insertion", try_insertion, true},   {"facet removal", try_facet_removal},
            {"edge removal", try_edge_removal},   {"wall swap", try_wall_swap},
            {"edge split", try_edge_split, true}, {"edge collapse", try_edge_collapse}};
}

/// Tries a random kind of operation at a random tet; a mesh that stays small is soon verified.
std::optional<Cavity> try_somewhere(const Mesh& mesh, Kind& kind, Random& random) {
    const Tet t(std::size_t(random.below(mesh.tets.size())));
    const bool may_grow = count_tets(mesh) < 250;
    if (!alive(mesh, t) || (kind.adds_a_vertex && !may_grow)) return std::nullopt;
    auto cavity = kind.propose(mesh, t, random);
    if (!cavity || !all_positive(mesh, *cavity)) return std::nullopt;
    return cavity;
}

TEST(RandomOperations, KeepTheMeshAMesh) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = cube_in_cube(3);
        const Properties before = properties(mesh);
        Random random{seed};
        auto kinds = all_kinds();
        for (int done = 0; done < 1500;) {
            Kind& kind = kinds[random.below(6)];
            const auto cavity = try_somewhere(mesh, kind, random);
            if (!cavity) continue;
            replace_cells(mesh, *cavity);
            ++kind.done;
            ++done;
            ASSERT_EQ(verify(mesh), "") << kind.name << ", operation " << done;
        }
        EXPECT_TRUE(same_shape(properties(mesh), before));
        for (const Kind& kind : kinds) EXPECT_GE(kind.done, 86) << kind.name;
    }
}

/// What a follower of the mesh is to be told.
struct Changed {
    std::vector<Tet> tets;
    std::vector<Vertex> vertices;
};

/// Carries out up to `count` random operations, each followed by a small move of a vertex of the new tets.
Changed change_at_random(Mesh& mesh, int count, Random& random) {
    Changed changed;
    auto kinds = all_kinds();
    for (int done = 0; done < count;) {
        const auto cavity = try_somewhere(mesh, kinds[random.below(6)], random);
        if (!cavity) continue;
        const auto [added, inserted] = replace_cells(mesh, *cavity);
        changed.vertices.insert(changed.vertices.end(), inserted.begin(), inserted.end());
        changed.tets.insert(changed.tets.end(), added.begin(), added.end());
        changed.tets.insert(changed.tets.end(), cavity->removed.begin(), cavity->removed.end());
        const Vertex v = mesh.tets[added.front()][random.below(4)];
        const Vec3 here = mesh.position[v];
        if (constraint(mesh, v, ball(mesh, v)).free()) mesh.position[v].x += random.uniform(-0.01, 0.01);
        if (std::isfinite(worst_aspect_ratio(mesh, ball(mesh, v)))) changed.vertices.push_back(v);
        else mesh.position[v] = here;
        ++done;
    }
    return changed;
}

TEST(RandomOperations, AreFollowedByCopyChanged) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random{seed};
        Mesh reference = cube_in_cube(3), current = reference;
        for (int round = 0; round < 40; ++round) {
            const Changed changed = change_at_random(current, 1 + static_cast<int>(random.below(20)), random);
            ASSERT_EQ(verify(current), "");
            ASSERT_NE(current, reference);
            const bool refused = random.below(2) == 0;
            if (refused) copy_changed(current, reference, changed.tets, changed.vertices);
            else copy_changed(reference, current, changed.tets, changed.vertices);
            ASSERT_EQ(current, reference) << "round " << round << (refused ? ", taken back" : ", taken over");
        }
    }
}

}  // namespace
}  // namespace kropla
