#include "base/random.h"
#include "mesh/meshes.h"
#include "mesh/properties.h"
#include "mesh/proposals.h"
#include "mesh/quality.h"
#include "mesh/verify.h"

#include <gtest/gtest.h>

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

TEST(RandomOperations, KeepTheMeshAMesh) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Mesh mesh = cube_in_cube(3);
        const Properties before = properties(mesh);
        Random random{seed};
        Kind kinds[] = {{"insertion", try_insertion, true},   {"facet removal", try_facet_removal},
                        {"edge removal", try_edge_removal},   {"wall swap", try_wall_swap},
                        {"edge split", try_edge_split, true}, {"edge collapse", try_edge_collapse}};
        for (int done = 0; done < 1500;) {
            const Tet t(std::size_t(random.below(mesh.tets.size())));
            const bool may_grow = count_tets(mesh) < 250;  // a mesh that stays small is soon verified
            Kind& kind = kinds[random.below(6)];
            if (!alive(mesh, t) || (kind.adds_a_vertex && !may_grow)) continue;
            const auto cavity = kind.propose(mesh, t, random);
            if (!cavity || !all_positive(mesh, *cavity)) continue;
            replace_cells(mesh, *cavity);
            ++kind.done;
            ++done;
            ASSERT_EQ(verify(mesh), "") << kind.name << ", operation " << done;
        }
        EXPECT_TRUE(same_shape(properties(mesh), before));
        for (const Kind& kind : kinds) EXPECT_GE(kind.done, 20) << kind.name;
    }
}

}  // namespace
}  // namespace kropla
