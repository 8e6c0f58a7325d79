#pragma once

#include <kropla/base/watch.h>
#include <kropla/domain/shape.h>
#include <kropla/mesh/mesh.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kropla {

/// The box around everything. Its faces are the patches 0 ... 5: x min, x max, y min, y max, z min, z max. A mesh from
/// elsewhere need not have them all; those it has lie on the box.
struct Box {
    Vec3 min, max;  // [m]
};

/// Where a body is at time t [s].
using Motion = std::function<Pose(double t)>;

/// Where what is at the place `x` [m] at `t0` is at `t1` [s], after or before it. A smooth map without folds, asked for
/// places in the body and around it; where `t1` is `t0`, `x`.
using Deformation = std::function<Vec3(const Vec3& x, double t0, double t1)>;

/// A length at each place [m], positive and finite; a pure function, which several threads may ask.
using LocalSize = std::function<double(const Vec3& x)>;

/// The prism layer asked for at a body's surface; the k-th prism of a column, from 0, is
/// first_height * growth^k high.
struct LayerOptions {
    enum class Side { outside, inside, both };  // in the surroundings, in the body, or a layer each

    int count = 4;               // prisms per column, at least 1
    double first_height = 2e-5;  // [m] of the prism at the wall, positive
    double growth = 1.3;         // [-] from one prism of a column to the next, positive
    Side side = Side::outside;
    std::optional<double> min_gap = {};  // [m] least distance from the body to a wall or to another body
                                         //   at which the layer is kept; none: first_height
};

/// The height of an unsqueezed column [m]; may be infinite.
[[nodiscard]] double thickness(const LayerOptions& layer);
[[nodiscard]] inline double least_gap(const LayerOptions& layer) {
    return layer.min_gap.value_or(layer.first_height);
}
[[nodiscard]] inline bool has_outside(const LayerOptions& layer) {
    return layer.side != LayerOptions::Side::inside;
}
[[nodiscard]] inline bool has_inside(const LayerOptions& layer) {
    return layer.side != LayerOptions::Side::outside;
}

/// Cosine of an angle between normals, 75 degrees, that no smooth surface has for want of triangles. Chosen.
inline constexpr double blunt = 0.25;

struct Body {
    std::string name;
    Shape shape;  // at t = 0 with the motion's displacement not yet applied
    Motion motion = [](double) { return Pose{}; };
    std::optional<LayerOptions> layer = {};          // of prisms at its surface; none: tets on both sides
    std::optional<double> size = {};                 // [m] target edge length at its surface; none: size.surface
    LocalSize local_size = {};                       // with `size`, which is the most: what places of its surface have, wherever
                                                     //   it is; none: `size` everywhere
    Deformation deformation = {};  // none: it moves rigidly. Else its surface goes with it, motion is not asked, and of a
                                   //   moving mesh's domain `shape` is what the mesh has at its time
    bool keeps_volume = false;     // as it deforms, by an even shift along the normals of its surface
    double sharp = blunt;          // as it deforms, cosine of the angle between normals beyond which edges of it are kept;
                                   //   `keep_edges` (solids.h) finds it for a shape
    unsigned pinned = 0;           // faces of the box, a bit each, along which the line does not move in which it ends there
};

/// What size.growth counts for at most: beyond, neighbouring cells differ so much that some cannot keep an R/r
/// of 10. Nine random coarse meshes that could not be made with 0.66 to 1 all could with this, by three seeds each.
inline constexpr double steepest_growth = 0.5;

/// The target edge length at distance R from the nearest body, or from its shell inside of it: min(far,
/// surface + growth * R), with a growth of at most `steepest_growth`; and nowhere more than `largest_size`. In a gap
/// between bodies without layers, or between one and a wall, it falls with the width, `gap_share` of it, down to `least`,
/// once one of them is narrower than `narrow_gap` (Snapshot::narrow). `surface` may differ from place to place: at a body's
/// nearest place it is `local`, but from `least` to `surface`. It should rise by no more than `steepest_growth` per metre.
struct SizeField {
    double surface = 2e-4;  // [m]
    double growth = 0.1;    // [-] rise per metre of distance, 0 ... 1
    double far = 8e-4;      // [m], at least surface
    std::optional<double> least = {};  // [m], at most surface; none: a twentieth of it
    LocalSize local = {};              // none: `surface` everywhere
};
[[nodiscard]] inline double least_size(const SizeField& size) { return size.least.value_or(size.surface / 20); }
/// Target size by width of a gap: one cell across, its edges along the gap half as long again as the gap is wide.
inline constexpr double gap_share = 1.5;
/// And by width of a neck of a body that deforms: six edges around it.
inline constexpr double neck_share = 0.5;
/// [surface sizes] wider gaps are left as they are: the engine finds cells for them, at smaller changes.
inline constexpr double narrow_gap = 0.3;

/// Among walls, which are the faces of the box, 0 ... 5, the number of what Domain::walls holds.
inline constexpr int fixed_walls = box_faces;

/// What is meshed: body i is region i + 1, the rest of the box is region 0.
struct Domain {
    Box box;
    std::vector<Body> bodies;
    SizeField size;
    std::shared_ptr<const TriangleTree> walls = {};  // fixed ones beside the box's faces, of a mesh from elsewhere
                                                     //   (of_mesh.h); none in a mesh of generate_mesh
};

[[nodiscard]] inline Region region_of_body(std::size_t body) { return Region(body + 1); }

/// The body as it stands at time t.
[[nodiscard]] Shape shape_at(const Body& body, double t);

struct BodyTree;  // body_tree.h

/// The domain frozen at one time: shapes in place, ready for many questions about distance and size.
struct Snapshot {
    Box box;
    SizeField size;
    std::vector<Shape> shapes;
    std::vector<std::optional<LayerOptions>> layers = {};  // per body
    bool narrow = false;                                   // target sizes fall in gaps
    std::shared_ptr<const TriangleTree> walls = {};
    std::vector<std::optional<double>> sizes = {};  // per body: its own at its surface [m]
    std::vector<LocalSize> local_sizes = {};        // per body; none where its size is one
    double local_slope = 0;                         // [-] by how much these rise per metre, at most
    std::shared_ptr<const BodyTree> tree = {};      // of `shapes`, by which many are asked fast; none: all are asked
};
[[nodiscard]] Snapshot snapshot(const Domain& domain, double t);

/// The distance from x to the nearest body's surface [m], from either side; infinite without bodies.
[[nodiscard]] double distance_to_bodies(const Snapshot& at, const Vec3& x);
/// The edge length asked for at the surface of a body [m]: its own, else size.surface.
[[nodiscard]] double asked_size(const Snapshot& at, std::size_t body);
[[nodiscard]] double asked_size(const Domain& domain, std::size_t body);
/// The edge length wanted on the surface of a body and on its shells [m]: as asked; or less where its
/// layer ends in so thin a prism, as asked, that the first tets on triangles of that size would be more than
/// twice as large, by the cube roots of their volumes.
[[nodiscard]] double surface_size(const Snapshot& at, std::size_t body);
/// The same at the place of its surface that is nearest to x, which is less where sizes are local.
[[nodiscard]] double surface_size(const Snapshot& at, std::size_t body, const Vec3& x);
[[nodiscard]] inline bool has_local_size(const Snapshot& at, std::size_t body) {
    return body < at.local_sizes.size() && at.local_sizes[body];
}
/// How much the target size may rise per metre [-].
[[nodiscard]] inline double size_slope(const Snapshot& at) { return at.size.growth + at.local_slope; }
/// The largest target size in the box [m]: size.far, or less where the box is so thin that cells of that size
/// would reach from one wall to the opposite one.
[[nodiscard]] double largest_size(const Box& box, const SizeField& size);
/// Is a gap narrower than `narrow_gap`, of those that sizes may fall in?
[[nodiscard]] bool has_narrow_gap(const Snapshot& at);
/// Per body: may a gap at it ask for smaller triangles than it has? Told by the boxes that hold bodies.
[[nodiscard]] std::vector<char> are_in_gaps(const Snapshot& at);
/// The width of the gap at x [m]: from the nearest wall or surface of a body without a layer to the next nearest; within
/// such a body, that at the point of its surface nearest to x. Infinite where there are no two, or within a layered body.
[[nodiscard]] double gap_width(const Snapshot& at, const Vec3& x);
/// The target edge length at x [m]: the least that SizeField gives for a body at its surface_size, and in gaps.
[[nodiscard]] double target_size(const Snapshot& at, const Vec3& x);

/// How far at most the vertices of a body's surface stand outside of its shape [m], so that the polyhedron
/// has the body's volume (generate.h), at triangles of edge length `size` [m]; not at all of a surface of triangles.
[[nodiscard]] double outward_shift(const Shape& shape, double size);

/// What keeps size.surface from being larger.
struct SizeLimit {
    double most;      // [m]; infinite if nothing does
    std::string why;  // what asks for it: "body "a" is 0.0625 m from the wall y min, too close"
};
/// Gaps of fewer surface sizes than this are too narrow for the initial mesh: R/r = 7 for a tet across on an
/// equilateral triangle.
inline constexpr double least_gap_in_sizes = 0.25;
/// The gap, in surface sizes, in which a flat tet on an equilateral triangle of one surface size is as bad as
/// the limit of R/r; in narrower ones the engine has to find smaller cells, and may not.
[[nodiscard]] double doubtful_gap(double max_aspect_ratio);
/// The least of what the bodies' radii of curvature, and their gaps to each other and to the walls at time t,
/// allow where a gap has to hold `least_gap` sizes between the bodies' polyhedra. Limits above size.surface
/// may be left out. Throws DomainError if a body is outside the box, touches a wall, or overlaps another.
[[nodiscard]] SizeLimit surface_limit(const Domain& domain, double t, double least_gap);
/// ", too close for size.surface = 0.0002 m; at most 4.1e-05 m would do"
[[nodiscard]] std::string too_coarse(const SizeLimit& limit, double surface_size);

/// Throws DomainError, saying what is in the way, where, the distance found and the size that would do for
/// all bodies, if at time t a body is outside the box, or two bodies overlap, or size.surface is above
/// `surface_limit`, or a body of triangles, or a slot in it, is too thin for size.least.
void check_placement(const Domain& domain, double t, double least_gap);

/// The thickness [m] of the largest layer that is not squeezed anywhere, at time t: a third of the least gap
/// to a wall or another body, less between layers; inside, half of the least radius of curvature. The body
/// has a layer.
[[nodiscard]] double room_for_layer(const Domain& domain, std::size_t body, double t);
/// The largest growth at which the layer is no thicker than `room` [m]; 0 if there is none.
[[nodiscard]] double fitting_growth(LayerOptions layer, double room);

/// Throws DomainError if a body's layer is of no height or overflows, or if at time t it is thicker, as
/// asked, than the gap to a wall or to another body with its layer, or than the body's curvature allows
/// inside, or a gap is below `least_gap(layer)`; says which body, the gap, and the largest thickness, first
/// height and growth that would fit. Also if there are more layers than patches for them (13). In gaps that
/// are wider than that a layer may have to be thinner than asked: layer_room.h.
void check_layers(const Domain& domain, double t);

}  // namespace kropla
