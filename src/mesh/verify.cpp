#include <kropla/mesh/verify.h>

#include <kropla/base/predicates.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include "mesh/verify_layers.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace kropla {
namespace {

constexpr Patch last_patch{31};  // a Constraint has a bit for each

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
    if (mesh.layer_at.size() != mesh.position.size()) return "layer_at and position differ in size";
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
            if (v[as_size(i)].value < 0 || as_size(v[as_size(i)].value) >= mesh.position.size())
                return "cell " + std::to_string(t.value) + " has vertex " + std::to_string(v[as_size(i)].value) +
                       ", which does not exist";
            for (int j = 0; j < i; ++j)
                if (v[as_size(i)] == v[as_size(j)])
                    return cell(mesh, t) + " has vertex " + std::to_string(v[as_size(i)].value) + " twice";
            if (!is_finite(mesh.position[v[as_size(i)]]))
                return "vertex " + std::to_string(v[as_size(i)].value) + " has no finite place";
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
    const Tet n = mesh.neighbour[t][as_size(i)];
    const bool on_boundary = mesh.patch[t][as_size(i)].exists();
    if (mesh.patch[t][as_size(i)] > last_patch)
        return cell(mesh, t) + ": " + facet(i) + " is of patch " +
               std::to_string(mesh.patch[t][as_size(i)].value) + ", above " + std::to_string(last_patch.value);
    if (!n.exists() && on_boundary) return {};
    if (!n.exists()) return cell(mesh, t) + ": " + facet(i) + " has neither neighbour nor patch";
    if (on_boundary) return cell(mesh, t) + ": " + facet(i) + " has both a neighbour and a patch";
    if (as_size(n.value) >= mesh.tets.size() || !alive(mesh, n))
        return cell(mesh, t) + ": across " + facet(i) + " is no cell";
    int shared = 0, mirror = -1;
    for (int j = 0; j < 4; ++j) {
        if (j != i && corner_of(mesh, n, mesh.tets[t][as_size(j)]) >= 0) ++shared;
        if (mesh.neighbour[n][as_size(j)] == t) mirror = j;
    }
    if (shared != 3 || mirror < 0 || corner_of(mesh, t, mesh.tets[n][as_size(mirror)]) >= 0)
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

/// Two facets with the same vertices that are not the two sides of one: cells that touch without being
/// neighbours, a third cell at a facet, a cell that is there twice.
std::string fault_of_shared_facets(const Mesh& mesh) {
    std::vector<std::pair<std::array<Vertex, 3>, Tet>> facets;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4 && alive(mesh, t); ++i) {
            if (mesh.neighbour[t][as_size(i)] > t) continue;  // once, from the later of its two cells
            auto key = facet_vertices(mesh, {t, i});
            std::ranges::sort(key);
            facets.emplace_back(key, t);
        }
    std::ranges::sort(facets);
    const auto same_key = [](const auto& a, const auto& b) { return a.first == b.first; };
    const auto found = std::ranges::adjacent_find(facets, same_key);
    if (found == facets.end()) return {};
    return cell(mesh, std::next(found)->second) + " and cell " + std::to_string(found->second.value) +
           " share a facet but are not neighbours";
}

std::string fault_of_vertices(const Mesh& mesh) {
    Array<Vertex, int> cells(mesh.position.size(), 0);
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t))
            for (Vertex v : mesh.tets[t]) ++cells[v];
    std::vector<Tet> around;
    for (Vertex v : mesh.position.indices()) {
        const std::string name = "vertex " + std::to_string(v.value);
        if (!mesh.tet_at[v].exists()) {  // a free slot, or within a layer
            if (cells[v] == 0) continue;
            return name + " at " + place(mesh.position[v]) + " has cells but none is recorded";
        }
        if (as_size(mesh.tet_at[v].value) >= mesh.tets.size() || corner_of(mesh, mesh.tet_at[v], v) < 0)
            return name + ": the cell recorded for it does not have it";
        ball(mesh, v, around);
        if (static_cast<int>(around.size()) != cells[v])
            return name + " at " + place(mesh.position[v]) + ": its cells are not in one piece";
    }
    return {};
}

/// Each free slot is listed once, and nothing else is.
template <class I, class T>
std::string fault_of_list(const Mesh& mesh, const std::vector<I>& list, const Array<I, T>& slots,
                          const char* what) {
    Array<I, int> listed(slots.size(), 0);
    for (I i : list) {
        if (i.value < 0 || as_size(i.value) >= slots.size())
            return std::string("a free ") + what + " slot is listed that does not exist";
        ++listed[i];
    }
    for (I i : slots.indices())
        if (listed[i] != (alive(mesh, i) ? 0 : 1))
            return what + (" slot " + std::to_string(i.value)) + " is listed as free " +
                   std::to_string(listed[i]) + " times, but is " + (alive(mesh, i) ? "taken" : "free");
    return {};
}

std::string fault_of_free_slots(const Mesh& mesh) {
    auto fault = fault_of_list(mesh, mesh.free_tets, mesh.tets, "tet");
    return fault.empty() ? fault_of_list(mesh, mesh.free_vertices, mesh.position, "vertex") : fault;
}

/// An edge of the surface of a region, or (no region) of the boundary of the whole.
struct SurfaceEdge {
    Region region;
    Vertex a, b;
    auto operator<=>(const SurfaceEdge&) const = default;
};

void append_edges(std::vector<SurfaceEdge>& edges, Region region, const std::array<Vertex, 3>& facet) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(facet[k], facet[(k + 1) % 3]);
        edges.push_back({region, a, b});
    }
}

/// A surface that is closed and does not touch itself has two facets at each edge.
std::string fault_of_surfaces(const Mesh& mesh) {
    std::vector<SurfaceEdge> edges;
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4 && alive(mesh, t); ++i) {
            const Tet n = mesh.neighbour[t][as_size(i)];
            if (n.exists() && mesh.region[n] == mesh.region[t]) continue;
            append_edges(edges, mesh.region[t], facet_vertices(mesh, {t, i}));
            if (!n.exists()) append_edges(edges, Region{}, facet_vertices(mesh, {t, i}));
        }
    std::ranges::sort(edges);
    for (auto begin = edges.begin(), end = begin; begin != edges.end(); begin = end) {
        end = std::upper_bound(begin, edges.end(), *begin);
        if (end - begin == 2) continue;
        const auto [region, a, b] = *begin;
        const auto whose = region.exists() ? "surface of region " + std::to_string(region.value) : "boundary";
        return "the " + whose + ((end - begin) % 2 == 0 ? " touches itself" : " is not closed") +
               " at edge " + std::to_string(a.value) + "-" + std::to_string(b.value) + " near " +
               place((mesh.position[a] + mesh.position[b]) / 2);
    }
    return {};
}

}  // namespace

std::string verify(const Mesh& mesh) {
    for (const auto check : {fault_of_sizes, fault_of_indices, fault_of_orientation, fault_of_neighbours,
                             fault_of_shared_facets, fault_of_vertices, fault_of_free_slots,
                             fault_of_surfaces, fault_of_layers})
        if (auto fault = check(mesh); !fault.empty()) return fault;
    return {};
}

}  // namespace kropla
