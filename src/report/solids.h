#pragma once

#include <kropla/mesh/mesh.h>

#include <vector>

namespace kropla {

/// By the number of a region: is it a solid body in a flow, as there is no pressure within?
[[nodiscard]] std::vector<bool> solid_regions(const Mesh& mesh, const Array<Vertex, double>& pressure);

}  // namespace kropla
