#include "mesh/verify_layers.h"

#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>
#include <vector>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

std::string named(Layer l) { return "layer " + std::to_string(l.value); }

/// A triangle of vertices with its least one first, its turn kept.
Triangle turned(Triangle t) {
    std::rotate(t.begin(), std::ranges::min_element(t), t.end());
    return t;
}

std::string fault_of_stacks(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    if (layer.count < 1) return named(l) + " has no prisms in a column";
    if (!layer.region.exists() || !layer.body.exists()) return named(l) + " is of no region or body";
    if (layer.columns.empty() || layer.columns.size() % as_size(layer.count + 1) != 0)
        return named(l) + " has " + std::to_string(layer.columns.size()) +
               " column vertices, no multiple of " + std::to_string(layer.count + 1);
    std::vector<Vertex> seen = layer.columns;
    std::ranges::sort(seen);
    if (seen.front().value < 0 || as_size(seen.back().value) >= mesh.position.size())
        return named(l) + " has a vertex in a column that does not exist";
    if (const auto twice = std::ranges::adjacent_find(seen); twice != seen.end())
        return named(l) + " has vertex " + std::to_string(twice->value) + " twice in its columns";
    for (Vertex v : seen)
        if (!is_finite(mesh.position[v])) return "vertex " + std::to_string(v.value) + " has no finite place";
    return {};
}

/// The wall is closed: the edges of its triangles come in pairs, one in either direction, and each column is
/// used.
std::string fault_of_wall(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    std::vector<char> used(as_size(count_columns(layer)), 0);
    std::vector<std::pair<int, int>> edges;
    for (const auto& triangle : layer.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle[i] < 0 || triangle[i] >= count_columns(layer))
                return named(l) + " has a triangle on a column that does not exist";
            used[as_size(triangle[i])] = 1;
            edges.emplace_back(triangle[i], triangle[(i + 1) % 3]);
        }
    if (const auto unused = std::ranges::find(used, 0); unused != used.end())
        return named(l) + " has column " + std::to_string(unused - used.begin()) + " in no triangle";
    std::ranges::sort(edges);
    const auto twice = std::ranges::adjacent_find(edges);
    for (const auto& [a, b] : edges)
        if (twice != edges.end() || !std::ranges::binary_search(edges, std::pair(b, a))) {
            const auto [c, d] = twice != edges.end() ? *twice : std::pair(a, b);
            return "the wall of " + named(l) + " is not closed at the edge of columns " + std::to_string(c) +
                   "-" + std::to_string(d);
        }
    return {};
}

std::string fault_of_prisms(const Mesh& mesh) {
    for (const Prism& prism : all_prisms(mesh)) {
        const auto corners = prism_corners(mesh, prism);
        if (scaled_corner_jacobian(corners) > 0) continue;
        char place[96];
        std::snprintf(place, sizeof place, "(%.6g, %.6g, %.6g)", corners[0].x, corners[0].y, corners[0].z);
        return named(prism.layer) + ": prism " + std::to_string(prism.k) + " on triangle " +
               std::to_string(prism.triangle) + " at " + place + " is flat or turned over at a corner";
    }
    return {};
}

/// The facets of the tets' boundary on a patch, their normals out of the tets, and the regions of those tets.
struct PatchFacets {
    std::vector<Triangle> facets;
    std::vector<Region> regions;
};
PatchFacets facets_of_patch(const Mesh& mesh, Patch patch) {
    PatchFacets found;
    for (Tet t : all_tets(mesh))
        for (int i = 0; i < 4; ++i)
            if (mesh.patch[t][as_size(i)] == patch) {
                found.facets.push_back(turned(facet_vertices(mesh, {t, i})));
                found.regions.push_back(mesh.region[t]);
            }
    std::ranges::sort(found.facets);
    return found;
}

/// The wall's (k = 0) or the shell's triangles, as the tets there see them from inside themselves.
std::vector<Triangle> surface_triangles(const PrismLayer& layer, int k) {
    std::vector<Triangle> triangles;
    for (const auto& [a, b, c] : layer.triangles) {
        const Vertex p = column_vertex(layer, a, k), q = column_vertex(layer, b, k),
                     r = column_vertex(layer, c, k);
        triangles.push_back(turned(k == 0 ? Triangle{p, q, r} : Triangle{p, r, q}));
    }
    std::ranges::sort(triangles);
    return triangles;
}

/// Another layer stands on the other side of the wall.
bool wall_is_shared(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    return std::ranges::any_of(mesh.layers, [&](const PrismLayer& other) {
        return other.body == layer.body && other.region != layer.region;
    });
}

/// The tets end where the layer begins: their facets of its two patches are its wall's and its shell's
/// triangles.
std::string fault_of_patches(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    const PatchFacets wall = facets_of_patch(mesh, wall_patch(l)),
                      shell = facets_of_patch(mesh, shell_patch(l));
    if (shell.facets != surface_triangles(layer, layer.count))
        return "the shell of " + named(l) + " is not the tets' boundary of patch " +
               std::to_string(shell_patch(l).value);
    if (wall_is_shared(mesh, l) ? !wall.facets.empty() : wall.facets != surface_triangles(layer, 0))
        return "the wall of " + named(l) + " is not the tets' boundary of patch " +
               std::to_string(wall_patch(l).value);
    const auto is_own = [&](Region r) { return r == layer.region; };
    if (!std::ranges::all_of(shell.regions, is_own) || std::ranges::any_of(wall.regions, is_own))
        return "the tets at the shell of " + named(l) + " are not of its region, or those at its wall are";
    return {};
}

/// The walls of two layers of one body are the same surface seen from both sides.
std::string fault_of_shared_walls(const Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.layers.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            if (mesh.layers[i].body != mesh.layers[j].body) continue;
            auto other = surface_triangles(mesh.layers[j], 0);
            for (Triangle& t : other) t = turned({t[0], t[2], t[1]});
            std::ranges::sort(other);
            if (surface_triangles(mesh.layers[i], 0) != other)
                return named(Layer(i)) + " and " + named(Layer(j)) +
                       " stand on one body, but not on one wall";
        }
    return {};
}

std::string fault_of_layer_at(const Mesh& mesh) {
    Array<Vertex, Layer> right(mesh.position.size());
    for (std::size_t l = mesh.layers.size(); l-- > 0;)
        for (Vertex v : mesh.layers[l].columns) right[v] = Layer(l);
    for (Vertex v : mesh.position.indices())
        if (mesh.layer_at[v] != right[v])
            return "vertex " + std::to_string(v.value) + " has layer " +
                   std::to_string(mesh.layer_at[v].value) + " recorded, but is of " +
                   std::to_string(right[v].value);
    return {};
}

}  // namespace

std::string fault_of_layers(const Mesh& mesh) {
    if (mesh.layers.size() > as_size(most_layers))
        return "there are more than " + std::to_string(most_layers) + " layers";
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        for (const auto check : {fault_of_stacks, fault_of_wall})
            if (auto fault = check(mesh, Layer(l)); !fault.empty()) return fault;
    for (const auto check : {fault_of_layer_at, fault_of_shared_walls, fault_of_prisms})
        if (auto fault = check(mesh); !fault.empty()) return fault;
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        if (auto fault = fault_of_patches(mesh, Layer(l)); !fault.empty()) return fault;
    return {};
}

}  // namespace kropla
