#pragma once

#include "examples.h"
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace kropla {

/// Which layers, and how they are divided.
struct LayerPlan {
    int outside = 3, inside = 0;  // prisms per column; 0: no layer on that side
    double growth = 1.3;          // [-]
};

/// How far along a column of `count` prisms vertex k stands, 0 on the wall ... 1.
inline double share_of_column(const LayerPlan& plan, int count, int k) {
    if (plan.growth == 1) return static_cast<double>(k) / count;
    return (std::pow(plan.growth, k) - 1) / (std::pow(plan.growth, count) - 1);
}

/// Adds the layers of a mesh made by make_mesh as its layers, and takes their vertices out of the free slots.
inline void add_layers(Mesh& mesh, std::vector<PrismLayer> layers) {
    mesh.layers = std::move(layers);
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        for (const Vertex v : mesh.layers[l].columns)
            if (!mesh.layer_at[v].exists()) mesh.layer_at[v] = Layer(l);
    std::erase_if(mesh.free_vertices, [&](Vertex v) { return alive(mesh, v); });
}

/// The mesh with its region 1 shrunk towards `centre`, a fifth or a tenth each for the layers outside and inside;
/// they fill the gap. In a section, from the surroundings on the left to the body on the right:
///
///     tets | 3 2 1 | 1 2 | tets          the wall in the middle, shells at both ends
///         1.0     0.8   0.7              how far the places are shrunk
inline Mesh layered(const Mesh& mesh, const Vec3& centre, const LayerPlan& plan = {}) {
    const double wall = plan.outside > 0 ? 0.8 : 1.0, shell = plan.inside > 0 ? wall - 0.1 : wall;
    Array<Vertex, Vec3> position = mesh.position;
    Array<Tet, std::array<Vertex, 4>> tets = mesh.tets;
    std::vector<BoundaryFacet> boundary;
    PrismLayer outside{surroundings, Region(1), plan.outside, {}, {}}, inside{Region(1), Region(1), plan.inside, {}, {}};
    std::map<Vertex, int> column_at;       // of vertices on the surface
    std::map<Vertex, Vertex> body_vertex;  // what the body's tets have instead of them
    const auto shrunk = [&](Vertex v, double factor) { return centre + factor * (mesh.position[v] - centre); };
    const auto column_of = [&](Vertex v) {
        const auto [place, is_new] = column_at.emplace(v, static_cast<int>(column_at.size()));
        if (!is_new) return place->second;
        Vertex last = plan.outside > 0 ? position.push_back(shrunk(v, wall)) : v;
        for (int k = 0; plan.outside > 0 && k <= plan.outside; ++k) {
            const double at = wall + (1 - wall) * share_of_column(plan, plan.outside, k);
            outside.columns.push_back(k == 0 ? last : k == plan.outside ? v : position.push_back(shrunk(v, at)));
        }
        for (int k = 0; plan.inside > 0 && k <= plan.inside; ++k) {
            const double at = wall + (shell - wall) * share_of_column(plan, plan.inside, k);
            if (k > 0) last = position.push_back(shrunk(v, at));
            inside.columns.push_back(last);
        }
        body_vertex.emplace(v, last);
        return place->second;
    };
    const Patch outer = plan.outside > 0 ? shell_patch(Layer(0)) : wall_patch(Layer(0));
    const Layer inner_layer(plan.outside > 0 ? 1 : 0);
    const Patch inner = plan.inside > 0 ? shell_patch(inner_layer) : wall_patch(Layer(0));
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            const Tet beyond = mesh.neighbour[t][i];
            const auto facet = facet_vertices(mesh, {t, corner});
            if (!beyond.exists()) boundary.push_back({facet, mesh.patch[t][i]});
            if (mesh.region[t] != Region(1) || !beyond.exists() || mesh.region[beyond] == Region(1)) continue;
            const int a = column_of(facet[0]), b = column_of(facet[1]), c = column_of(facet[2]);
            outside.triangles.push_back({a, b, c});
            inside.triangles.push_back({a, c, b});
            boundary.push_back({facet, outer});
            boundary.push_back(
                {{body_vertex.at(facet[0]), body_vertex.at(facet[1]), body_vertex.at(facet[2])}, inner});
        }
    for (const Tet t : mesh.tets.indices())
        if (mesh.region[t] == Region(1))
            for (Vertex& v : tets[t]) {
                if (const auto on_wall = body_vertex.find(v); on_wall != body_vertex.end()) v = on_wall->second;
                else position[v] = shrunk(v, shell);
            }
    Mesh made = make_mesh(std::move(position), std::move(tets), mesh.region, boundary);
    std::vector<PrismLayer> layers;
    if (plan.outside > 0) layers.push_back(outside);
    if (plan.inside > 0) layers.push_back(inside);
    add_layers(made, std::move(layers));
    return made;
}

/// Patches 0 ... 5 for the faces of a cube [0, edge]^3.
inline void set_face_patches(Mesh& mesh, double edge) {
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto facet = facet_vertices(mesh, {t, corner});
            Patch& patch = mesh.patch[t][static_cast<std::size_t>(corner)];
            for (int face = 0; face < 6 && patch.exists(); ++face) {
                const double plane = face % 2 == 0 ? 0 : edge;
                if (std::ranges::all_of(facet, [&](Vertex v) { return mesh.position[v][face / 2] == plane; }))
                    patch = Patch(face);
            }
        }
}

/// cube_of_tets(n), whose inner cubes are the body, with layers. Heights vary as its vertices stand off the grid.
inline Mesh layered_cube(int n, const LayerPlan& plan = {}) {
    const double edge = 1e-3 * n, middle = edge / 2;
    Mesh cube = cube_of_tets(n);
    set_face_patches(cube, edge);
    return layered(cube, {middle, middle, middle}, plan);
}

/// The volume of all prisms [m^3].
inline double total_prism_volume(const Mesh& mesh) {
    double sum = 0;
    for (const Prism& prism : all_prisms(mesh)) sum += prism_volume(prism_corners(mesh, prism));
    return sum;
}

}  // namespace kropla
