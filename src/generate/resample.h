#pragma once

#include <kropla/base/error.h>
#include <kropla/generate/generate.h>

namespace kropla {

/// Well-shaped triangles of edge length near `size` [m] on the surface of a shape that triangles bound, whatever those
/// are like, where the shape stands. All vertices lie on its surface to rounding; those of its creases (creases.h) and
/// corners on these, so that flat faces between creases are covered exactly, and a body of such faces keeps its volume
/// to rounding. Of a curved part the polyhedron holds what one inscribed does: on a ball of radius r a share of
/// 3 h^2 / (8 r^2) less than the body. Where corners are nearer to each other than `size`, edges are as short as that.
[[nodiscard]] Surface resampled(const Shape& shape, const SurfaceSize& size, const Watch* watch = nullptr);

/// Of the surface of a body: it cannot be had with triangles as large as they are asked for.
struct BodyError : DomainError {
    BodyError(std::size_t of, const std::string& what) : DomainError(what), body(of) {}
    std::size_t body;  // its number in the snapshot
};

/// The snapshot with, for each shape that triangles bound, what its surface among `walls` bounds: no finer than the mesh,
/// so that distances cost no more than that. Throws BodyError if such a surface cuts itself, as where a part is thinner than its
/// triangles, or closes on a face of the box, where it ends in a line that is shorter than these; says that a smaller
/// size may do.
[[nodiscard]] Snapshot bounded_by(const std::vector<Surface>& walls, const Snapshot& at);

/// A point that was put into an edge.
struct Added {
    Vec3 place;
    double half_edge;  // [m] half the length of the edge
};
/// Splits the longest edges of these triangles of a surface of the shape, the new points on its wall or crease, and flips
/// edges for better triangles; an ellipsoid's is scaled to its volume again.
[[nodiscard]] std::vector<Added> refine_surface(Surface& surface, const std::vector<std::size_t>& triangles,
                                                const Shape& shape);
/// The same, of a shape that triangles bound.
[[nodiscard]] std::vector<Added> refine(Surface& surface, const std::vector<std::size_t>& triangles, const Shape& shape);

}  // namespace kropla
