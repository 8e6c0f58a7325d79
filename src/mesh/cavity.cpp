#include <kropla/mesh/cavity.h>

#include <kropla/mesh/topology.h>

#include <algorithm>
#include <stdexcept>

namespace kropla {
namespace {

/// A facet of a removed or of an added tet, in two words, as many are sorted: its vertices in ascending order;
/// whether its tet is added; which of the removed or added ones that is; its corner.
struct Side {
    std::uint64_t first, second;

    Side(const std::array<Vertex, 3>& vertices, bool added, std::size_t tet, int at_corner)
        : first(word(vertices[0].value) << 32 | word(vertices[1].value)),
          second(word(vertices[2].value) << 32 | word(added) << 31 | word(tet) << 2 | word(at_corner)) {}
    [[nodiscard]] int corner() const { return static_cast<int>(second & 3); }
    [[nodiscard]] std::size_t which() const { return second >> 2 & (most_tets - 1); }
    [[nodiscard]] bool is_added() const { return (second >> 31 & 1) != 0; }
    [[nodiscard]] bool is_same_facet(const Side& b) const { return first == b.first && second >> 32 == b.second >> 32; }
    auto operator<=>(const Side&) const = default;

    static constexpr std::size_t most_tets = std::size_t{1} << 29;

private:
    static std::uint64_t word(auto part) { return static_cast<std::uint64_t>(part); }
};

/// A facet of an added tet and what lies across it.
struct Join {
    std::size_t added;
    int corner;
    Tet neighbour;
    int neighbour_corner;  // whose neighbour is the added tet; -1: not to be told (it is an added tet too)
    Patch patch;
};

std::array<Vertex, 3> ascending(const std::array<Vertex, 4>& v, int corner) {
    auto key = facet_vertices(v, corner);
    if (key[1] < key[0]) std::swap(key[0], key[1]);
    if (key[2] < key[1]) std::swap(key[1], key[2]);
    if (key[1] < key[0]) std::swap(key[0], key[1]);
    return key;
}

/// The number of a vertex that is inserted, by its name in the proposal.
std::size_t number_inserted(Vertex name) { return as_size(inserted_vertex(0).value - name.value); }

/// The removed tets in ascending order. Throws if the proposal names what does not exist.
std::vector<Tet> checked_cells(const Mesh& mesh, const Cavity& cavity) {
    auto removed = cavity.removed;
    std::ranges::sort(removed);
    const bool twice = std::ranges::adjacent_find(removed) != removed.end();
    if (twice || !std::ranges::all_of(removed, [&](Tet t) { return alive(mesh, t); }))
        throw std::logic_error("replace_cells: a cell is removed that does not exist, or twice");
    const auto exists = [&](Vertex v) {
        if (!v.exists()) return v != Vertex{} && number_inserted(v) < cavity.inserted.size();
        return as_size(v.value) < mesh.position.size() && alive(mesh, v);
    };
    for (const NewTet& tet : cavity.added)
        if (!std::ranges::all_of(tet.vertices, exists))
            throw std::logic_error("replace_cells: an added cell has a vertex that does not exist");
    return removed;
}

/// Of the removed tets only the facets around the cavity; those inside it may come and go.
std::vector<Side> sides_by_key(const Mesh& mesh, const Cavity& cavity, std::span<const Tet> removed) {
    std::vector<Side> sides;
    sides.reserve(4 * (cavity.removed.size() + cavity.added.size()));
    for (int corner = 0; corner < 4; ++corner) {
        for (std::size_t i = 0; i < cavity.removed.size(); ++i)
            if (!std::ranges::binary_search(removed, mesh.neighbour[cavity.removed[i]][as_size(corner)]))
                sides.emplace_back(ascending(mesh.tets[cavity.removed[i]], corner), false, i, corner);
        for (std::size_t i = 0; i < cavity.added.size(); ++i)
            sides.emplace_back(ascending(cavity.added[i].vertices, corner), true, i, corner);
    }
    std::ranges::sort(sides);
    return sides;
}

/// The slots that the added tets will take: those of removed tets, then free ones, then new ones.
std::vector<Tet> cell_slots(const Mesh& mesh, const Cavity& cavity) {
    std::vector<Tet> names;
    names.reserve(cavity.added.size());
    const std::size_t spare = mesh.free_tets.size();
    for (std::size_t i = 0; i < cavity.added.size(); ++i) {
        const std::size_t beyond = i - std::min(i, cavity.removed.size());
        if (i < cavity.removed.size()) names.push_back(cavity.removed[i]);
        else if (beyond < spare) names.push_back(mesh.free_tets[spare - 1 - beyond]);
        else names.push_back(Tet(mesh.tets.size() + beyond - spare));
    }
    return names;
}

/// Joins the sides of one facet. Before, the facet was around the cavity (one removed side), or inside it or not
/// there (none); after, it is inside (two added sides), around it (one) or gone (none).
void join_facet(const Mesh& mesh, const Cavity& cavity, std::span<const Side> before,
                std::span<const Side> after, std::span<const Tet> names, std::vector<Join>& joins) {
    if (before.size() > 1 || after.size() > 2 || (before.size() == 1 && after.size() == 2))
        throw std::logic_error("replace_cells: a facet of the cavity is used too often");
    const auto outer = [&](const Side& s) { return Facet{cavity.removed[s.which()], s.corner()}; };
    if (after.size() == 2) {
        joins.push_back({after[0].which(), after[0].corner(), names[after[1].which()], -1, Patch{}});
        joins.push_back({after[1].which(), after[1].corner(), names[after[0].which()], -1, Patch{}});
    } else if (after.size() == 1 && before.size() == 1) {
        const Facet f = outer(before[0]);
        const Tet n = mesh.neighbour[f.tet][as_size(f.corner)];
        joins.push_back({after[0].which(), after[0].corner(), n, n.exists() ? mirror_corner(mesh, f) : -1,
                         mesh.patch[f.tet][as_size(f.corner)]});
    } else if (after.size() == 1) {
        const Patch patch = cavity.added[after[0].which()].patch[as_size(after[0].corner())];
        if (!patch.exists())
            throw std::logic_error("replace_cells: an added facet has no other side and no patch");
        joins.push_back({after[0].which(), after[0].corner(), Tet{}, -1, patch});
    } else if (before.size() == 1) {
        const Facet f = outer(before[0]);
        if (mesh.neighbour[f.tet][as_size(f.corner)].exists())
            throw std::logic_error("replace_cells: a facet around the cavity would be lost");
    }
}

std::vector<Join> join_facets(const Mesh& mesh, const Cavity& cavity, std::span<const Tet> removed,
                              std::span<const Tet> names) {
    const auto sides = sides_by_key(mesh, cavity, removed);
    std::vector<Join> joins;
    joins.reserve(4 * cavity.added.size());
    for (auto begin = sides.begin(); begin != sides.end();) {
        auto added = begin, end = begin;
        while (end != sides.end() && begin->is_same_facet(*end)) {
            if (!end->is_added()) added = end + 1;
            ++end;
        }
        join_facet(mesh, cavity, {begin, added}, {added, end}, names, joins);
        begin = end;
    }
    return joins;
}

/// The slots that the inserted vertices will take: free ones, the last first, then new ones.
std::vector<Vertex> vertex_slots(const Mesh& mesh, std::size_t count) {
    std::vector<Vertex> names;
    const std::size_t spare = mesh.free_vertices.size();
    for (std::size_t k = 0; k < count; ++k)
        names.push_back(k < spare ? mesh.free_vertices[spare - 1 - k] : Vertex(mesh.position.size() + k - spare));
    return names;
}

/// The proposal with the names that its vertices will have in the mesh.
Cavity with_names(Cavity cavity, std::span<const Vertex> names) {
    for (NewTet& tet : cavity.added)
        for (Vertex& v : tet.vertices)
            if (!v.exists()) v = names[number_inserted(v)];
    return cavity;
}

void insert_vertices(Mesh& mesh, const std::vector<Vec3>& places) {
    for (const Vec3& place : places) {
        if (mesh.free_vertices.empty()) {
            mesh.position.push_back(place);
            mesh.tet_at.push_back(Tet{});
            mesh.layer_at.push_back(Layer{});
        } else {
            mesh.position[mesh.free_vertices.back()] = place;
            mesh.free_vertices.pop_back();
        }
    }
}

void clear_removed(Mesh& mesh, const Cavity& cavity, std::vector<Vertex>& touched) {
    for (Tet t : cavity.removed)
        for (Vertex v : mesh.tets[t]) {
            mesh.tet_at[v] = Tet{};
            touched.push_back(v);
        }
    for (Tet t : cavity.removed) {
        mesh.tets[t] = {};
        mesh.neighbour[t] = {};
        mesh.patch[t] = {};
    }
}

void write_added(Mesh& mesh, const Cavity& cavity, std::span<const Tet> names) {
    const std::size_t reused = std::min(cavity.added.size(), cavity.removed.size());
    const std::size_t taken = std::min(cavity.added.size() - reused, mesh.free_tets.size());
    mesh.free_tets.resize(mesh.free_tets.size() - taken);
    const std::size_t size = mesh.tets.size() + cavity.added.size() - reused - taken;
    mesh.tets.resize(size);
    mesh.neighbour.resize(size);
    mesh.patch.resize(size);
    mesh.region.resize(size);
    for (std::size_t i = 0; i < names.size(); ++i) {
        mesh.tets[names[i]] = cavity.added[i].vertices;
        mesh.region[names[i]] = cavity.added[i].region;
        for (Vertex v : cavity.added[i].vertices) mesh.tet_at[v] = names[i];
    }
    mesh.free_tets.insert(mesh.free_tets.end(), cavity.removed.begin() + static_cast<std::ptrdiff_t>(reused),
                          cavity.removed.end());
}

void free_lost_vertices(Mesh& mesh, std::vector<Vertex>& touched) {
    std::erase_if(touched, [&](Vertex v) { return alive(mesh, v); });
    std::ranges::sort(touched);
    const auto repeated = std::unique(touched.begin(), touched.end());
    mesh.free_vertices.insert(mesh.free_vertices.end(), touched.begin(), repeated);
}

}  // namespace

Replacement replace_cells(Mesh& mesh, const Cavity& proposal) {
    const auto removed = checked_cells(mesh, proposal);
    Replacement made{cell_slots(mesh, proposal), vertex_slots(mesh, proposal.inserted.size())};
    const auto& names = made.cells;
    const Cavity renamed = made.vertices.empty() ? Cavity{} : with_names(proposal, made.vertices);
    const Cavity& cavity = made.vertices.empty() ? proposal : renamed;
    const auto joins = join_facets(mesh, cavity, removed, names);

    std::vector<Vertex> touched = made.vertices;
    clear_removed(mesh, cavity, touched);
    insert_vertices(mesh, cavity.inserted);
    write_added(mesh, cavity, names);
    for (const Join& j : joins) {
        mesh.neighbour[names[j.added]][as_size(j.corner)] = j.neighbour;
        mesh.patch[names[j.added]][as_size(j.corner)] = j.patch;
        if (j.neighbour_corner >= 0) mesh.neighbour[j.neighbour][as_size(j.neighbour_corner)] = names[j.added];
    }
    free_lost_vertices(mesh, touched);
    return made;
}

}  // namespace kropla
