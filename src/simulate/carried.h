#pragma once

#include <kropla/mesh/mesh.h>

namespace kropla {

/// Where the vertices of `before` would be in `current` had each gone with the body, which moves as a whole:
/// the rigid motion is read off the body's interface (the affine map that fits it best). Vertices that did go
/// with it, to rounding, and those of the interface are given their places in `current` exactly; the others
/// were moved inside the body as well. Without an interface nothing is carried. Of meaning for the vertices
/// of the body.
[[nodiscard]] Array<Vertex, Vec3> carried_along(const Mesh& before, const Mesh& current, Region body);

}  // namespace kropla
