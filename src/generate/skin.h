#pragma once

#include <kropla/base/index.h>
#include <kropla/generate/generate.h>

#include <array>

namespace kropla {

using Triangle = Index<struct TriangleTag>;

/// A closed triangulated surface that can be changed, all of whose triangles are seen from the point
/// `inside`.
struct Skin {
    Vec3 inside;
    Array<Vertex, Vec3> points;
    Array<Triangle, std::array<Vertex, 3>> triangles;  // counter-clockwise seen from outside
    Array<Triangle, std::array<Triangle, 3>> across;   // the triangle across the edge opposite corner i
};

/// The surface must be closed, and seen from `inside`.
[[nodiscard]] Skin make_skin(const Surface& surface, const Vec3& inside);
[[nodiscard]] Surface surface_of(const Skin& skin);

/// Splits the longest edge of `t`; the new point, which is returned, is put on the surface of `shape`.
Vertex split_longest_edge(Skin& skin, const Shape& shape, Triangle t);

/// Flips edges where that raises the least angle of their two triangles, until none is left. Returns how
/// many.
int flip_edges(Skin& skin, const Watch* watch = nullptr);

/// Moves the points on the surface of `shape` and flips edges until the triangles are well shaped, and have each their size.
void relax_skin(Skin& skin, const Shape& shape, const SurfaceSize& size, const Watch* watch = nullptr);

}  // namespace kropla
