// Unknowns along the Morton curve: interleave the bits of the three coordinates and sort.
//   [Morton 1966] A computer oriented geodetic data base and a new technique in file sequencing. IBM.
#include "simulate/partition.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <sstream>

namespace kropla {
namespace {

struct Frame {
    Vec3 min;
    double steps_per_metre;
};

constexpr std::uint64_t curve_steps = (1u << 21) - 1;  // 21 bits per axis fill 63

Frame frame_of(const Mesh& mesh, const std::vector<Vertex>& vertices) {
    if (vertices.empty()) return {{}, 0};
    Vec3 min = mesh.position[vertices.front()], max = min;
    for (Vertex v : vertices) {
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = std::min(min[axis], mesh.position[v][axis]);
            max[axis] = std::max(max[axis], mesh.position[v][axis]);
        }
    }
    const double size = std::max({max.x - min.x, max.y - min.y, max.z - min.z});
    return {min, size > 0 ? static_cast<double>(curve_steps) / size : 0};
}

/// The 21 low bits of `a`, two zeros after each.
std::uint64_t spread_bits(std::uint64_t a) {
    a = (a | a << 32) & 0x001F00000000FFFFULL;
    a = (a | a << 16) & 0x001F0000FF0000FFULL;
    a = (a | a << 8) & 0x100F00F00F00F00FULL;
    a = (a | a << 4) & 0x10C30C30C30C30C3ULL;
    return (a | a << 2) & 0x1249249249249249ULL;
}

std::uint64_t morton_key(const Frame& frame, const Vec3& x) {
    std::uint64_t key = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto step = static_cast<std::uint64_t>((x[axis] - frame.min[axis]) * frame.steps_per_metre);
        key |= spread_bits(std::min(step, curve_steps)) << axis;
    }
    return key;
}

}  // namespace

UpperSides upper_sides(const Mesh& mesh, const Cells& cells) {
    UpperSides lowest(mesh.position.size()), highest(mesh.position.size());
    const auto for_each_corner = [&](const auto& visit) {
        for_each_cell(cells, [&](const auto& cell) {
            for (Vertex v : cell_vertices(mesh, cell)) visit(v, cell_region(mesh, cell));
        });
    };
    for_each_corner([&](Vertex v, Region r) {
        if (!lowest[v].exists() || r < lowest[v]) lowest[v] = r;
        if (!highest[v].exists() || highest[v] < r) highest[v] = r;
    });
    for_each_corner([&](Vertex v, Region r) {
        if (r == lowest[v] || r == highest[v]) return;
        const Vec3& x = mesh.position[v];
        std::ostringstream message;
        message << "three regions meet at (" << x.x << ", " << x.y << ", " << x.z << ") m: two can";
        throw CaseError(message.str());
    });
    bool meet = false;
    for (Vertex v : highest.indices()) {
        if (highest[v] == lowest[v]) highest[v] = {};
        else meet = true;
    }
    return meet ? highest : UpperSides{};
}

Numbering number_vertices(const Mesh& mesh, const Cells& cells, int ranks, UpperSides upper) {
    Numbering numbering{Array<Vertex, int>(mesh.position.size(), -1), {}, {}, std::move(upper)};
    const std::vector<Vertex> vertices = vertices_of(mesh, cells);
    const Frame frame = frame_of(mesh, vertices);
    std::vector<std::pair<std::uint64_t, Vertex>> order;
    order.reserve(vertices.size());
    for (Vertex v : vertices) order.emplace_back(morton_key(frame, mesh.position[v]), v);
    std::sort(order.begin(), order.end());
    numbering.vertex.reserve(vertices.size());
    for (const auto& [key, v] : order) {
        numbering.row[v] = numbering.rows();
        numbering.vertex.push_back(v);
        if (!numbering.upper.empty() && numbering.upper[v].exists()) numbering.vertex.push_back(v);
    }
    for (int rank = 0; rank <= ranks; ++rank) {
        numbering.first_row.push_back(static_cast<int>(std::int64_t{numbering.rows()} * rank / ranks));
    }
    return numbering;
}

Cells cells_of_rank(const Mesh& mesh, const Cells& cells, const Numbering& numbering, int rank) {
    const auto is_mine = [&](const auto& cell) {
        const Region region = cell_region(mesh, cell);
        const auto owned = [&](Vertex v) {
            return numbering.owns(rank, numbering.row[v]) || numbering.owns(rank, numbering.row_at(v, region));
        };
        return std::ranges::any_of(cell_vertices(mesh, cell), owned);
    };
    Cells mine;
    std::ranges::copy_if(cells.tets, std::back_inserter(mine.tets), is_mine);
    std::ranges::copy_if(cells.prisms, std::back_inserter(mine.prisms), is_mine);
    return mine;
}

}  // namespace kropla
