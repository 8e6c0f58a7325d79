#pragma once

#include <kropla/adapt/adapt.h>
#include "adapt/star.h"
#include "base/tetrahedron.h"
#include "domain/body_surface.h"
#include "mesh/index_set.h"

#include <algorithm>

namespace kropla {

/// A part of the surroundings, and of bodies that deform, that moves as a whole, as it is kept from step to step: its cells,
/// the balls of its vertices and along which axes they may slide. `follow` brings it up to date, and looks again only at what was replaced. Arrays
/// are at least as long as the mesh's and hold something where the zone is.
struct Zone {
    IndexSet<Tet> holds;
    IndexSet<Vertex> has;                  // the vertices of these cells
    Array<Vertex, std::vector<Tet>> ball;  // the cells of the zone at a vertex, in ascending order
    Array<Vertex, unsigned char> axes;     // bits of the axes along which the vertex may slide, and `rim`

    std::vector<Region> deforming;         // the bodies whose cells belong to it as the surroundings do

    static constexpr unsigned char all_axes = 7, rim = 8;  // rim: some of its cells are not in the zone
    [[nodiscard]] bool takes(Region region) const {
        return region == surroundings || std::ranges::find(deforming, region) != deforming.end();
    }
};

/// Takes cells in. Their vertices stay on the faces of the box they lie on; those that have cells out
/// of the zone, or lie on an interface or another patch, are held.
void add_cells(Zone& zone, const Mesh& mesh, std::span<const Tet> cells);
/// The slots of `replaced` have lost their cells or have others, which join the zone if it takes cells of their region.
/// The mesh may have fewer slots than before.
void follow(Zone& zone, const Mesh& mesh, const IndexSet<Tet>& replaced);
/// Leaves out all cells but these.
void shrink(Zone& zone, const Mesh& mesh, const IndexSet<Tet>& stay);

/// The centroid of a cell where volumes are equalised, times its weight [m], and its weight.
struct WeightedCentroid {
    Vec3 moment;
    double weight;
};

/// A motion of a zone's vertices, in one step: which take part, and where they go. Made by
/// `movable`, with cells listed and target sizes found. Nothing in the mesh changes before `write_places`. To be used
/// again and again, as its arrays are as long as the mesh's; they hold something where the zone is.
struct ZoneMotion {
    std::vector<Vertex> bodies;            // vertices that move with a body
    std::vector<Vertex> vertices;          // of the zone, in ascending order
    std::vector<Tet> cells;                // with a vertex that moves, in ascending order
    std::vector<Tet> beyond;               // of which no vertex moves, but the target size changes, likewise
    Array<Vertex, unsigned char> moves;    // whether a vertex takes part: 0, by_itself, with_body, or by_size
    Array<Vertex, Vec3> place;             // where it is to go [m]
    Array<Vertex, double> size;            // the target size there [m], before the places are optimised
    Array<Tet, double> ratio;              // of a cell of `cells`: its aspect ratio at `place`, once measured
    Array<Tet, WeightedCentroid> centroid; // room for optimise_places

    static constexpr unsigned char by_itself = 1, with_body = 2, by_size = 4;  // by_size: it does not move
};

/// Nothing moves: what the motion was of does not count any more.
void begin_motion(ZoneMotion& motion);

/// The zone of some cells, and the motion that leaves all its vertices where they are, free to move where they may.
struct MovableCells {
    Zone zone;
    ZoneMotion motion;
};
/// Of those cells that are alive, with target sizes as they are then; without, with sizes of 1.
[[nodiscard]] MovableCells movable(const Mesh& mesh, std::span<const Tet> cells, const Snapshot* at_time = nullptr);

/// How the surroundings follow the bodies: by their displacement, spread; or not at all, as in the paper, where they are
/// to be smoothed then.
enum class Follow { spread, rest };

struct MoveReport {
    bool arrived = false;  // else the mesh is as it was
    double fraction = 0;   // of the way that is safe for all cells
    Tet limiting;          // the cell that stopped it, if it did not arrive
};

/// The bodies of a mesh, as they are to be moved.
struct MovedBodies {
    std::vector<std::vector<Vertex>> vertices;  // per body: of its cells; of one that deforms, of its surface
    std::vector<BodySurface> deforming = {};
    Follow surroundings = Follow::spread;
    bool uneven = false;  // some have triangles that are smaller for the sake of a gap
};

/// Finds where bodies that go from their places at `t0` to those at `t1` [s] take the vertices of their surroundings, and
/// those within bodies that deform; nothing is moved yet. `zone` is empty or follows the mesh; it comes to hold what the
/// displacement reaches, and may hold more. What moved since the motion began still counts as moving.
void place_boundary(const Mesh& mesh, const Domain& domain, const MovedBodies& bodies, double t0, double t1, Zone& zone,
                    ZoneMotion& motion);
/// The same, and moves them there if every cell stays valid on the way; else tells how far it could go. Connectivity
/// is unchanged.
MoveReport move_boundary(Mesh& mesh, const Domain& domain, const MovedBodies& bodies, double t0, double t1, Zone& zone,
                         ZoneMotion& motion);

[[nodiscard]] double aspect_ratio(const ZoneMotion& motion, const Mesh& mesh, Tet t);
/// Of a vertex in the motion: none if it does not move by itself or is held.
[[nodiscard]] Freedom freedom(const Zone& zone, const ZoneMotion& motion, Vertex v);

/// Where its vertices are; and there again.
[[nodiscard]] std::vector<Vec3> places(const ZoneMotion& motion);
void put_back(ZoneMotion& motion, std::span<const Vec3> places);

/// The vertices of cells worse than `above` that may move, each once, in ascending order.
[[nodiscard]] std::vector<Vertex> vertices_of_worse(const Zone& zone, const ZoneMotion& motion, const Mesh& mesh,
                                                    double above);

/// Moves vertices: `place` and `ratio` change. Returns the sweeps, and how many were moved for the worst
/// cells; nothing, and nothing is moved, if a cell is turned over or flat at `place`.
[[nodiscard]] std::optional<Changes> optimise_places(const Zone& zone, ZoneMotion& motion, const Mesh& mesh,
                                                     const AdaptOptions& options);
/// Asks for the aspect ratios of all cells; of those at a vertex.
void measure(ZoneMotion& motion, const Mesh& mesh);
void measure_ball(const Zone& zone, ZoneMotion& motion, const Mesh& mesh, Vertex v);
/// Do all cells keep a volume of at least `least` of what they have, all the way from `start` to `place`?
[[nodiscard]] MoveReport check_way(const ZoneMotion& motion, const Mesh& mesh, const Array<Vertex, Vec3>& start,
                                   double least);

/// As for cells: see adapt.h. The motion's places are those of the mesh. `tangled`: cells may be turned over.
Changes adapt_to_size(Mesh& mesh, const Zone& zone, const ZoneMotion& motion, const Snapshot& at_time,
                      const AdaptOptions& options, bool tangled = false);
Changes swap_for_energy(Mesh& mesh, std::span<const Tet> cells, const AdaptOptions& options, bool tangled);
void write_places(const ZoneMotion& motion, Mesh& mesh);

// For place_boundary and movable.
/// Makes room for what the mesh has.
void fit(ZoneMotion& motion, const Mesh& mesh);
/// Lists the cells with a vertex that moves, and those beyond.
void list_cells(const Zone& zone, ZoneMotion& motion, const Mesh& mesh);
/// Asks for the target sizes where the vertices are to go.
void find_sizes(ZoneMotion& motion, const Snapshot& at_time);

}  // namespace kropla
