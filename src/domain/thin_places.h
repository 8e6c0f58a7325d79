#pragma once

#include "mesh/box_tree.h"
#include "mesh/triangle.h"

#include <cstddef>
#include <memory>
#include <vector>

namespace kropla {

struct Snapshot;            // domain.h
class TriangulatedSurface;  // triangulated_surface.h

/// Where a surface of triangles faces another part of itself nearby that is nearly parallel to it: across what it bounds, as
/// at a plate, a fin or a wire, or across what it leaves open, as in a slot; and where sharp edges of it come near to others
/// that they do not meet, or to a face of the box that cuts it. And the sizes that triangles have to have there.
class ThinPlaces {
public:
    /// Sizes from `least` to `most` [m]. Each triangle of the surface is looked at, and its parts as far as they differ.
    ThinPlaces(const TriangulatedSurface& surface, double least, double most);

    [[nodiscard]] bool any() const { return !groups_.empty(); }
    /// The target size at `x` [m]: where the surface is flat, `gap_share` of the width; where it is round, its radius, but not
    /// below `neck_share` of the width; at edges `gap_share` of it; from there it rises by `growth` per metre.
    [[nodiscard]] double size(const Vec3& x, double growth) const;

    /// What is thin: the body, what it leaves open, what is between edges, or between an edge and a face of the box.
    enum class Kind { body, slot, edges, edge_at_face };
    struct Width {
        double across;  // [m], infinite if there is nothing near
        Kind kind;
        Vec3 at;
    };
    [[nodiscard]] const Width& narrowest() const { return narrowest_; }

private:
    /// A part of a triangle, and the size there [m], below most.
    struct Place {
        Corners part;
        double size;
    };
    /// Places of about the same size, so that one that is near rules out those that are farther.
    struct Group {
        double smallest;  // [m]
        std::vector<Place> places;
        BoxTree tree;
    };
    struct Look;
    struct EdgeLook;

    double most_;
    std::vector<Group> groups_;
    Width narrowest_;
};

/// Of a body that triangles bound, for the sizes that it may have.
[[nodiscard]] std::shared_ptr<const ThinPlaces> thin_places_of(const Snapshot& at, std::size_t body);

}  // namespace kropla
