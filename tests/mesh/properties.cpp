#include "mesh/properties.h"

#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <set>

namespace kropla {
namespace {

bool before(const BoundaryFacet& a, const BoundaryFacet& b) {
    return a.vertices != b.vertices ? a.vertices < b.vertices : a.patch < b.patch;
}

int euler_characteristic(const Mesh& mesh) {
    std::set<std::array<Vertex, 2>> edges;
    std::set<std::array<Vertex, 3>> facets;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        auto v = mesh.tets[t];
        std::ranges::sort(v);
        for (const auto& [i, j] : tet_edges) edges.insert({v[std::size_t(i)], v[std::size_t(j)]});
        for (std::size_t i = 0; i < 4; ++i)
            facets.insert({v[i == 0 ? 1 : 0], v[i <= 1 ? 2 : 1], v[i <= 2 ? 3 : 2]});
    }
    return count_vertices(mesh) - int(edges.size()) + int(facets.size()) - count_tets(mesh);
}

}  // namespace

Properties properties(const Mesh& mesh) {
    Properties p;
    p.euler_characteristic = euler_characteristic(mesh);
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        p.volume[mesh.region[t]] += volume(mesh, t);
        for (int i = 0; i < 4; ++i) {
            const Patch patch = mesh.patch[t][std::size_t(i)];
            if (!patch.exists()) continue;
            auto v = facet_vertices(mesh, {t, i});
            const Vec3 a = mesh.position[v[0]], b = mesh.position[v[1]], c = mesh.position[v[2]];
            p.area[patch] += cross(b - a, c - a) / 2;
            std::ranges::sort(v);
            p.boundary.push_back({v, patch});
        }
    }
    std::ranges::sort(p.boundary, before);
    return p;
}

bool same_shape(const Properties& a, const Properties& b) {
    double whole = 0;
    for (const auto& [region, volume] : a.volume) whole += volume;
    const double length = std::cbrt(whole);
    const auto same_volume = [&](const auto& x, const auto& y) {
        return x.first == y.first && std::abs(x.second - y.second) <= 1e-12 * whole;
    };
    const auto same_area = [&](const auto& x, const auto& y) {
        return x.first == y.first && norm(x.second - y.second) <= 1e-12 * length * length;
    };
    return a.euler_characteristic == b.euler_characteristic &&
           std::ranges::equal(a.volume, b.volume, same_volume) &&
           std::ranges::equal(a.area, b.area, same_area);
}

bool same(const Properties& a, const Properties& b) {
    const auto same_facet = [](const BoundaryFacet& x, const BoundaryFacet& y) {
        return x.vertices == y.vertices && x.patch == y.patch;
    };
    return same_shape(a, b) && std::ranges::equal(a.boundary, b.boundary, same_facet);
}

}  // namespace kropla
