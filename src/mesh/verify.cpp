#include "mesh/verify.h"

#include "base/predicates.h"
#include "mesh/quality.h"
#include "mesh/topology.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>

namespace kropla {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::string place(const Vec3& x) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", x.x, x.y, x.z);
    return text;
}

std::string cell(const Mesh& mesh, Tet t) {
    return "cell " + std::to_string(t.value) + " at " + place(centroid(mesh, t));
}

std::string facet(int corner) { return "its facet opposite corner " + std::to_string(corner); }

std::string fault_of_sizes(const Mesh& mesh) {
    if (mesh.tet_at.size() != mesh.position.size()) return "tet_at and position differ in size";
    const std::size_t n = mesh.tets.size();
    if (mesh.neighbour.size() != n || mesh.patch.size() != n || mesh.region.size() != n)
        return "the arrays of cells differ in size";
    return {};
}

std::string fault_of_indices(const Mesh& mesh) {
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        const auto& v = mesh.tets[t];
        for (int i = 0; i < 4; ++i) {
            if (v[at(i)].value < 0 || at(v[at(i)].value) >= mesh.position.size())
                return "cell " + std::to_string(t.value) + " has vertex " + std::to_string(v[at(i)].value) +
                       ", which does not exist";
            for (int j = 0; j < i; ++j)
                if (v[at(i)] == v[at(j)])
                    return cell(mesh, t) + " has vertex " + std::to_string(v[at(i)].value) + " twice";
            if (!is_finite(mesh.position[v[at(i)]]))
                return "vertex " + std::to_string(v[at(i)].value) + " has no finite place";
        }
        if (!mesh.region[t].exists()) return cell(mesh, t) + " is of no region";
    }
    return {};
}

std::string fault_of_orientation(const Mesh& mesh) {
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t)) continue;
        const auto& v = mesh.tets[t];
        const int sign =
            orient3d(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]);
        if (sign < 0) return cell(mesh, t) + " is turned inside out";
        if (sign == 0) return cell(mesh, t) + " is flat";
    }
    return {};
}

std::string fault_of_facet(const Mesh& mesh, Tet t, int i) {
    const Tet n = mesh.neighbour[t][at(i)];
    const bool on_boundary = mesh.patch[t][at(i)].exists();
    if (!n.exists()) return on_boundary ? "" : cell(mesh, t) + ": " + facet(i) + " has neither neighbour nor patch";
    if (on_boundary) return cell(mesh, t) + ": " + facet(i) + " has a neighbour and a patch";
    if (at(n.value) >= mesh.tets.size() || !alive(mesh, n))
        return cell(mesh, t) + ": across " + facet(i) + " is no cell";
    int shared = 0, mirror = -1;
    for (int j = 0; j < 4; ++j) {
        if (j != i && corner_of(mesh, n, mesh.tets[t][at(j)]) >= 0) ++shared;
        if (mesh.neighbour[n][at(j)] == t) mirror = j;
    }
    if (shared != 3 || mirror < 0 || corner_of(mesh, t, mesh.tets[n][at(mirror)]) >= 0)
        return cell(mesh, t) + ": its neighbour cell " + std::to_string(n.value) + " across " + facet(i) +
               " does not share that facet";
    return {};
}

std::string fault_of_neighbours(const Mesh& mesh) {
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4 && alive(mesh, t); ++i)
            if (auto fault = fault_of_facet(mesh, t, i); !fault.empty()) return fault;
    return {};
}

/// Two boundary facets with the same vertices: cells that touch without being neighbours.
std::string fault_of_boundary_facets(const Mesh& mesh) {
    std::map<std::array<Vertex, 3>, Tet> seen;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4 && alive(mesh, t); ++i) {
            if (mesh.neighbour[t][at(i)].exists()) continue;
            auto key = facet_vertices(mesh, {t, i});
            std::ranges::sort(key);
            if (const auto [other, is_new] = seen.emplace(key, t); !is_new)
                return cell(mesh, t) + " and cell " + std::to_string(other->second.value) +
                       " share a facet but are not neighbours";
        }
    return {};
}

std::string fault_of_vertices(const Mesh& mesh) {
    Array<Vertex, int> cells(mesh.position.size(), 0);
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t))
            for (Vertex v : mesh.tets[t]) ++cells[v];
    std::vector<Tet> around;
    for (Vertex v : mesh.position.indices()) {
        const std::string name = "vertex " + std::to_string(v.value);
        if (!alive(mesh, v)) {
            if (cells[v] > 0) return name + " at " + place(mesh.position[v]) + " has cells but none is recorded";
            continue;
        }
        if (at(mesh.tet_at[v].value) >= mesh.tets.size() || corner_of(mesh, mesh.tet_at[v], v) < 0)
            return name + ": the cell recorded for it does not have it";
        ball(mesh, v, around);
        if (static_cast<int>(around.size()) != cells[v])
            return name + " at " + place(mesh.position[v]) + ": its cells are not in one piece";
    }
    return {};
}

std::string fault_of_free_slots(const Mesh& mesh) {
    Array<Tet, int> listed_tets(mesh.tets.size(), 0);
    Array<Vertex, int> listed_vertices(mesh.position.size(), 0);
    for (Tet t : mesh.free_tets) ++listed_tets[t];
    for (Vertex v : mesh.free_vertices) ++listed_vertices[v];
    for (Tet t : mesh.tets.indices())
        if (listed_tets[t] != (alive(mesh, t) ? 0 : 1)) return "tet slot " + std::to_string(t.value) + " is listed wrongly";
    for (Vertex v : mesh.position.indices())
        if (listed_vertices[v] != (alive(mesh, v) ? 0 : 1))
            return "vertex slot " + std::to_string(v.value) + " is listed wrongly";
    return {};
}

/// The surface of a region is closed if each of its edges has an even number of its facets: two where it is a
/// manifold, four where it touches itself along an edge.
std::string fault_of_region_surfaces(const Mesh& mesh) {
    struct Key {
        Region region;
        Vertex a, b;
        auto operator<=>(const Key&) const = default;
    };
    std::map<Key, int> facets_at;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4 && alive(mesh, t); ++i) {
            const Tet n = mesh.neighbour[t][at(i)];
            if (n.exists() && mesh.region[n] == mesh.region[t]) continue;
            const auto v = facet_vertices(mesh, {t, i});
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(v[k], v[(k + 1) % 3]);
                ++facets_at[{mesh.region[t], a, b}];
            }
        }
    for (const auto& [key, count] : facets_at) {
        const std::string where = "the surface of region " + std::to_string(key.region.value) + " at edge " +
                                  std::to_string(key.a.value) + "-" + std::to_string(key.b.value) + " near " +
                                  place((mesh.position[key.a] + mesh.position[key.b]) / 2);
        if (count % 2 != 0) return where + " is not closed";
        if (count > 2) return where + " touches itself";
    }
    return {};
}

}  // namespace

std::string verify(const Mesh& mesh) {
    for (const auto check : {fault_of_sizes, fault_of_indices, fault_of_orientation, fault_of_neighbours,
                             fault_of_boundary_facets, fault_of_vertices, fault_of_free_slots,
                             fault_of_region_surfaces})
        if (auto fault = check(mesh); !fault.empty()) return fault;
    return {};
}

}  // namespace kropla
