// A flood over the cells that differ, in both meshes at once. Across a facet to a cell that is the same in
// both, the facet is one of the other mesh too: the cell beyond it there differs, or the facet would not be
// where the flood ends.

#include "transfer/changed.h"

#include <kropla/mesh/topology.h>
#include "transfer/slot_map.h"

#include <algorithm>

namespace kropla {
namespace {

bool is_tet_of(const Mesh& mesh, Tet t) {
    return t.exists() && static_cast<std::size_t>(t.value) < mesh.tets.size() && alive(mesh, t);
}
bool is_vertex_of(const Mesh& mesh, Vertex v) {
    return v.exists() && static_cast<std::size_t>(v.value) < mesh.position.size() && alive(mesh, v);
}

class Flood {
public:
    Flood(const Mesh& before, const Mesh& after, std::size_t expected)
        : before_(before), after_(after), seen_(expected) {}

    void look_at(Tet t) {
        if (!t.exists() || seen_.contains(t.value)) return;
        const bool differs = !same_tet(before_, after_, t);
        seen_.insert(t.value, differs ? 1 : 0);
        if (!differs) return;
        queue_.push_back(t);
        if (is_tet_of(before_, t)) found_.gone.push_back(t);
        if (is_tet_of(after_, t)) found_.come.push_back(t);
    }

    ChangedCells spread() {
        for (std::size_t i = 0; i < queue_.size(); ++i) {
            look_beyond(queue_[i], after_, before_);
            look_beyond(queue_[i], before_, after_);
        }
        std::ranges::sort(found_.gone);
        std::ranges::sort(found_.come);
        return std::move(found_);
    }

private:
    void look_beyond(Tet t, const Mesh& mesh, const Mesh& other) {
        if (!is_tet_of(mesh, t)) return;
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n = mesh.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n.exists()) continue;
            look_at(n);
            if (seen_.find(n.value) == 1) continue;
            look_at(other.neighbour[n][static_cast<std::size_t>(mirror_corner(mesh, {t, corner}))]);
        }
    }

    const Mesh& before_;
    const Mesh& after_;
    SlotMap seen_;  // 1: differs, 0: does not
    std::vector<Tet> queue_;
    ChangedCells found_;
};

}  // namespace

bool same_vertex(const Mesh& before, const Mesh& after, Vertex v) {
    return is_vertex_of(before, v) && is_vertex_of(after, v) && before.position[v] == after.position[v];
}

bool same_tet(const Mesh& before, const Mesh& after, Tet t) {
    if (!is_tet_of(before, t) || !is_tet_of(after, t)) return false;
    if (before.tets[t] != after.tets[t] || before.region[t] != after.region[t]) return false;
    return std::ranges::all_of(after.tets[t],
                               [&](Vertex v) { return before.position[v] == after.position[v]; });
}

ChangedCells changed_cells(const Mesh& before, const Mesh& after, std::span<const Tet> cells,
                           std::span<const Vertex> vertices) {
    Flood flood(before, after, 4 * cells.size());
    for (Tet t : cells) flood.look_at(t);
    for (Vertex v : vertices) {
        if (same_vertex(before, after, v)) continue;
        for (const Mesh* mesh : {&before, &after})  // one cell is enough: all of the ball differ
            if (is_vertex_of(*mesh, v)) flood.look_at(mesh->tet_at[v]);
    }
    return flood.spread();
}

}  // namespace kropla
