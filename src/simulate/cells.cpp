// Tets and prisms of a region, and where it ends.
#include "simulate/cells.h"

#include <kropla/mesh/cells.h>

#include <algorithm>

namespace kropla {
namespace {

/// The layer beyond a facet of this patch, or none.
Layer layer_beyond(const Mesh& mesh, Patch patch) {
    if (patch.value < box_faces) return {};
    const auto layer = static_cast<std::size_t>(patch.value - box_faces) / 2;
    return layer < mesh.layers.size() ? Layer(layer) : Layer{};
}

/// The region across the facet opposite `corner`, or none.
Region region_beyond(const Mesh& mesh, Tet t, std::size_t corner) {
    if (const Tet other = mesh.neighbour[t][corner]; other.exists()) return mesh.region[other];
    const Layer layer = layer_beyond(mesh, mesh.patch[t][corner]);
    return layer.exists() ? layer_of(mesh, layer).region : Region{};
}

std::array<Vertex, 3> facet_of(const Mesh& mesh, Tet t, std::size_t corner) {
    std::array<Vertex, 3> facet;
    for (std::size_t k = 0; k < 3; ++k)
        facet[k] = mesh.tets[t][static_cast<std::size_t>(tet_facets[corner][k])];
    return facet;
}

/// A layer stands on its body's surface, where its region ends; beyond its shell the region goes on.
void add_walls(const Mesh& mesh, Region region, std::vector<std::array<Vertex, 3>>& facets) {
    for (const PrismLayer& layer : mesh.layers) {
        if (layer.region != region) continue;
        for (const auto& [a, b, c] : layer.triangles)
            facets.push_back(
                {column_vertex(layer, a, 0), column_vertex(layer, c, 0), column_vertex(layer, b, 0)});
    }
}

}  // namespace

Cells living_cells(const Mesh& mesh, Region only) {
    const auto wanted = [only](Region region) { return !only.exists() || region == only; };
    Cells cells;
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t) && wanted(mesh.region[t])) cells.tets.push_back(t);
    for (const Prism& prism : all_prisms(mesh))
        if (wanted(cell_region(mesh, prism))) cells.prisms.push_back(prism);
    return cells;
}

Pieces pieces_of(const Mesh& mesh, const Cells& cells) {
    Array<Vertex, Vertex> towards(mesh.position.size());  // of each vertex one of its piece with a lower number, or itself
    const auto first_of = [&](Vertex v) {
        if (!towards[v].exists()) towards[v] = v;
        while (towards[v] != v) v = towards[v] = towards[towards[v]];
        return v;
    };
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        Vertex first = first_of(vertices[0]);
        for (Vertex v : vertices) {
            const Vertex other = first_of(v);
            if (other == first) continue;
            towards[std::max(first, other)] = std::min(first, other);
            first = std::min(first, other);
        }
    });
    Pieces pieces{Array<Vertex, int>(mesh.position.size(), -1)};
    for (Vertex v : towards.indices())
        if (towards[v].exists()) pieces.of[v] = towards[v] == v ? pieces.count++ : pieces.of[first_of(v)];
    return pieces;
}

std::size_t count_regions(const Mesh& mesh) {
    Region last;
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t)) last = std::max(last, mesh.region[t]);
    for (const PrismLayer& layer : mesh.layers) last = std::max(last, layer.region);
    return static_cast<std::size_t>(last.value + 1);
}

FaceFacets facets_of_faces(const Mesh& mesh, const Cells& cells) {
    FaceFacets facets;
    for (Tet t : cells.tets) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Patch patch = mesh.patch[t][corner];
            if (!patch.exists() || mesh.neighbour[t][corner].exists()) continue;
            if (const auto face = static_cast<std::size_t>(patch.value); face < facets.size())
                facets[face].push_back(facet_of(mesh, t, corner));
        }
    }
    return facets;
}

std::vector<std::array<Vertex, 3>> facets_of_fixed_walls(const Mesh& mesh, const Cells& cells) {
    std::vector<std::array<Vertex, 3>> facets;
    for (Tet t : cells.tets)
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Patch patch = mesh.patch[t][corner];
            if (mesh.neighbour[t][corner].exists() || patch.value < box_faces || layer_beyond(mesh, patch).exists()) continue;
            facets.push_back(facet_of(mesh, t, corner));
        }
    return facets;
}

RegionSurface region_surface(const Mesh& mesh, Region region) {
    RegionSurface surface;
    for (Tet t : living_cells(mesh, region).tets) {
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Region beyond = region_beyond(mesh, t, corner);
            if (beyond == region) continue;
            (beyond.exists() ? surface.interface : surface.outer).push_back(facet_of(mesh, t, corner));
        }
    }
    add_walls(mesh, region, surface.interface);
    return surface;
}

std::vector<RegionSurface> region_surfaces(const Mesh& mesh, std::size_t regions) {
    std::vector<RegionSurface> surfaces(regions);
    for (Tet t : living_cells(mesh).tets) {
        const Region region = mesh.region[t];
        if (as_size(region.value) >= regions) continue;
        RegionSurface& surface = surfaces[as_size(region.value)];
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const Region beyond = region_beyond(mesh, t, corner);
            if (beyond == region) continue;
            (beyond.exists() ? surface.interface : surface.outer).push_back(facet_of(mesh, t, corner));
        }
    }
    for (std::size_t region = 0; region < regions; ++region) add_walls(mesh, Region(region), surfaces[region].interface);
    return surfaces;
}

std::vector<Vertex> vertices_of(const Mesh& mesh, const Cells& cells) {
    Array<Vertex, char> seen(mesh.position.size(), 0);
    for_each_cell(cells, [&](const auto& cell) {
        for (Vertex v : cell_vertices(mesh, cell)) seen[v] = 1;
    });
    std::vector<Vertex> vertices;
    for (Vertex v : mesh.position.indices()) {
        if (seen[v]) vertices.push_back(v);
    }
    return vertices;
}

}  // namespace kropla
