#pragma once

#include <kropla/mesh/mesh.h>

#include <string>

namespace kropla {

/// The first rule of prism layers that is broken, with the layer's number; empty if all hold. The part of
/// `verify` that sees prisms; the tets' vertices, facets and patches are in order.
[[nodiscard]] std::string fault_of_layers(const Mesh& mesh);

}  // namespace kropla
