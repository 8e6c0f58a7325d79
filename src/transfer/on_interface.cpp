#include "transfer/on_interface.h"

#include "mesh/box_tree.h"
#include "mesh/triangle.h"
#include <kropla/mesh/topology.h>

#include <oneapi/tbb/parallel_for.h>

namespace kropla {
namespace {

std::vector<Facet> interface_facets(const Mesh& before, std::span<const Tet> cells) {
    std::vector<Facet> facets;
    for (Tet t : cells)
        for (int corner = 0; corner < 4; ++corner)
            if (const Tet n = before.neighbour[t][as_size(corner)]; n.exists() && before.region[n] != before.region[t])
                facets.push_back({t, corner});
    return facets;
}

Corners corners_of(const Mesh& before, Facet facet) {
    const auto [a, b, c] = facet_vertices(before, facet);
    return {before.position[a], before.position[b], before.position[c]};
}

/// By the areas across the corners of the facet.
std::array<double, 4> weights_at(const Mesh& before, Facet facet, const Vec3& x) {
    const auto vertices = facet_vertices(before, facet);
    const Corners t = corners_of(before, facet);
    std::array<double, 3> area;
    for (std::size_t i = 0; i < 3; ++i) area[i] = norm(cross(t[(i + 1) % 3] - x, t[(i + 2) % 3] - x));
    const double all = area[0] + area[1] + area[2];
    std::array<double, 4> weights{};
    for (std::size_t i = 0; i < 3; ++i) weights[as_size(corner_of(before, facet.tet, vertices[i]))] = area[i] / all;
    return weights;
}

}  // namespace

std::vector<Location> nearest_on_interface(const Mesh& before, const ChangedCells& changed, std::span<const Vec3> places) {
    const std::vector<Facet> facets = interface_facets(before, changed.gone);
    std::vector<Extent> boxes(facets.size());
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (const Vec3& x : corners_of(before, facets[i])) boxes[i].take_in(x);
    const BoxTree tree(std::move(boxes));
    std::vector<Location> found(places.size());
    tbb::parallel_for(std::size_t{0}, places.size(), [&](std::size_t p) {
        double least = Extent::infinite;
        std::size_t nearest = 0;
        (void)tree.least([&](const Extent& box) { return box.squared_distance(places[p]); }, [&](std::size_t i) {
            const double d = squared_norm(closest_on_triangle(corners_of(before, facets[i]), places[p]).point - places[p]);
            if (d < least) {
                least = d;
                nearest = i;
            }
            return d;
        });
        if (facets.empty()) return;
        const Vec3 there = closest_on_triangle(corners_of(before, facets[nearest]), places[p]).point;
        found[p] = {facets[nearest].tet, weights_at(before, facets[nearest], there)};
    });
    return found;
}

}  // namespace kropla
