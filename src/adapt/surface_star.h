#pragma once

#include "adapt/star.h"
#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>
#include <kropla/mesh/topology.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace kropla {

// What the operators on the surface of a region ask of it at a vertex. The region is a body that deforms; its surface are
// the facets between its cells and others; on faces of the box it may end, in lines along which its vertices slide.

/// A vertex of the surface, the cells at it on both sides in ascending order, and the sides opposite to it of the
/// triangles around it, each from its first end to its second counter-clockwise seen from outside; and along which axes the faces of the box on which
/// it lies let it go.
struct SurfaceStar {
    Vertex vertex;
    std::vector<Tet> cells;
    std::vector<std::array<Vertex, 2>> sides;
    Freedom free = {};
};
/// The surface of a region, and what holds there as it changes.
struct SurfaceOf {
    Region region;
    unsigned pinned = 0;   // faces of the box, a bit each, on which its line does not move
    double sharp = blunt;  // cosine of the angle between normals, beyond which an edge is sharp, and kept
};

/// The axes along which the patches at the vertex let it go.
[[nodiscard]] Freedom free_on_patches(const Mesh& mesh, Vertex v, std::span<const Tet> ball);
[[nodiscard]] SurfaceStar surface_star(const Mesh& mesh, Vertex v, Region region);

/// Twice the area of the triangle times its normal, right hand.
[[nodiscard]] inline Vec3 twice_area(const Vec3& a, const Vec3& b, const Vec3& c) { return cross(b - a, c - a); }

/// Twice the sum of the areas of the triangles around the vertex times their normals, which does not depend on where it
/// is: with the vertex somewhere else, the volume inside grows by a sixth of its product with the displacement.
[[nodiscard]] Vec3 twice_area(const SurfaceStar& star, const Mesh& mesh);

/// The other ends of the sharp edges at the vertex: at which two of the triangles around it meet so.
[[nodiscard]] std::vector<Vertex> sharp_ends(const SurfaceStar& star, const Mesh& mesh, double sharp);
[[nodiscard]] inline bool is_sharp(const SurfaceStar& star, const Mesh& mesh, double sharp) {
    return !sharp_ends(star, mesh, sharp).empty();
}
/// Do these normals make a sharp edge?
[[nodiscard]] bool is_sharp(const Vec3& one_normal, const Vec3& other_normal, double sharp);

/// The vertices of the surface around the star's, in ascending order; and those within two edges, but not beyond sharp ones.
[[nodiscard]] std::vector<Vertex> ring(const SurfaceStar& star);
[[nodiscard]] std::vector<Vertex> two_rings(const Mesh& mesh, const SurfaceStar& star, const SurfaceOf& of);

/// Where the quadric that fits the vertices within two edges best, but for the star's own, passes over or under it, along
/// its normal: that far from it [m]. Nothing where too few stand around it, or they lie badly. Exact where these are on a
/// paraboloid about the normal; else off by the third power of their distance.
[[nodiscard]] std::optional<double> height_of_quadric(const Mesh& mesh, const SurfaceStar& star, const SurfaceOf& of);

}  // namespace kropla
