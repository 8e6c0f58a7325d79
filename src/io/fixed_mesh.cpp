#include <kropla/io/fixed_mesh.h>

#include <kropla/base/error.h>
#include <kropla/base/predicates.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <cstdio>
#include <stdexcept>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

/// Whether one is the other, turned about, and not turned over.
bool same_way_round(const Triangle& a, const Triangle& b) {
    const auto first = static_cast<std::size_t>(std::ranges::find(b, a[0]) - b.begin());
    return first < 3 && b[(first + 1) % 3] == a[1] && b[(first + 2) % 3] == a[2];
}

/// The facets of all tets, each as its vertices ascend, in order.
std::vector<Triangle> facets_of(const FileCells& cells) {
    std::vector<Triangle> facets;
    facets.reserve(4 * cells.tets.size());
    for (const auto& tet : cells.tets)
        for (int corner = 0; corner < 4; ++corner) facets.push_back(sorted(facet_vertices(tet, corner)));
    for (const LoosePrism& prism : cells.prisms) {
        const auto& v = prism.vertices;
        facets.push_back(sorted({v[0], v[1], v[2]}));
        facets.push_back(sorted({v[3], v[4], v[5]}));
    }
    std::ranges::sort(facets);
    return facets;
}

}  // namespace

FixedMesh fixed_mesh(const FileCells& cells) {
    FixedMesh fixed;
    Array<Vertex, Vertex> number(cells.position.size());
    Array<Vertex, Vec3> position;
    auto tets = cells.tets;
    for (auto& tet : tets)
        for (Vertex& v : tet) {
            if (!number[v].exists()) {
                number[v] = fixed.in_file.push_back(v);
                position.push_back(without_underflow(cells.position[v]));
            }
            v = number[v];
        }
    try {
        fixed.mesh = make_mesh(std::move(position), std::move(tets), cells.region);
    } catch (const std::invalid_argument& error) {  // the arrays are a file's
        throw FileError(error.what());
    }
    for (const Tet t : fixed.mesh.tets.indices())
        for (std::size_t i = 0; i < 4; ++i)
            if (!fixed.mesh.neighbour[t][i].exists()) fixed.mesh.patch[t][i] = Patch(box_faces);
    return fixed;
}

std::string fault_of_sides(const FixedMesh& fixed) {
    const Mesh& mesh = fixed.mesh;
    std::size_t count = 0;
    std::string first;
    for (const Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (!n.exists() || n < t) continue;
            const auto from = static_cast<int>(std::ranges::find(mesh.neighbour[n], t) - mesh.neighbour[n].begin());
            if (!same_way_round(facet_vertices(mesh, {t, corner}), facet_vertices(mesh, {n, from}))) continue;
            if (++count > 1) continue;
            const Vec3 x = centroid(mesh, t);
            char words[160];
            std::snprintf(words, sizeof words, "cells %d and %d at (%.6g, %.6g, %.6g) lie on one side of the facet between them",
                          t.value, n.value, x.x, x.y, x.z);
            first = words;
        }
    return count < 2 ? first : first + ", and " + std::to_string(count - 1) + " other pairs do";
}

std::size_t put_back(const FixedMesh& fixed, FileCells& cells) {
    const Mesh& mesh = fixed.mesh;
    Array<Vertex, Vertex> name(mesh.position.size());
    for (const Vertex v : mesh.position.indices()) {
        if (!alive(mesh, v)) continue;
        if (as_size(v.value) < fixed.in_file.size()) {
            name[v] = fixed.in_file[v];
            cells.position[name[v]] = mesh.position[v];
        } else {
            name[v] = cells.position.push_back(mesh.position[v]);
        }
    }
    cells.fields.clear();
    cells.vectors.clear();
    cells.tets = {};
    cells.region = {};
    for (const Tet t : all_tets(mesh)) {
        auto tet = mesh.tets[t];
        for (Vertex& v : tet) v = name[v];
        cells.tets.push_back(tet);
        cells.region.push_back(mesh.region[t]);
    }
    const std::vector<Triangle> facets = facets_of(cells);
    const auto is_gone = [&](const PatchFacet& facet) {
        const auto& v = facet.vertices;
        return !v[3].exists() && !std::ranges::binary_search(facets, sorted({v[0], v[1], v[2]}));
    };
    const auto gone = std::erase_if(cells.facets, is_gone);
    (void)drop_unused(cells);
    return gone;
}

}  // namespace kropla
