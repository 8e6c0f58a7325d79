#pragma once

#include <kropla/base/vec3.h>

#include <vector>

namespace kropla {

class TriangulatedSurface;  // triangulated_surface.h

/// The sharp edges of a surface, and the lines in which it ends on faces of a box, as courses from corner to corner, or round.
/// A corner is where other than two of them meet, or two in a bend.
struct SharpEdges {
    explicit SharpEdges(const TriangulatedSurface& surface);

    struct Segment {
        Vec3 a, b;
        int course;
    };
    /// Along one course.
    struct Course {
        std::vector<int> corners;  // points of the surface that it ends in
        // Of the box, a bit each, that it, or a course that it meets, has a point on, or to which a triangle there is nearly
        // parallel.
        unsigned faces = 0;
    };
    std::vector<Segment> segments;
    std::vector<Course> courses;

    /// Do both courses end in the same corner, or are they the same?
    [[nodiscard]] bool meet(int one, int other) const;
};

}  // namespace kropla
