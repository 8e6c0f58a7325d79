#include "case/mesh_size.h"

#include <kropla/mesh/cells.h>
#include <kropla/mesh/topology.h>

#include <algorithm>
#include <vector>

namespace kropla {
namespace {

constexpr double one_in_a_hundred = 0.99;
constexpr std::size_t most_edges = 20000;  // whose distance is asked for; spread evenly over the mesh

/// The value that this share of them are not above; they are some.
double quantile(std::vector<double> values, double share) {
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

struct Line {
    Vec3 middle;
    double length;
};

/// The edges of all tets, each as often as it has tets; and of facets between regions the lengths, each twice or more.
void find_edges(const Mesh& mesh, std::vector<Line>& edges, std::vector<double>& on_surfaces) {
    for (const Tet t : all_tets(mesh)) {
        const auto place = [&](int corner) { return mesh.position[mesh.tets[t][as_size(corner)]]; };
        for (const auto& [a, b] : tet_edges) edges.push_back({0.5 * (place(a) + place(b)), distance(place(a), place(b))});
        for (std::size_t i = 0; i < 4; ++i) {
            const Tet n = mesh.neighbour[t][i];
            if (!n.exists() || mesh.region[n] == mesh.region[t]) continue;
            const auto& [a, b, c] = tet_facets[i];
            for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, a}}) on_surfaces.push_back(distance(place(p), place(q)));
        }
    }
}

}  // namespace

SizeField size_of_mesh(const Mesh& mesh, const Domain& domain) {
    std::vector<Line> edges;
    std::vector<double> on_surfaces, lengths, growths;
    find_edges(mesh, edges, on_surfaces);
    for (const Line& edge : edges) lengths.push_back(edge.length);
    SizeField size;
    size.far = quantile(lengths, one_in_a_hundred);
    if (on_surfaces.empty()) return {.surface = size.far, .growth = 0, .far = size.far};
    size.surface = quantile(on_surfaces, 0.5);
    size.far = std::max(size.far, size.surface);
    Domain sized = domain;
    sized.size = size;  // thin places are looked for at these
    const Snapshot at = snapshot(sized, 0);
    const std::size_t stride = edges.size() / most_edges + 1;
    for (std::size_t i = 0; i < edges.size(); i += stride) {
        const double away = distance_to_bodies(at, edges[i].middle);
        if (away > size.surface) growths.push_back((edges[i].length - size.surface) / away);
    }
    size.growth = growths.empty() ? 0 : std::clamp(quantile(std::move(growths), 0.5), 0.0, steepest_growth);
    return size;
}

}  // namespace kropla
