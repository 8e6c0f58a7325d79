#pragma once

#include <kropla/generate/generate.h>

#include <array>
#include <optional>
#include <vector>

namespace kropla {

/// A part of the domain that is triangulated by itself: surfaces that shall be facets, and all other points.
struct Room {
    std::vector<Surface> surfaces;
    std::vector<Region> enclosed;  // per surface: what is inside it
    std::vector<Vec3> others;
};

/// The points of the surfaces, one after the other, then the others.
[[nodiscard]] std::vector<Vec3> all_points(const Room& room);

/// Three vertices in a cyclic order that matters, the least first.
using Turn = std::array<Vertex, 3>;

struct TetFacet {
    Turn vertices;  // counter-clockwise seen from outside the tet
    Tet tet;
    std::size_t corner;
};

/// Where a surface triangle was looked for: the tet on its inner side, if it is a facet.
struct SurfaceFacet {
    std::size_t surface, triangle;
    std::optional<TetFacet> inner;
};
/// Looks for all triangles of the room's surfaces in the triangulation of its points.
[[nodiscard]] std::vector<SurfaceFacet> find_surfaces(const Triangulation& filled, const Room& room);

/// The region of each tet: that which the surface around it encloses, else the surroundings. All triangles of
/// the surfaces were found.
[[nodiscard]] Array<Tet, Region> identify_regions(const Triangulation& filled, const Room& room,
                                                  const std::vector<SurfaceFacet>& found);

/// A ball of space that is to be free of points.
struct Sphere {
    Vec3 centre;
    double radius;
};
/// The sphere whose centre is in the plane of a triangle and that passes through its corners.
[[nodiscard]] Sphere diametral_sphere(const Surface& surface, std::size_t triangle);
/// Removes the points in the sphere; those of the box stay. Returns how many.
std::size_t clear_sphere(std::vector<Vec3>& others, const Box& box, const Sphere& sphere);

}  // namespace kropla
