// The change of cell size at the shells of prism layers.
#include "app/shell_jump.h"

#include <kropla/mesh/cells.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace kropla {
namespace {

using Facet = std::array<Vertex, 3>;  // ascending

/// The volume [m^3] of the outermost prism below each facet of the shell.
std::map<Facet, double> outermost_prisms(const Mesh& mesh, Layer l) {
    const PrismLayer& layer = layer_of(mesh, l);
    std::map<Facet, double> volumes;
    for (int triangle = 0; triangle < static_cast<int>(layer.triangles.size()); ++triangle) {
        const Prism prism{l, triangle, layer.count - 1};
        const auto v = prism_vertices(mesh, prism);
        Facet facet{v[3], v[4], v[5]};
        std::ranges::sort(facet);
        volumes[facet] = prism_volume(prism_corners(mesh, prism));
    }
    return volumes;
}

}  // namespace

std::vector<double> shell_jumps(const Mesh& mesh, Layer layer) {
    const std::map<Facet, double> below = outermost_prisms(mesh, layer);
    std::vector<double> jumps;
    for (Tet t : mesh.tets.indices())
        for (std::size_t corner = 0; corner < 4; ++corner) {
            if (!alive(mesh, t) || mesh.patch[t][corner] != shell_patch(layer)) continue;
            Facet facet;
            for (std::size_t k = 0; k < 3; ++k)
                facet[k] = mesh.tets[t][static_cast<std::size_t>(tet_facets[corner][k])];
            std::ranges::sort(facet);
            if (const auto prism = below.find(facet); prism != below.end())
                jumps.push_back(std::cbrt(volume(mesh, t) / prism->second));
        }
    std::ranges::sort(jumps);
    return jumps;
}

}  // namespace kropla
