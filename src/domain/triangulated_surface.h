#pragma once

#include <kropla/base/error.h>
#include "domain/triangle_tree.h"
#include <kropla/domain/shape.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>

namespace kropla {

/// What is wrong with triangles that are to bound a volume; and the numbers of those that are at fault, where it is they.
struct SurfaceError : DomainError {
    SurfaceError(const std::string& what, std::vector<std::size_t> at) : DomainError(what), triangles(std::move(at)) {}
    std::vector<std::size_t> triangles;
};

/// Triangles that meet at more than this angle [rad] (35 degrees) meet in a crease; at less, they stand for a smooth surface.
inline constexpr double sharp = 0.61;

class ThinPlaces;        // thin_places.h
struct FoundThinPlaces;  // of one surface

/// A closed surface of triangles, in one part or several, which bounds a volume: made by `make_surface`. Or one that is open
/// where faces of a box cut it (`shape_of_facets`), which bounds a volume together with these: asked for places in the box.
class TriangulatedSurface {
public:
    [[nodiscard]] const TriangleTree& tree() const { return tree_; }
    [[nodiscard]] std::span<const Vec3> points() const { return tree_.points(); }
    [[nodiscard]] std::span<const std::array<int, 3>> triangles() const { return tree_.triangles(); }

    /// The distance from `x` to the surface [m], negative inside: exact to rounding, and so is its sign where the
    /// distance is above that. In time that grows with the logarithm of the number of triangles.
    [[nodiscard]] double signed_distance(const Vec3& x) const { return signed_distance(x, tree_.nearest(x)); }
    /// The same of an `x` whose nearest place is known.
    [[nodiscard]] double signed_distance(const Vec3& x, const NearestPlace& nearest) const;
    [[nodiscard]] Vec3 closest_point(const Vec3& x) const { return tree_.nearest(x).point; }
    /// How far it is from `x` in it, along the outward normal there or against it, to another part of the surface that is
    /// parallel, its normal against this one by a cosine of at least `parallel`, or through the body to such a face of the
    /// box [m]; infinite if none is within `most`, and outwards of an open one.
    [[nodiscard]] double width_between(const Vec3& x, const Vec3& normal, bool inside, double most, double parallel) const;
    /// The same from the place nearest to `x`, to what is parallel to within 40 degrees.
    [[nodiscard]] double across(const Vec3& x, bool inside, double most) const;
    /// The radius by which it bends from a triangle to its neighbours [m], over edges that are not `sharp`; infinite if flat.
    [[nodiscard]] double radius_at(std::size_t triangle) const;
    /// The least angle between normals beyond `sharp` at an edge [rad]; infinite if it has no crease.
    [[nodiscard]] double least_crease() const;
    /// Its thin places, for sizes between these [m]; found once, for all that share the surface.
    [[nodiscard]] std::shared_ptr<const ThinPlaces> thin_places(double least, double most) const;
    /// The radius of the ball that touches it at the place nearest to `x`, from inside or outside, with none of its points
    /// within [m], at most `most`: by a ball that shrinks [Ma, Bae, Choi 2012, "3D medial axis point approximation using
    /// nearest neighbors and the normal field"].
    [[nodiscard]] double touching_ball(const Vec3& x, bool inside, double most) const;

    [[nodiscard]] double volume() const { return volume_; }      ///< [m^3]
    [[nodiscard]] double area() const { return area_; }          ///< [m^2]
    [[nodiscard]] const Vec3& centroid() const { return centroid_; }  ///< of the volume
    [[nodiscard]] const Extent& extent() const { return extent_; }    ///< the box that just holds it, and what it bounds
    [[nodiscard]] double farthest() const { return farthest_; }       ///< of its points from the origin [m]
    [[nodiscard]] unsigned reached() const { return reached_; }  ///< faces of the box on which what it bounds lies, as bits
    /// One point of each connected part.
    [[nodiscard]] std::span<const Vec3> point_of_parts() const { return point_of_parts_; }

private:
    friend TriangulatedSurface make_surface(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);
    friend Shape shape_of_facets(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles, const Bounds* box);
    TriangulatedSurface(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);
    /// It is open; what it bounds has this volume [m^3] and reaches the faces of the box, given as the points are, on which
    /// it is open, or in whose middles it is.
    void ends_on(const Bounds& box, unsigned open, double volume);
    /// What a way along a direction comes to, which is told if it is longer than `least`.
    struct Opposite {
        double way = std::numeric_limits<double>::infinity();  // [m]
        Vec3 normal;                                           // outwards there
    };
    [[nodiscard]] Opposite opposite(const Vec3& from, const Vec3& direction, bool inside, double least, double most) const;
    [[nodiscard]] bool is_at_edge(const Vec3& middle, const Vec3& normal, const Opposite& other, bool inside, double most) const;
    [[nodiscard]] Opposite through_face(const Vec3& from, const Vec3& direction) const;
    /// A normal there, as long as it comes.
    [[nodiscard]] const Vec3& outwards(const NearestPlace& at) const;
    static TriangulatedSurface joined(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles,
                                      bool is_checked, std::span<const unsigned> faces = {});

    TriangleTree tree_;
    std::vector<Vec3> inside_normal_;                // per triangle, of unit length
    std::vector<std::array<Vec3, 3>> edge_normal_;   // per triangle, of the edge from corner i to the next
    std::vector<Vec3> corner_normal_;                // per point
    std::vector<Vec3> point_of_parts_;
    double volume_ = 0, area_ = 0, farthest_ = 0;
    unsigned reached_ = 0;
    Vec3 centroid_;
    Extent extent_;
    std::shared_ptr<FoundThinPlaces> thin_;
};

/// The surface of these triangles, by the numbers of their corners among `points` [m], counter-clockwise seen from
/// outside; all of them are turned round if what they bound is inside out. Points that are in one place are one point:
/// files of triangles without numbers (STL) are to be joined first. Parts may be beside each other, or a hollow within
/// a part, turned to the other side.
/// Throws SurfaceError, naming the first triangle, edge or point and its place, and how many there are, if there is nothing, a number is not finite or has
/// no point, a triangle has no area, an edge has not just two triangles (open; or not manifold), these are turned
/// against each other, triangles touch in a point only, or cut each other, or a part lies within another and is turned
/// as that one.
[[nodiscard]] TriangulatedSurface make_surface(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles);

/// What facets of a mesh bound where they are [m], its centre its centroid: they are known to be a closed surface that is
/// turned out, and nothing is looked at but that each edge has two. For surfaces that are made anew in every step. Edges
/// with both ends on a face of `box`, exactly, may have one: there the body goes on to the face, and the volume is what is
/// within the box. Throws SurfaceError if an edge is open elsewhere, or if along all three axes the surface is open at
/// both faces.
[[nodiscard]] Shape shape_of_facets(std::vector<Vec3> points, std::vector<std::array<int, 3>> triangles,
                                    const Bounds* box = nullptr);

}  // namespace kropla
