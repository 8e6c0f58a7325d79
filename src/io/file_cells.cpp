#include <kropla/io/file_cells.h>

#include <kropla/base/predicates.h>
#include <kropla/mesh/cells.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

namespace kropla {
namespace {

/// Calls `f` for each vertex of each cell and facet.
template <class F>
void for_each_vertex(FileCells& cells, F f) {
    for (auto& tet : cells.tets) std::ranges::for_each(tet, f);
    for (LoosePrism& prism : cells.prisms) std::ranges::for_each(prism.vertices, f);
    for (PatchFacet& facet : cells.facets)
        for (Vertex& v : facet.vertices)
            if (v.exists()) f(v);
}

/// Has the first of all vertices at a place take the part of the others; returns how many these are.
std::size_t unite(FileCells& cells) {
    std::vector<Vertex> order;
    for (const Vertex v : cells.position.indices()) order.push_back(v);
    std::ranges::sort(order, {}, [&](Vertex v) {
        const Vec3& x = cells.position[v];
        return std::tuple(x.x, x.y, x.z, v);
    });
    Array<Vertex, Vertex> first(cells.position.size());
    std::size_t united = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Vertex v = order[i];
        const bool again = i > 0 && cells.position[order[i - 1]] == cells.position[v];
        first[v] = again ? first[order[i - 1]] : v;
        if (again) ++united;
    }
    if (united > 0) for_each_vertex(cells, [&](Vertex& v) { v = first[v]; });
    return united;
}

template <class Field>
void keep_values(std::vector<Field>& fields, const Array<Vertex, Vertex>& old_vertex) {
    for (Field& field : fields) {
        auto values = field.values;
        values.resize(old_vertex.size());
        for (const Vertex v : old_vertex.indices()) values[v] = field.values[old_vertex[v]];
        field.values = std::move(values);
    }
}

std::size_t turn_round(FileCells& cells) {
    std::size_t turned = 0;
    const auto place = [&](Vertex v) { return cells.position[v]; };
    for (auto& t : cells.tets) {
        if (orient3d(place(t[0]), place(t[1]), place(t[2]), place(t[3])) >= 0) continue;
        std::swap(t[2], t[3]);
        ++turned;
    }
    for (LoosePrism& prism : cells.prisms) {
        auto& v = prism.vertices;
        std::array<Vec3, 6> corners;
        std::ranges::transform(v, corners.begin(), place);
        if (prism_volume(corners) >= 0) continue;
        std::swap(v[1], v[2]);
        std::swap(v[4], v[5]);
        ++turned;
    }
    return turned;
}

/// A facet as it is looked up, its vertices ascending, and as it is.
struct SeenFacet {
    std::array<Vertex, 4> key, vertices;
};

SeenFacet seen(std::array<Vertex, 4> vertices) {
    SeenFacet facet = {vertices, vertices};
    std::ranges::sort(facet.key);
    return facet;
}

std::vector<SeenFacet> all_facets(const FileCells& cells) {
    constexpr std::array<std::array<std::size_t, 4>, 3> quads = {{{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
    std::vector<SeenFacet> facets;
    facets.reserve(4 * cells.tets.size() + 5 * cells.prisms.size());
    for (const auto& tet : cells.tets)
        for (const auto& [a, b, c] : tet_facets)
            facets.push_back(seen({tet[as_size(a)], tet[as_size(b)], tet[as_size(c)], Vertex{}}));
    for (const LoosePrism& prism : cells.prisms) {
        const auto& v = prism.vertices;
        facets.push_back(seen({v[0], v[2], v[1], Vertex{}}));
        facets.push_back(seen({v[3], v[4], v[5], Vertex{}}));
        for (const auto& [a, b, c, d] : quads) facets.push_back(seen({v[a], v[b], v[c], v[d]}));
    }
    return facets;
}

}  // namespace

std::size_t drop_unused(FileCells& cells) {
    Array<Vertex, char> used(cells.position.size(), 0);
    for (const auto& tet : cells.tets)
        for (const Vertex v : tet) used[v] = 1;
    for (const LoosePrism& prism : cells.prisms)
        for (const Vertex v : prism.vertices) used[v] = 1;
    const auto count = static_cast<std::size_t>(std::count(used.begin(), used.end(), char{0}));
    if (count == 0) return 0;
    const auto hangs = [&](const PatchFacet& facet) {
        return std::ranges::any_of(facet.vertices, [&](Vertex v) { return v.exists() && used[v] == 0; });
    };
    cells.passed_over += std::erase_if(cells.facets, hangs);  // of a surface that bounds no cell
    Array<Vertex, Vertex> old_vertex, new_vertex(used.size());
    Array<Vertex, Vec3> position;
    for (const Vertex v : used.indices()) {
        if (used[v] == 0) continue;
        new_vertex[v] = old_vertex.push_back(v);
        position.push_back(cells.position[v]);
    }
    cells.position = std::move(position);
    for_each_vertex(cells, [&](Vertex& v) { v = new_vertex[v]; });
    keep_values(cells.fields, old_vertex);
    keep_values(cells.vectors, old_vertex);
    return count;
}

Tidied tidy(FileCells& cells) {
    Tidied done;
    done.united = unite(cells);
    done.unused = drop_unused(cells) - done.united;
    done.turned = turn_round(cells);
    return done;
}

std::vector<PatchFacet> boundary_of(const FileCells& cells, int patch) {
    const std::vector<SeenFacet> facets = all_facets(cells);
    std::vector<std::size_t> order(facets.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(facets[i].key, i); });
    std::vector<bool> single(facets.size(), true);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (facets[order[i]].key == facets[order[i - 1]].key) single[order[i]] = single[order[i - 1]] = false;
    std::vector<PatchFacet> boundary;
    for (std::size_t i = 0; i < facets.size(); ++i)
        if (single[i]) boundary.push_back({facets[i].vertices, patch});
    return boundary;
}

bool add_boundary(FileCells& cells) {
    if (!cells.facets.empty()) return false;
    constexpr int number = 1;
    cells.facets = boundary_of(cells, number);
    cells.patch_names = {{number, "boundary"}};
    return true;
}

FileCells cells_of(const Mesh& mesh, Names region_names, Names patch_names) {
    const Mesh compacted = compact(mesh).mesh;
    FileCells cells;
    cells.position = compacted.position;
    cells.tets = compacted.tets;
    cells.region = compacted.region;
    cells.region_names = std::move(region_names);
    cells.patch_names = std::move(patch_names);
    const auto tets = static_cast<int>(compacted.tets.size());
    for (const Prism& prism : all_prisms(compacted))
        cells.prisms.push_back({tets + static_cast<int>(cells.prisms.size()), prism_vertices(compacted, prism),
                                layer_of(compacted, prism.layer).region, prism.k + 1});
    const int layer_patches = box_faces + 2 * static_cast<int>(compacted.layers.size());
    for (const Tet t : compacted.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            const int patch = compacted.patch[t][i].value;
            if (compacted.neighbour[t][i].exists() || (patch >= box_faces && patch < layer_patches)) continue;
            const auto [a, b, c] = facet_vertices(compacted, {t, corner});
            cells.facets.push_back({{a, b, c, Vertex{}}, patch + 1});
        }
    return cells;
}

std::vector<int> region_numbers(const FileCells& cells) {
    std::set<int> numbers;
    for (const Region region : cells.region) numbers.insert(region.value);
    for (const LoosePrism& prism : cells.prisms) numbers.insert(prism.region.value);
    return {numbers.begin(), numbers.end()};
}

std::vector<int> patch_numbers(const FileCells& cells) {
    std::set<int> numbers;
    for (const PatchFacet& facet : cells.facets) numbers.insert(facet.patch);
    return {numbers.begin(), numbers.end()};
}

}  // namespace kropla
