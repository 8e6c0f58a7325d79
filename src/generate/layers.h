#pragma once

#include <kropla/domain/domain.h>
#include <kropla/generate/generate.h>
#include <kropla/mesh/prisms.h>

#include <optional>
#include <span>
#include <vector>

namespace kropla {

/// The places of a layer's column vertices, in the order of PrismLayer::columns, from where the wall's
/// vertices stand (one per column) and what is around them at that time, and from nothing else: not from
/// where they were before. Columns stand along the wall's normals (surface_normals), their heights
/// first_height * growth^k exactly where there is room, and in proportion where layer_thickness
/// (layer_room.h) makes them thinner. Where there is no room at all a column has no height: see
/// narrowest_gap. The layer's `columns` are not looked at. At creation and at every time step. After the
/// paper, section 1.4.
[[nodiscard]] std::vector<Vec3> column_places(const PrismLayer& layer, std::span<const Vec3> wall,
                                              const Snapshot& at);

/// Where the wall's vertices of a layer stand in the mesh, one per column.
[[nodiscard]] std::vector<Vec3> wall_places(const Mesh& mesh, const PrismLayer& layer);

/// Where the gap between a layered body and a wall or another body is the least part of the body's least_gap,
/// seen from the points of its surface at the wall's vertices. Nothing without a layer outside a body.
struct NarrowestGap {
    std::size_t body;
    double distance;  // [m]
    double allowed;   // [m] least_gap of the body's layer: refuse if distance is less
    Vec3 place;       // on the body
    int wall;         // the face of the box, 0 ... 5, that is near; -1: a body
    std::size_t other;  // that body, where it is one
};
[[nodiscard]] std::optional<NarrowestGap> narrowest_gap(const Mesh& mesh, const Snapshot& at);

/// Stacks of prisms on a body's triangulated surface: the layer without its vertices' names, and their
/// places.
struct Stacks {
    PrismLayer layer;
    std::vector<Vec3> places;  // as column_places
};
/// The layer at that side of the body, if it has one there.
[[nodiscard]] std::optional<Stacks> stacks_on(const Surface& wall, std::size_t body, bool inside,
                                              const Snapshot& at);
/// The last vertices of the columns, joined as the wall is: triangles counter-clockwise seen from outside the
/// body.
[[nodiscard]] Surface shell_of(const Surface& wall, const Stacks& stacks);

}  // namespace kropla
