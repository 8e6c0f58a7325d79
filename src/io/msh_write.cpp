// Version 4.1 as text: each region is an entity of its own, as is each patch. An element's tag is its place among tets,
// prisms and facets, so that readers can put them back in that order.

#include "io/file.h"
#include <kropla/io/msh.h>
#include "io/msh_elements.h"
#include "io/scanner.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace kropla {
namespace {

/// Numbers and names of one dimension as they are written, where 0 is no number, with the bounds of each.
class Groups {
public:
    Groups(const std::vector<int>& numbers, const Names& names, std::string_view name_of_zero) : names_(names) {
        std::set<int> taken(numbers.begin(), numbers.end());
        for (const auto& [number, name] : names) taken.insert(number);
        if (taken.erase(0) > 0) {
            instead_of_zero_ = taken.empty() ? 1 : *taken.rbegin() + 1;
            const auto zero = names_.extract(0);
            if (!zero.empty()) name_of_zero = zero.mapped();
            if (!name_of_zero.empty()) names_[instead_of_zero_] = name_of_zero;
        }
        for (const int number : numbers) bounds_.emplace(written(number), Bounds{});
    }

    [[nodiscard]] int written(int number) const { return number == 0 ? instead_of_zero_ : number; }
    [[nodiscard]] const Names& names() const { return names_; }
    [[nodiscard]] std::size_t count() const { return bounds_.size(); }
    [[nodiscard]] int first() const { return bounds_.begin()->first; }

    void take_in(int number, const Vec3& x) {
        Bounds& bounds = bounds_.at(written(number));
        for (int axis = 0; axis < 3; ++axis) {
            bounds.min[axis] = std::min(bounds.min[axis], x[axis]);
            bounds.max[axis] = std::max(bounds.max[axis], x[axis]);
        }
    }

    void append_entities(std::string& text) const {
        for (const auto& [number, bounds] : bounds_) {
            text += std::to_string(number) + ' ';
            for (const Vec3& corner : {bounds.min, bounds.max})
                for (int axis = 0; axis < 3; ++axis) {
                    append_number(text, corner[axis]);
                    text += ' ';
                }
            text += "1 " + std::to_string(number) + " 0\n";
        }
    }

private:
    struct Bounds {
        Vec3 min{infinity, infinity, infinity}, max{-infinity, -infinity, -infinity};
    };
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    Names names_;
    std::map<int, Bounds> bounds_;
    int instead_of_zero_ = 0;
};

/// The elements of one type, as text, by group.
using Blocks = std::map<std::pair<int, int>, std::pair<std::size_t, std::string>>;  // group, type: count, lines

void add_element(Blocks& blocks, int group, int type, std::size_t tag, std::span<const Vertex> vertices) {
    auto& [count, text] = blocks[{group, type}];
    ++count;
    append_number(text, tag);
    for (const Vertex v : vertices) {
        text += ' ';
        append_number(text, as_size(v.value) + 1);
    }
    text += '\n';
}

void append_names(std::string& text, const Names& regions, const Names& patches) {
    if (regions.empty() && patches.empty()) return;
    text += "$PhysicalNames\n" + std::to_string(regions.size() + patches.size()) + '\n';
    for (const auto& [dimension, names] : {std::pair(2, &patches), std::pair(3, &regions)})
        for (const auto& [number, name] : *names) {
            std::string plain = name;
            std::ranges::replace(plain, '"', '\'');
            text += std::to_string(dimension) + ' ' + std::to_string(number) + " \"" + plain + "\"\n";
        }
    text += "$EndPhysicalNames\n";
}

void append_nodes(std::string& text, const FileCells& cells, int volume) {
    const std::string count = std::to_string(cells.position.size());
    text += "$Nodes\n1 " + count + " 1 " + count + "\n3 " + std::to_string(volume) + " 0 " + count + '\n';
    for (std::size_t tag = 1; tag <= cells.position.size(); ++tag) {
        append_number(text, tag);
        text += '\n';
    }
    for (const Vec3& x : cells.position)
        for (int axis = 0; axis < 3; ++axis) {
            append_number(text, x[axis]);
            text += axis < 2 ? ' ' : '\n';
        }
    text += "$EndNodes\n";
}

void append_blocks(std::string& text, const Blocks& blocks, int dimension) {
    for (const auto& [of, lines] : blocks)
        text += std::to_string(dimension) + ' ' + std::to_string(of.first) + ' ' + std::to_string(of.second) + ' ' +
                std::to_string(lines.first) + '\n' + lines.second;
}

void append_elements(std::string& text, const FileCells& cells, Groups& regions, Groups& patches) {
    Blocks facets, volumes;
    std::size_t tag = 0;
    for (const Tet t : cells.tets.indices())
        add_element(volumes, regions.written(cells.region[t].value), msh_tet, ++tag, cells.tets[t]);
    for (const LoosePrism& prism : cells.prisms)
        add_element(volumes, regions.written(prism.region.value), msh_prism, ++tag, prism.vertices);
    for (const PatchFacet& facet : cells.facets) {
        const bool quad = facet.vertices[3].exists();
        add_element(facets, patches.written(facet.patch), quad ? msh_quad : msh_triangle, ++tag,
                    std::span(facet.vertices).first(quad ? 4 : 3));
    }
    text += "$Elements\n" + std::to_string(facets.size() + volumes.size()) + ' ' + std::to_string(tag) + " 1 " +
            std::to_string(tag) + '\n';
    append_blocks(text, facets, 2);
    append_blocks(text, volumes, 3);
    text += "$EndElements\n";
}

void find_bounds(const FileCells& cells, Groups& regions, Groups& patches) {
    for (const Tet t : cells.tets.indices())
        for (const Vertex v : cells.tets[t]) regions.take_in(cells.region[t].value, cells.position[v]);
    for (const LoosePrism& prism : cells.prisms)
        for (const Vertex v : prism.vertices) regions.take_in(prism.region.value, cells.position[v]);
    for (const PatchFacet& facet : cells.facets)
        for (const Vertex v : facet.vertices)
            if (v.exists()) patches.take_in(facet.patch, cells.position[v]);
}

}  // namespace

void write_msh(const std::filesystem::path& path, const FileCells& cells, const Watch* watch) {
    Groups regions(region_numbers(cells), cells.region_names, msh_surroundings);
    Groups patches(patch_numbers(cells), cells.patch_names, {});
    find_bounds(cells, regions, patches);
    std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    append_names(text, regions.names(), patches.names());
    text += "$Entities\n0 0 " + std::to_string(patches.count()) + ' ' + std::to_string(regions.count()) + '\n';
    patches.append_entities(text);
    regions.append_entities(text);
    text += "$EndEntities\n";
    heed(watch);
    append_nodes(text, cells, regions.first());
    heed(watch);
    append_elements(text, cells, regions, patches);
    write_file(path, text, watch);
}

}  // namespace kropla
