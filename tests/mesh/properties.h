#pragma once

#include <kropla/mesh/mesh.h>

#include <map>
#include <vector>

namespace kropla {

/// What an operation on a mesh must not change.
struct Properties {
    std::map<Region, double> volume;      // [m^3]
    std::map<Patch, Vec3> area;           // [m^2], the sum of the facets' outward area vectors
    int euler_characteristic = 0;         // vertices - edges + facets - cells; 1 for a ball
    std::vector<BoundaryFacet> boundary;  // sorted, their vertices ascending
};
[[nodiscard]] Properties properties(const Mesh& mesh);

/// The same regions, patches and topology, volumes to 1e-12 of the whole: what holds for every operation.
[[nodiscard]] bool same_shape(const Properties& a, const Properties& b);

/// The same shape and the same boundary facets: what holds for operations inside.
[[nodiscard]] bool same(const Properties& a, const Properties& b);

}  // namespace kropla
