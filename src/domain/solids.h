#pragma once

#include <kropla/domain/domain.h>

namespace kropla {

// Bodies with flat faces and edges, and bodies that reach through faces of the box: an interface then ends on a face, in a
// line along which its vertices slide.

/// The block between these corners. What of it is out of the box is cut away; a side that lies in a face of the box, or
/// beyond, is taken for the body reaching through that face.
/// Throws DomainError if the block is empty, or nothing of its surface is in the box.
[[nodiscard]] Shape slab(const Box& box, const Vec3& min, const Vec3& max);

/// The cylinder of this radius [m] about the line from one point to the other. What of it is out of the box is cut away; an
/// end whose middle lies in a face of the box, or beyond, is taken for the body reaching through that face.
/// Throws DomainError if it has no length, or nothing of its surface is in the box.
[[nodiscard]] Shape cylinder(const Box& box, const Vec3& from, const Vec3& to, double radius);

/// What of an ellipsoid is within the box, its surface in triangles that stand within it by less than 5e-4 of its axes; the
/// ellipsoid itself if that is all of it. Throws DomainError if nothing of its surface is in the box.
[[nodiscard]] Shape cut_ellipsoid(const Box& box, const Shape& ellipsoid);

/// What of a shape that triangles bound is within the box, its centre the centroid of that; the shape itself if that is all
/// of it. Throws DomainError if nothing of its surface is in the box, if one of its triangles lies in a face of the box, or
/// if it reaches through all six.
[[nodiscard]] Shape cut_by(const Box& box, const Shape& shape);

/// The body, as which edges it has that are kept as it deforms: those of its shape that are creases, however blunt, to a part.
[[nodiscard]] Body keep_edges(Body body);

/// A body with such a shape, which its motion takes along: of a rigid motion, which turns it about the centroid of what is in
/// the box, the deformation that is it. Where it reaches through faces, the lines in which it meets them move along these.
[[nodiscard]] Body cut_body(Body body);

/// Of a cut body as its motion takes it, rigidly: on which faces of the box its surface ends, a bit each; and is anything of
/// that in the box?
struct StandsInBox {
    unsigned faces = 0;
    bool at_all = false;
    unsigned beyond = 0;  // faces behind which something of it is: a slab under all of a floor ends there in no line
};
[[nodiscard]] StandsInBox stands_in_box(const Body& body, double t);

/// Throws DomainError if a body goes, from its start to the time `t` [s], through a face on which it does not stand upright:
/// what is cut off would be another part, with another line. With place, time and what would do.
void check_upright(const Body& body, double t);

}  // namespace kropla
