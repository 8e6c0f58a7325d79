#pragma once

#include "mesh/mesh.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace kropla {

/// Where a point is: in a tet, at these barycentric coordinates (they sum to one; none is below -1e-9, save for a
/// point that lies outside the region by more than rounding, which gets the nearest tet found).
struct Location {
    Tet tet;
    std::array<double, 4> weights;
};

/// Finds the tet of the region of `start` that holds `x`: a walk from `start` across the facets that `x` lies beyond,
/// as in [Devillers, Pion, Teillaud 2001], "Walking in a triangulation"; where the walk ends at the region's surface,
/// as a region need not be convex, the search spreads from there from neighbour to neighbour.
[[nodiscard]] Location locate(const Mesh& mesh, const Vec3& x, Tet start);

/// The value at a vertex of the new mesh from four values of the old one.
struct Interpolation {
    Vertex vertex;
    std::array<Vertex, 4> from;
    std::array<double, 4> weights;
};

/// How to carry linear fields from `before` to `after`, which differ only near the vertices `changed` (new or moved;
/// each may stand more than once, some may be gone): by linear interpolation, never across an interface. Vertices of
/// interfaces do not change. Exact for fields that are linear.
[[nodiscard]] std::vector<Interpolation> interpolations(const Mesh& before, const Mesh& after,
                                                        std::span<const Vertex> changed);

/// The values on the new mesh; those of vertices that did not change stay, bit for bit.
[[nodiscard]] Array<Vertex, double> carry(const Array<Vertex, double>& values, const Mesh& after,
                                          std::span<const Interpolation> interpolations);

}  // namespace kropla
