#pragma once

#include "base/tetrahedron.h"
#include <kropla/mesh/mesh.h>
#include <kropla/mesh/topology.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The link of a vertex, its vertices at `places`, as the polyhedron in which it may move.
void star_of_ball(const Mesh& mesh, const Array<Vertex, Vec3>& places, Vertex v, std::span<const Tet> ball,
                  std::vector<StarFacet>& star);

/// Along which axes a vertex may move: not across the faces of the box it lies on.
struct Freedom {
    std::array<bool, 3> along = {true, true, true};
    [[nodiscard]] bool none() const { return !along[0] && !along[1] && !along[2]; }
    [[nodiscard]] bool all() const { return along[0] && along[1] && along[2]; }
    bool operator==(const Freedom&) const = default;
};
[[nodiscard]] Freedom freedom(const Constraint& c);
[[nodiscard]] Vec3 restricted(const Vec3& a, const Freedom& f);

/// The worst aspect ratio of the tets between `x` and the facets; evaluation ends as soon as it exceeds
/// `bound`.
[[nodiscard]] double worst_in_star(std::span<const StarFacet> star, const Vec3& x, double bound);

struct Place {
    Vec3 x;
    double worst;  // aspect ratio there
};
/// The place in the star, from `start` on, where the worst aspect ratio is least, or at most `good_enough`.
/// `start` is inside (all tets positive).
[[nodiscard]] Place best_place(std::span<const StarFacet> star, const Vec3& start, const Freedom& f,
                               double good_enough);
/// The same for a vertex and its ball; where it is, if it is held or there is no better place.
[[nodiscard]] Place better_place(const Mesh& mesh, Vertex v, std::span<const Tet> ball, double good_enough);

}  // namespace kropla
