#pragma once

#include <kropla/domain/domain.h>

#include <initializer_list>
#include <vector>

namespace kropla {

/// The eight corners of the box.
[[nodiscard]] std::vector<Vec3> box_corners(const Box& box);

/// The points within the twelve edges of the box, spaced evenly in terms of the target size, between its corners and the
/// points `given` on edges.
[[nodiscard]] std::vector<Vec3> sample_box_edges(const Snapshot& at, const std::vector<Vec3>& given = {});

/// The face of the box that is `patch`, as a flat box.
[[nodiscard]] Box face_of_box(const Box& box, Patch patch);

/// Exactly, by its coordinate.
[[nodiscard]] bool lies_on_face(const Box& box, Patch patch, const Vec3& x);

/// The face of the box on which all `points` lie, by their coordinates; none if they share no face.
[[nodiscard]] Patch shared_face(const Box& box, std::initializer_list<Vec3> points);

/// The distance from `x` to the nearest face of the box [m], negative outside.
[[nodiscard]] double distance_to_walls(const Box& box, const Vec3& x);

}  // namespace kropla
