#pragma once

#include <kropla/mesh/mesh.h>
#include "report/point2.h"

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// A plane with its axes, seen from the side to which cross(right, up) points.
struct CutPlane {
    Vec3 origin;     // [m]
    Vec3 right, up;  // of unit length, perpendicular
};
/// Through `origin`, normal to an axis: 0 (y to the right, z up), 1 (x, z) or 2 (x, y).
[[nodiscard]] CutPlane plane_across(int axis, const Vec3& origin);

/// Where the plane meets an edge of the mesh.
struct CutCorner {
    Vertex a, b;   // a before b
    double share;  // 0 at a ... 1 at b
    Point2 place;  // [m] along right and up from the origin
};

/// What the plane cuts out of a cell, counter-clockwise as seen: a triangle or a quad, convex, of a tet; up to seven
/// corners of a prism.
struct CutPolygon {
    Region region;
    bool of_prism = false;
    int size = 3;  // corners
    std::array<CutCorner, 7> corners;
};

/// The part of a cut that is shown [m].
struct CutWindow {
    Point2 min, max;
};

/// All cells cut by the plane; those it touches without area are left out. A facet in the plane is cut out of
/// one of its two cells, so that every place of the plane inside the mesh is covered once. The curve in which the
/// plane meets a bent quad of a prism is drawn straight.
[[nodiscard]] std::vector<CutPolygon> cut_mesh(const Mesh& mesh, const CutPlane& plane);

[[nodiscard]] inline std::span<const CutCorner> corners(const CutPolygon& polygon) {
    return {polygon.corners.data(), static_cast<std::size_t>(polygon.size)};
}
[[nodiscard]] double area(const CutPolygon& polygon);  // [m^2]

/// The value there of a field that is linear along every edge.
[[nodiscard]] inline double value_at(const CutCorner& corner, const Array<Vertex, double>& field) {
    return (1 - corner.share) * field[corner.a] + corner.share * field[corner.b];
}

}  // namespace kropla
