// Layers from loose prisms. The first prism of each stack stands on the wall; the next is the one whose lower
// triangle is the upper one of the last. Stacks whose walls hang together, on one side, are a layer.

#include <kropla/io/stacks.h>

#include <kropla/base/error.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

Triangle lower(const LoosePrism& p) { return {p.vertices[0], p.vertices[1], p.vertices[2]}; }
Triangle upper(const LoosePrism& p) { return {p.vertices[3], p.vertices[4], p.vertices[5]}; }
[[noreturn]] void fail(const LoosePrism& prism, const std::string& what) {
    throw FileError("cell " + std::to_string(prism.cell) + ", a prism of layer " + std::to_string(prism.layer) +
                    ", " + what);
}

/// The prisms above the first, by their lower triangles.
using Above = std::map<Triangle, const LoosePrism*>;

Above prisms_above(std::span<const LoosePrism> prisms) {
    Above above;
    for (const LoosePrism& p : prisms) {
        if (p.layer == 1) continue;
        const auto [place, is_new] = above.emplace(sorted(lower(p)), &p);
        if (!is_new) fail(p, "stands on the same triangle as cell " + std::to_string(place->second->cell));
    }
    return above;
}

/// Which of the walls' triangles hang together, on one side of them: the number of the first in each group.
std::vector<std::size_t> connected(const std::vector<const LoosePrism*>& wall) {
    std::vector<std::size_t> parent(wall.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i] = parent[parent[i]];
        return i;
    };
    std::map<std::pair<Region, Vertex>, std::size_t> seen;
    for (std::size_t i = 0; i < wall.size(); ++i)
        for (const Vertex v : lower(*wall[i])) {
            const std::size_t other = seen.emplace(std::pair(wall[i]->region, v), i).first->second;
            const std::size_t own = root(i), its = root(other);
            parent[std::max(own, its)] = std::min(own, its);
        }
    for (std::size_t i = 0; i < wall.size(); ++i) parent[i] = root(i);
    return parent;
}

/// A layer as it grows, stack by stack.
struct Building {
    PrismLayer layer;
    std::map<Vertex, int> column_at;  // by the vertex on the wall
};

/// The prism on top of `below`, turned so that its corners stand above those; none at the shell.
const LoosePrism* next_above(const Above& above, const LoosePrism& below, LoosePrism& turned) {
    const auto found = above.find(sorted(upper(below)));
    if (found == above.end()) return nullptr;
    const LoosePrism& next = *found->second;
    if (next.layer != below.layer + 1 || next.region != below.region)
        fail(next, "stands on cell " + std::to_string(below.cell) + ", which is of layer " +
                       std::to_string(below.layer) + " of region " + std::to_string(below.region.value));
    const auto first = static_cast<std::size_t>(std::ranges::find(next.vertices, below.vertices[3]) -
                                                next.vertices.begin());
    turned = next;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = (first + i) % 3;
        turned.vertices[i] = next.vertices[from];
        turned.vertices[i + 3] = next.vertices[from + 3];
    }
    if (lower(turned) != upper(below))
        fail(next, "is turned over against cell " + std::to_string(below.cell) + " below it");
    return found->second;
}

/// The three columns of a stack; returns how many prisms it has.
int climb(const Above& above, const LoosePrism& base, std::array<std::vector<Vertex>, 3>& columns) {
    LoosePrism prism = base;
    for (std::size_t i = 0; i < 3; ++i) columns[i] = {base.vertices[i], base.vertices[i + 3]};
    int count = 1;
    for (LoosePrism turned; next_above(above, prism, turned) != nullptr; prism = turned, ++count)
        for (std::size_t i = 0; i < 3; ++i) columns[i].push_back(turned.vertices[i + 3]);
    return count;
}

void add_stack(Building& building, const Above& above, const LoosePrism& base) {
    std::array<std::vector<Vertex>, 3> columns;
    const int count = climb(above, base, columns);
    PrismLayer& layer = building.layer;
    if (layer.triangles.empty()) layer.count = count;
    if (count != layer.count)
        fail(base, "begins a stack of " + std::to_string(count) + " prisms, where its neighbours have " +
                       std::to_string(layer.count));
    std::array<int, 3> triangle{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [place, is_new] = building.column_at.emplace(columns[i].front(), count_columns(layer));
        triangle[i] = place->second;
        if (is_new) layer.columns.insert(layer.columns.end(), columns[i].begin(), columns[i].end());
        const auto there = layer.columns.begin() + triangle[i] * (count + 1);
        if (!std::equal(columns[i].begin(), columns[i].end(), there))
            fail(base, "begins a column at vertex " + std::to_string(columns[i].front().value) +
                           " that parts from that of its neighbours");
    }
    layer.triangles.push_back(triangle);
}

std::vector<PrismLayer> stack(std::span<const LoosePrism> prisms) {
    const Above above = prisms_above(prisms);
    std::vector<const LoosePrism*> wall;
    for (const LoosePrism& p : prisms)
        if (p.layer == 1) wall.push_back(&p);
    const std::vector<std::size_t> group = connected(wall);
    std::map<std::size_t, Building> buildings;
    for (std::size_t i = 0; i < wall.size(); ++i) {
        Building& building = buildings[group[i]];
        building.layer.region = wall[i]->region;
        add_stack(building, above, *wall[i]);
    }
    std::vector<PrismLayer> layers;
    int stacked = 0;
    for (auto& [first, building] : buildings) {
        stacked += count_prisms(building.layer);
        layers.push_back(std::move(building.layer));
    }
    if (stacked != static_cast<int>(prisms.size()))
        throw FileError("of " + std::to_string(prisms.size()) + " prisms only " + std::to_string(stacked) +
                        " stand in stacks on a wall");
    return layers;
}

/// The triangles of all layers at their ends: k = 0 the walls, else the shells.
using Ends = std::multimap<Triangle, Layer>;

Ends ends_of(const std::vector<PrismLayer>& layers, bool walls) {
    Ends ends;
    for (std::size_t l = 0; l < layers.size(); ++l)
        for (const auto& [a, b, c] : layers[l].triangles) {
            const int k = walls ? 0 : layers[l].count;
            const auto vertex = [&](int column) { return column_vertex(layers[l], column, k); };
            ends.emplace(sorted({vertex(a), vertex(b), vertex(c)}), Layer(l));
        }
    return ends;
}

/// Patches where tets meet layers, and which body each wall belongs to.
void join_to_tets(Mesh& mesh) {
    const Ends walls = ends_of(mesh.layers, true), shells = ends_of(mesh.layers, false);
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = static_cast<std::size_t>(corner);
            if (mesh.neighbour[t][i].exists()) continue;
            const Triangle facet = sorted(facet_vertices(mesh, {t, corner}));
            if (const auto shell = shells.find(facet); shell != shells.end())
                mesh.patch[t][i] = shell_patch(shell->second);
            if (const auto wall = walls.find(facet); wall != walls.end()) {
                mesh.patch[t][i] = wall_patch(wall->second);
                PrismLayer& layer = mesh.layers[static_cast<std::size_t>(wall->second.value)];
                if (layer.region == surroundings) layer.body = mesh.region[t];
            }
        }
    for (const auto& [triangle, l] : walls) {
        const Region region = layer_of(mesh, l).region;
        if (region == surroundings) continue;
        const auto [first, last] = walls.equal_range(triangle);  // both sides of one wall
        for (auto at = first; at != last; ++at) mesh.layers[static_cast<std::size_t>(at->second.value)].body = region;
    }
}

}  // namespace

void attach_layers(Mesh& mesh, std::span<const LoosePrism> prisms) {
    mesh.layers = stack(prisms);
    constexpr std::size_t most = 13;  // whose patches are below 32
    if (mesh.layers.size() > most)
        throw FileError("has " + std::to_string(mesh.layers.size()) + " prism layers, more than " +
                        std::to_string(most));
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        for (const Vertex v : mesh.layers[l].columns)
            if (!mesh.layer_at[v].exists()) mesh.layer_at[v] = Layer(l);
    std::erase_if(mesh.free_vertices, [&](Vertex v) { return alive(mesh, v); });
    join_to_tets(mesh);
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        if (!mesh.layers[l].body.exists() || mesh.layers[l].body == surroundings)
            throw FileError("prism layer " + std::to_string(l) + " stands on no body's surface");
}

}  // namespace kropla
