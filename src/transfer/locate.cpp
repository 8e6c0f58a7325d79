#include <kropla/transfer/transfer.h>

#include <kropla/mesh/cells.h>

#include <algorithm>
#include <unordered_set>

namespace kropla {
namespace {

constexpr double inside = -1e-9;   // a barycentric coordinate down to this is rounding
constexpr int longest_walk = 500;  // steps; a walk in a mesh that is not Delaunay may go round in circles

std::array<double, 4> barycentric(const Mesh& mesh, Tet t, const Vec3& x) {
    const auto& v = mesh.tets[t];
    const Vec3 a = mesh.position[v[0]] - x, b = mesh.position[v[1]] - x, c = mesh.position[v[2]] - x,
               d = mesh.position[v[3]] - x;
    const std::array<double, 4> parts = {determinant(b, d, c), determinant(a, c, d), determinant(a, d, b),
                                         determinant(a, b, c)};
    const double whole = parts[0] + parts[1] + parts[2] + parts[3];
    return {parts[0] / whole, parts[1] / whole, parts[2] / whole, parts[3] / whole};
}

Tet across(const Mesh& mesh, Tet t, int corner) {
    const Tet n = mesh.neighbour[t][as_size(corner)];
    return n.exists() && mesh.region[n] == mesh.region[t] ? n : Tet{};
}

/// Spreads from `start`; the first tet that holds `x`, or the one that comes nearest to holding it.
Location search(const Mesh& mesh, const Vec3& x, Tet start) {
    std::vector<Tet> queue{start};
    std::unordered_set<std::int32_t> seen{start.value};
    Location best{start, barycentric(mesh, start, x)};
    for (std::size_t i = 0; i < queue.size(); ++i) {
        const Location here{queue[i], barycentric(mesh, queue[i], x)};
        if (std::ranges::min(here.weights) > std::ranges::min(best.weights)) best = here;
        if (std::ranges::min(best.weights) >= inside) return best;
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = across(mesh, queue[i], corner); n.exists() && seen.insert(n.value).second)
                queue.push_back(n);
    }
    return best;
}

}  // namespace

Location locate(const Mesh& mesh, const Vec3& x, Tet start) {
    Tet t = start;
    for (int step = 0; step < longest_walk; ++step) {
        const auto weights = barycentric(mesh, t, x);
        const auto least = std::ranges::min_element(weights);
        if (*least >= inside) return {t, weights};
        const Tet next = across(mesh, t, static_cast<int>(least - weights.begin()));
        if (!next.exists()) break;
        t = next;
    }
    return search(mesh, x, t);
}

}  // namespace kropla
