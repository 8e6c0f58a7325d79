// Files other than ours do not say where a layer begins: a stack of prisms begins where the triangle of one is also that
// of a cell of another region, and goes on across triangles as long as the region stays the same.

#include <kropla/io/file_cells.h>

#include <kropla/base/error.h>
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <map>

namespace kropla {
namespace {

using Triangle = std::array<Vertex, 3>;

Triangle end_of(const LoosePrism& prism, bool upper) {
    const auto& v = prism.vertices;
    Triangle end = upper ? Triangle{v[3], v[4], v[5]} : Triangle{v[0], v[1], v[2]};
    std::ranges::sort(end);
    return end;
}

/// The prisms at a triangle, and whether cells of two regions meet there.
struct AtTriangle {
    std::vector<LoosePrism*> prisms;
    bool is_wall = false;
};
using Ends = std::map<Triangle, AtTriangle>;

Ends ends_of(FileCells& cells) {
    Ends ends;
    for (LoosePrism& prism : cells.prisms)
        for (const bool upper : {false, true}) {
            AtTriangle& at = ends[end_of(prism, upper)];
            at.is_wall = at.is_wall || (!at.prisms.empty() && at.prisms.front()->region != prism.region);
            at.prisms.push_back(&prism);
        }
    for (const Tet t : cells.tets.indices())
        for (const auto& [a, b, c] : tet_facets) {
            const auto& v = cells.tets[t];
            Triangle facet = {v[as_size(a)], v[as_size(b)], v[as_size(c)]};
            std::ranges::sort(facet);
            const auto found = ends.find(facet);
            if (found != ends.end() && found->second.prisms.front()->region != cells.region[t])
                found->second.is_wall = true;
        }
    return ends;
}

/// Has the prism's first triangle be this one; what is inside stays inside.
void stand_on(LoosePrism& prism, const Triangle& wall) {
    if (end_of(prism, false) == wall) return;
    const auto v = prism.vertices;
    prism.vertices = {v[3], v[5], v[4], v[0], v[2], v[1]};
}

void number_stack(const Ends& ends, LoosePrism& first, Triangle at) {
    LoosePrism* next = &first;
    for (int layer = 1; next != nullptr; ++layer) {
        LoosePrism& prism = *next;
        stand_on(prism, at);
        prism.layer = layer;
        at = end_of(prism, true);
        next = nullptr;
        for (LoosePrism* beyond : ends.at(at).prisms)
            if (beyond->layer == 0 && beyond->region == prism.region) next = beyond;
    }
}

}  // namespace

void number_layers(FileCells& cells) {
    const auto is_unknown = [](const LoosePrism& prism) { return prism.layer == 0; };
    if (std::ranges::none_of(cells.prisms, is_unknown)) return;
    for (LoosePrism& prism : cells.prisms) prism.layer = 0;
    const Ends ends = ends_of(cells);
    for (const auto& [triangle, at] : ends)
        for (LoosePrism* prism : at.prisms)
            if (at.is_wall && is_unknown(*prism)) number_stack(ends, *prism, triangle);
    const auto left = std::ranges::find_if(cells.prisms, is_unknown);
    if (left != cells.prisms.end())
        throw FileError("cell " + std::to_string(left->cell) + ", a prism, is in no stack that stands where two regions meet");
}

}  // namespace kropla
