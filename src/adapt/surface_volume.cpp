#include "adapt/surface_volume.h"

#include "base/tetrahedron.h"

namespace kropla {

double volume_under(std::span<const Triangle> triangles, const Places& places, const Vec3& origin) {
    double sum = 0;
    for (const auto& [a, b, c] : triangles)
        sum += determinant(places[a] - origin, places[b] - origin, places[c] - origin);
    return sum;
}

std::vector<Triangle> triangles_at(const Mesh& mesh, std::span<const Vertex> vertices, Region region) {
    std::vector<Triangle> all;
    for (Vertex v : vertices)
        for (const auto& [a, b] : surface_star(mesh, v, region).sides) {
            Triangle t{v, a, b};
            std::rotate(t.begin(), std::ranges::min_element(t), t.end());
            all.push_back(t);
        }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

}  // namespace kropla
