#pragma once

#include <kropla/domain/domain.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The surface of a body that deforms, as a mesh has it.
struct DeformingSurface {
    std::size_t body;
    std::vector<Vertex> vertices;                  // in ascending order
    std::vector<std::array<Vertex, 3>> triangles;  // counter-clockwise seen from outside
};
/// Of the bodies of the domain that have a deformation, in their order.
[[nodiscard]] std::vector<DeformingSurface> deforming_surfaces(const Domain& domain, const Mesh& mesh);

/// What it bounds, with its vertices at `places` [m].
[[nodiscard]] Shape shape_of(const DeformingSurface& surface, const Array<Vertex, Vec3>& places);

/// The domain at time `t` [s], its deforming bodies as their surfaces are with the vertices at `places`.
[[nodiscard]] Snapshot snapshot(const Domain& domain, double t, std::span<const DeformingSurface> deforming,
                                const Array<Vertex, Vec3>& places);

}  // namespace kropla
