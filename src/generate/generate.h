#pragma once

#include <kropla/base/watch.h>
#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

#include <cstdint>
#include <span>
#include <vector>

namespace kropla {

/// A Delaunay triangulation of a set of points: tets by the points' indices, positively oriented, and the
/// tets across their facets (none: on the hull). A point equal to an earlier one is in no tet; `same_as`
/// names that one.
struct Triangulation {
    Array<Tet, std::array<Vertex, 4>> tets;
    Array<Tet, std::array<Tet, 4>> neighbour;
    Array<Vertex, Vertex> same_as;  // none for points that are vertices
};
/// Triangulates any set of points, degenerate ones included; ties are broken by the points' indices, so that
/// the triangulation is unique. Fewer than four points, or all of them coplanar: no tets.
/// Throws Interrupted if the watch says so.
[[nodiscard]] Triangulation triangulate(std::span<const Vec3> points, const Watch* watch = nullptr);

/// A triangulated surface, closed, or open at faces of the box that its body reaches through; triangles are
/// counter-clockwise seen from outside.
struct Surface {
    std::vector<Vec3> points;
    std::vector<std::array<int, 3>> triangles;
    std::vector<std::array<int, 2>> creases = {};  // sharp edges, which are kept; each by its ends, the lower one first
};
/// The volume inside a closed surface [m^3]; the sum over its triangles is compensated [Neumaier 1974], so that
/// it is right to rounding, whatever their number. `inside` is a point in it.
[[nodiscard]] double enclosed_volume(const Surface& surface, const Vec3& inside);
/// Scales a surface around a shape's centre about it, until the polyhedron holds the shape's volume.
void give_volume(Surface& surface, const Shape& shape);

/// The edge length wanted at the places of a surface [m]: `most`, or what is `local`, which is no more.
struct SurfaceSize {
    double most;
    LocalSize local = {};
    [[nodiscard]] double operator()(const Vec3& x) const { return local ? local(x) : most; }
};

/// Covers the surface of a shape with well-shaped triangles of edge length near `size` [m]. Of an ellipsoid the polyhedron
/// holds the volume to rounding: its vertices lie on the shape blown up about its centre,
/// `outward_shift` (domain.h) away from its surface at most, and that surface runs between them and the
/// triangles' middles. Of what triangles bound, sharp edges and corners are kept, and the vertices lie on the surface: a
/// body with flat faces between such edges has its volume to rounding, of a curved part that of a polyhedron inscribed
/// (resample.h).
[[nodiscard]] Surface triangulate_surface(const Shape& shape, const SurfaceSize& size, std::uint64_t seed,
                                          const Watch* watch = nullptr);
[[nodiscard]] inline Surface triangulate_surface(const Shape& shape, double size, std::uint64_t seed,
                                                 const Watch* watch = nullptr) {
    return triangulate_surface(shape, SurfaceSize{size}, seed, watch);
}

/// The points from which the initial mesh is made: of each body's surface, of the box's corners, edges and
/// faces, and inside; all at the target size, well apart, nowhere a gap that would hold another (maximal).
struct PointSet {
    std::vector<Vec3> points;
    std::vector<Surface> surfaces;      // per body
    std::vector<int> first_of_surface;  // per body: the index in `points` of its surface's first point
};
[[nodiscard]] PointSet sample_points(const Snapshot& at, std::uint64_t seed, const Watch* watch = nullptr);

/// The initial mesh (paper 1.1, 1.4), before any improvement: points, Delaunay, bodies identified as regions,
/// faces of the box as patches, and the prism layers that bodies have: a body's outside before its inside,
/// tets ending at walls and shells. Where a triangle of a surface is not a facet, points that stand in its
/// way are removed and surface points are added until it is.
/// Throws DomainError as check_placement and check_layers, or if a layer is asked for at a surface of triangles, or a surface
/// cannot be made to conform; Interrupted if the watch says so.
[[nodiscard]] Mesh generate_mesh(const Domain& domain, std::uint64_t seed, const Watch* watch = nullptr);

/// The mesh without free slots, its vertices and cells numbered along a Hilbert curve, so that what is near in
/// space is near in memory.
[[nodiscard]] Mesh in_spatial_order(const Mesh& mesh);

}  // namespace kropla
