#pragma once

#include <kropla/mesh/prisms.h>

#include <vector>

namespace kropla {

/// Per facet of a layer's shell: how many times as large as the prism below it the tet above it is, by the
/// cube roots of their volumes; ascending.
[[nodiscard]] std::vector<double> shell_jumps(const Mesh& mesh, Layer layer);

}  // namespace kropla
