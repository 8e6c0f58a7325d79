#pragma once

#include "adapt/surface_star.h"
#include <kropla/adapt/adapt.h>

#include <optional>
#include <span>
#include <vector>

namespace kropla {

// Operators on the surface of a region that deforms. Each keeps the volume of the region, to rounding, within the cells it
// changes, so that what is carried from mesh to mesh keeps its integral and its bounds there; none touches a sharp edge but
// to split it or to shorten it along itself. Where the surface ends on faces of the box, its line stays there: vertices of
// it move along the faces, or not at all on those on which it is pinned.

/// A vertex, and where it is to stand.
struct Displaced {
    Vertex vertex;
    Vec3 place;
};

/// A proposed change of a surface: of connectivity, if `cavity` has cells; and vertices that stand elsewhere after it.
/// The worst aspect ratios are of all cells concerned, those of the cavity and those at the vertices.
struct SurfaceChange {
    Cavity cavity = {};
    std::vector<Displaced> moved = {};
    double worst_before = 0, worst_after = 0;
};
/// Carries a proposal out and notes it.
Replacement carry_out_surface(Mesh& mesh, const SurfaceChange& change, Changes& changes);

/// Is it an edge of the region's surface? Then its shell, which is open where the surface ends on a face of the box with
/// this edge; else nothing.
[[nodiscard]] std::optional<Shell> surface_shell(const Mesh& mesh, Edge edge, Region region);

/// A new vertex in the middle of the edge: flat, the volume inside is what it was.
[[nodiscard]] SurfaceChange surface_split(const Mesh& mesh, const Shell& shell, Edge edge);

/// Both ends become one vertex near the edge's middle, or on the face of the box, on the sharp edge or in the corner if one
/// end is there, where it keeps the volume [Lindstrom, Turk 1998, "Fast and memory efficient polygonal simplification"].
/// Nothing if both are on sharp edges and this is none, if the surface would touch itself or fold, or if a triangle's side
/// would exceed `longest` [m].
[[nodiscard]] std::optional<SurfaceChange> surface_collapse(const Mesh& mesh, Edge edge, const SurfaceOf& of,
                                                            double longest);

/// The other diagonal of the two triangles at the edge, its four vertices shifted together along the normal by what that
/// takes from the volume or adds. Nothing for a sharp edge, or if the cells at the edge cannot be filled otherwise.
[[nodiscard]] std::optional<SurfaceChange> surface_swap(const Mesh& mesh, const Shell& shell, Edge edge,
                                                        const SurfaceOf& of);

/// Puts the vertex on the quadric of those around it, and shifts all of them together along the normal, so that the volume
/// is what it was. For vertices of splits. Nothing at sharp edges, or on a face of the box.
[[nodiscard]] std::optional<SurfaceChange> raise_to_quadric(const Mesh& mesh, Vertex v, const SurfaceOf& of);

/// Slides the vertex towards the middle of the triangles around it, in the plane in which that does not change the
/// volume. Nothing at sharp edges, or if the least angle of these triangles does not grow.
[[nodiscard]] std::optional<SurfaceChange> slide(const Mesh& mesh, Vertex v, const SurfaceOf& of);

/// Slides the vertex in that plane to where the worst of its cells is better. Nothing at sharp edges, or if it is not.
[[nodiscard]] std::optional<SurfaceChange> slide_for_cells(const Mesh& mesh, Vertex v, const SurfaceOf& of);

/// The sides of the triangles around the vertex and of their angles the least [rad].
[[nodiscard]] double least_angle(const Mesh& mesh, const SurfaceStar& star, const Vec3& at);

}  // namespace kropla
