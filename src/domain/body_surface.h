#pragma once

#include <kropla/domain/domain.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The surface of a body, as a mesh has it.
struct BodySurface {
    std::size_t body;
    std::vector<Vertex> vertices;                  // in ascending order
    std::vector<std::array<Vertex, 3>> triangles;  // counter-clockwise seen from outside
};
/// Of these bodies, in their order.
[[nodiscard]] std::vector<BodySurface> body_surfaces(const Mesh& mesh, std::span<const std::size_t> bodies);
/// Of the bodies of the domain that have a deformation.
[[nodiscard]] std::vector<BodySurface> deforming_surfaces(const Domain& domain, const Mesh& mesh);

/// What it bounds in the box, at whose faces it may end, with its vertices at `places` [m].
[[nodiscard]] Shape shape_of(const BodySurface& surface, const Array<Vertex, Vec3>& places, const Box& box);

/// The domain at time `t` [s], its deforming bodies as their surfaces are with the vertices at `places`; target sizes fall
/// in gaps if one is narrow, or if triangles are `uneven` for the sake of one, so that they grow again by and by.
[[nodiscard]] Snapshot snapshot(const Domain& domain, double t, std::span<const BodySurface> deforming,
                                const Array<Vertex, Vec3>& places, bool uneven);

}  // namespace kropla
