// Unknowns along the Morton curve: interleave the bits of the three coordinates and sort.
//   [Morton 1966] A computer oriented geodetic data base and a new technique in file sequencing. IBM.
#include "simulate/partition.h"

#include <algorithm>
#include <cstdint>

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

std::vector<Vertex> vertices_of(const Mesh& mesh, const std::vector<Tet>& cells) {
    Array<Vertex, char> seen(mesh.position.size(), 0);
    for (Tet t : cells) {
        for (Vertex v : mesh.tets[t]) seen[v] = 1;
    }
    std::vector<Vertex> vertices;
    for (Vertex v : mesh.position.indices()) {
        if (seen[v]) vertices.push_back(v);
    }
    return vertices;
}

}  // namespace

Numbering number_vertices(const Mesh& mesh, const std::vector<Tet>& cells, int ranks) {
    Numbering numbering{Array<Vertex, int>(mesh.position.size(), -1), vertices_of(mesh, cells), {}};
    const Frame frame = frame_of(mesh, numbering.vertex);
    std::vector<std::pair<std::uint64_t, Vertex>> order;
    order.reserve(numbering.vertex.size());
    for (Vertex v : numbering.vertex) order.emplace_back(morton_key(frame, mesh.position[v]), v);
    std::sort(order.begin(), order.end());
    for (std::size_t r = 0; r < order.size(); ++r) {
        numbering.vertex[r] = order[r].second;
        numbering.row[order[r].second] = static_cast<int>(r);
    }
    for (int rank = 0; rank <= ranks; ++rank) {
        numbering.first_row.push_back(static_cast<int>(std::int64_t{numbering.rows()} * rank / ranks));
    }
    return numbering;
}

std::vector<Tet> cells_of_rank(const Mesh& mesh, const std::vector<Tet>& cells, const Numbering& numbering,
                               int rank) {
    std::vector<Tet> mine;
    for (Tet t : cells) {
        const auto& v = mesh.tets[t];
        if (std::ranges::any_of(v, [&](Vertex a) { return numbering.owns(rank, numbering.row[a]); }))
            mine.push_back(t);
    }
    return mine;
}

}  // namespace kropla
