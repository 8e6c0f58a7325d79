#include <kropla/mesh/mesh.h>

#include <kropla/mesh/topology.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>

namespace kropla {
namespace {

/// A facet as it is looked up: its vertices in ascending order, and where it was seen.
struct FacetRecord {
    std::array<Vertex, 3> key;
    Tet tet;     // none: a facet of the boundary, as given
    int corner;  // of the tet; or the position in the list of boundary facets
};

/// The facets of all tets and the given boundary facets, grouped by their smallest vertex: a counting sort,
/// as the groups are small.
struct FacetGroups {
    std::vector<FacetRecord> records;
    std::vector<std::size_t> first;  // per vertex, and one more
};

FacetGroups group_facets(const Mesh& mesh, std::span<const BoundaryFacet> boundary) {
    std::vector<FacetRecord> all;
    all.reserve(4 * mesh.tets.size() + boundary.size());
    for (Tet t : mesh.tets.indices())
        for (int i = 0; i < 4; ++i) all.push_back({sorted(facet_vertices(mesh.tets[t], i)), t, i});
    for (std::size_t i = 0; i < boundary.size(); ++i)
        all.push_back({sorted(boundary[i].vertices), Tet{}, static_cast<int>(i)});

    FacetGroups groups;
    groups.first.assign(mesh.position.size() + 1, 0);
    for (const auto& r : all) ++groups.first[as_size(r.key[0].value) + 1];
    std::partial_sum(groups.first.begin(), groups.first.end(), groups.first.begin());
    auto next = groups.first;
    groups.records.resize(all.size());
    for (const auto& r : all) groups.records[next[as_size(r.key[0].value)]++] = r;
    return groups;
}

void check_vertices(const Mesh& mesh, std::span<const BoundaryFacet> boundary) {
    const auto vertices = static_cast<std::int32_t>(mesh.position.size());
    const auto check = [&](Vertex v, const char* what, auto number) {
        if (v.value < 0 || v.value >= vertices)
            throw std::invalid_argument(what + std::to_string(number) + " has vertex " + std::to_string(v.value) +
                            ", but there are " + std::to_string(vertices) + " vertices");
    };
    for (Tet t : mesh.tets.indices())
        for (Vertex v : mesh.tets[t]) check(v, "cell ", t.value);
    for (std::size_t i = 0; i < boundary.size(); ++i)
        for (Vertex v : boundary[i].vertices) check(v, "boundary facet ", i);
}

/// Joins the records of one facet: two tets become neighbours, a boundary facet gives its patch.
void join(Mesh& mesh, std::span<const FacetRecord> same, std::span<const BoundaryFacet> boundary) {
    std::array<const FacetRecord*, 2> cells{};
    std::size_t count = 0;
    Patch patch{0};
    for (const auto& r : same) {
        if (!r.tet.exists()) {
            patch = boundary[as_size(r.corner)].patch;
            continue;
        }
        if (count == 2)
            throw std::invalid_argument("a facet of cell " + std::to_string(r.tet.value) + " already belongs to cells " +
                            std::to_string(cells[0]->tet.value) + " and " +
                            std::to_string(cells[1]->tet.value));
        cells[count++] = &r;
    }
    if (count == 2) {
        mesh.neighbour[cells[0]->tet][as_size(cells[0]->corner)] = cells[1]->tet;
        mesh.neighbour[cells[1]->tet][as_size(cells[1]->corner)] = cells[0]->tet;
    } else if (count == 1) {
        mesh.patch[cells[0]->tet][as_size(cells[0]->corner)] = patch;
    }
}

void find_neighbours(Mesh& mesh, std::span<const BoundaryFacet> boundary) {
    auto groups = group_facets(mesh, boundary);
    for (Vertex v : mesh.position.indices()) {
        const auto i = as_size(v.value);
        const std::span group(groups.records.data() + groups.first[i], groups.first[i + 1] - groups.first[i]);
        std::ranges::stable_sort(group, {}, &FacetRecord::key);
        for (std::size_t begin = 0, end = 0; begin < group.size(); begin = end) {
            while (end < group.size() && group[end].key == group[begin].key) ++end;
            join(mesh, group.subspan(begin, end - begin), boundary);
        }
    }
}

}  // namespace

Mesh make_mesh(Array<Vertex, Vec3> position, Array<Tet, std::array<Vertex, 4>> tets,
               Array<Tet, Region> region, std::span<const BoundaryFacet> boundary) {
    Mesh mesh;
    mesh.position = std::move(position);
    mesh.tets = std::move(tets);
    mesh.region = std::move(region);
    check_vertices(mesh, boundary);
    mesh.neighbour.resize(mesh.tets.size());
    mesh.patch.resize(mesh.tets.size());
    mesh.tet_at.resize(mesh.position.size());
    mesh.layer_at.resize(mesh.position.size());
    find_neighbours(mesh, boundary);
    for (Tet t : mesh.tets.indices())
        for (Vertex v : mesh.tets[t]) mesh.tet_at[v] = t;
    for (Vertex v : mesh.position.indices())
        if (!alive(mesh, v)) mesh.free_vertices.push_back(v);
    return mesh;
}

Compacted compact(const Mesh& mesh) {
    Array<Vertex, Vertex> vertices;
    Array<Tet, Tet> tets;
    for (Vertex v : mesh.position.indices())
        if (alive(mesh, v)) vertices.push_back(v);
    for (Tet t : mesh.tets.indices())
        if (alive(mesh, t)) tets.push_back(t);
    return reorder(mesh, std::move(vertices), std::move(tets));
}

Compacted reorder(const Mesh& mesh, Array<Vertex, Vertex> old_vertex, Array<Tet, Tet> old_tet) {
    Compacted result{{}, std::move(old_vertex), std::move(old_tet)};
    Array<Vertex, Vertex> new_vertex(mesh.position.size());
    Array<Tet, Tet> new_tet(mesh.tets.size());
    for (Vertex v : result.old_vertex.indices()) {
        new_vertex[result.old_vertex[v]] = v;
        result.mesh.position.push_back(mesh.position[result.old_vertex[v]]);
    }
    for (Tet t : result.old_tet.indices()) new_tet[result.old_tet[t]] = t;

    for (Tet t : result.old_tet) {
        auto vertices = mesh.tets[t];
        auto neighbours = mesh.neighbour[t];
        for (auto& v : vertices) v = new_vertex[v];
        for (auto& n : neighbours)
            if (n.exists()) n = new_tet[n];
        result.mesh.tets.push_back(vertices);
        result.mesh.neighbour.push_back(neighbours);
        result.mesh.patch.push_back(mesh.patch[t]);
        result.mesh.region.push_back(mesh.region[t]);
    }
    for (Vertex v : result.old_vertex) {
        const Tet t = mesh.tet_at[v];
        result.mesh.tet_at.push_back(t.exists() ? new_tet[t] : Tet{});
        result.mesh.layer_at.push_back(mesh.layer_at[v]);
    }
    result.mesh.layers = mesh.layers;
    for (PrismLayer& layer : result.mesh.layers)
        for (Vertex& v : layer.columns) v = new_vertex[v];
    return result;
}

namespace {

bool has_slot(const Mesh& mesh, Tet t) { return as_size(t.value) < mesh.tets.size(); }
bool has_slot(const Mesh& mesh, Vertex v) { return as_size(v.value) < mesh.position.size(); }

void copy_vertex(Mesh& to, const Mesh& from, Vertex v) {
    if (!has_slot(from, v)) return;
    to.position[v] = from.position[v];
    to.tet_at[v] = from.tet_at[v];
    to.layer_at[v] = from.layer_at[v];
}

void copy_tet(Mesh& to, const Mesh& from, Tet t) {
    to.tets[t] = from.tets[t];
    to.neighbour[t] = from.neighbour[t];
    to.patch[t] = from.patch[t];
    to.region[t] = from.region[t];
}

/// Layers are the same in all meshes of a run: this is a look, and no copy.
void copy_layers(Mesh& to, const Mesh& from) {
    if (to.layers == from.layers) return;
    const auto copy_columns = [&](const std::vector<PrismLayer>& layers) {
        for (const PrismLayer& layer : layers)
            for (Vertex v : layer.columns) copy_vertex(to, from, v);
    };
    copy_columns(from.layers);
    copy_columns(to.layers);
    to.layers = from.layers;
}

}  // namespace

void copy_changed(Mesh& to, const Mesh& from, std::span<const Tet> tets, std::span<const Vertex> vertices) {
    for (Tet t : tets)  // vertices that may have lost their last cell
        if (has_slot(to, t) && alive(to, t))
            for (Vertex v : to.tets[t]) copy_vertex(to, from, v);
    to.position.resize(from.position.size());
    to.tet_at.resize(from.tet_at.size());
    to.layer_at.resize(from.layer_at.size());
    to.tets.resize(from.tets.size());
    to.neighbour.resize(from.tets.size());
    to.patch.resize(from.tets.size());
    to.region.resize(from.tets.size());
    for (Tet t : tets) {
        if (!has_slot(from, t)) continue;
        copy_tet(to, from, t);
        if (!alive(from, t)) continue;
        for (Vertex v : from.tets[t]) copy_vertex(to, from, v);
        for (Tet n : from.neighbour[t])
            if (n.exists()) to.neighbour[n] = from.neighbour[n];
    }
    for (Vertex v : vertices)
        if (has_slot(from, v)) to.position[v] = from.position[v];
    copy_layers(to, from);
    to.free_tets = from.free_tets;
    to.free_vertices = from.free_vertices;
}

}  // namespace kropla
