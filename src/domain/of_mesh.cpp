#include <kropla/domain/of_mesh.h>

#include <kropla/base/error.h>
#include "domain/triangle_tree.h"
#include <kropla/domain/words.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <memory>
#include <string>
#include <utility>

namespace kropla {

namespace {

/// Facets of a mesh as triangles by numbers of their own.
struct Facets {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    Array<Vertex, int> number;  // of a vertex, where it has one

    explicit Facets(const Mesh& mesh) : number(mesh.position.size(), -1) {}
    void add(const Mesh& mesh, const std::array<Vertex, 3>& vertices) {
        auto& triangle = triangles.emplace_back();
        for (std::size_t i = 0; i < 3; ++i) {
            int& n = number[vertices[i]];
            if (n < 0) {
                n = static_cast<int>(points.size());
                points.push_back(mesh.position[vertices[i]]);
            }
            triangle[i] = n;
        }
    }
};

/// The layer whose wall or shell the patch is, or none.
Layer layer_at(const Mesh& mesh, Patch patch) {
    const int layer = (patch.value - box_faces) / 2;
    return patch.value >= box_faces && layer < static_cast<int>(mesh.layers.size()) ? Layer(layer) : Layer{};
}

Vec3 middle(const Mesh& mesh, const std::array<Vertex, 3>& v) {
    return (mesh.position[v[0]] + mesh.position[v[1]] + mesh.position[v[2]]) / 3;
}

/// Adds the facet if it bounds the region, its outer side out of it.
void add_facet(const Mesh& mesh, Tet t, int corner, Facets& facets) {
    const Region region = mesh.region[t];
    const auto i = static_cast<std::size_t>(corner);
    const auto vertices = facet_vertices(mesh, {t, corner});
    if (const Tet n = mesh.neighbour[t][i]; n.exists()) {
        if (mesh.region[n] != region) facets.add(mesh, vertices);
        return;
    }
    const Layer layer = layer_at(mesh, mesh.patch[t][i]);
    if (!layer.exists())
        throw DomainError("it reaches the boundary of the mesh at " +
                          place_words(middle(mesh, vertices)) + ": it has no closed surface within it");
    if (layer_of(mesh, layer).region != region) facets.add(mesh, vertices);
}

/// Adds the walls of layers inside the region: their triangles are seen from the shell, so from within.
void add_walls(const Mesh& mesh, Region region, Facets& facets) {
    for (const PrismLayer& layer : mesh.layers)
        if (layer.region == region && layer.body == region)
            for (const auto& [a, b, c] : layer.triangles)
                facets.add(mesh, {column_vertex(layer, a, 0), column_vertex(layer, c, 0), column_vertex(layer, b, 0)});
}

}  // namespace

Shape shape_of_region(const Mesh& mesh, Region region) {
    Facets facets(mesh);
    for (Tet t : all_tets(mesh, region))
        for (int corner = 0; corner < 4; ++corner) add_facet(mesh, t, corner, facets);
    add_walls(mesh, region, facets);
    if (facets.triangles.empty()) throw DomainError("the mesh has no region " + std::to_string(region.value));
    return shape_within(std::move(facets.points), facets.triangles);
}

namespace {

/// Facets of the patches 0 ... 5 lie in the faces of the box, exactly.
void check_planes(const Mesh& mesh, const Box& box) {
    for (Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            const int wall = mesh.patch[t][i].value, axis = wall / 2;
            if (mesh.neighbour[t][i].exists() || wall >= box_faces) continue;
            const double plane = wall % 2 == 0 ? box.min[axis] : box.max[axis];
            for (Vertex v : facet_vertices(mesh, {t, corner}))
                if (mesh.position[v][axis] != plane)
                    throw DomainError("vertex " + std::to_string(v.value) + " at " + place_words(mesh.position[v]) +
                                      " is of patch " + std::to_string(wall) + ", but not in " + wall_name(wall) +
                                      ", at " + metres(plane) + "; patches from 6 on may be anywhere");
        }
}

}  // namespace

Domain domain_of(const Mesh& mesh, const SizeField& size) {
    Domain domain;
    domain.size = size;
    Extent box;
    Facets walls(mesh);
    for (Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            box.take_in(mesh.position[mesh.tets[t][i]]);
            if (mesh.neighbour[t][i].exists()) continue;
            const Patch patch = mesh.patch[t][i];
            if (patch.value >= box_faces && !layer_at(mesh, patch).exists())
                walls.add(mesh, facet_vertices(mesh, {t, corner}));
        }
    domain.box = {box.min, box.max};
    check_planes(mesh, domain.box);
    if (!walls.triangles.empty())
        domain.walls = std::make_shared<const TriangleTree>(std::move(walls.points), std::move(walls.triangles));
    return domain;
}

}  // namespace kropla
