#pragma once

#include <kropla/adapt/adapt.h>
#include "adapt/star.h"
#include "base/tetrahedron.h"
#include "mesh/index_set.h"

namespace kropla {

/// What a cell does to its vertices where volumes are equalised: its centroid [m] times its weight, and its weight.
struct Pull {
    Vec3 moment;
    double weight;
};

/// A part of the surroundings that is moved as a whole, with the cells beyond it whose target size changes, and what its motion asks for again and again. Nothing in the
/// mesh changes before `write_places`. To be kept from step to step: `follow` brings it up to date, and looks again
/// only at what was replaced. Arrays are at least as long as the mesh's and hold something where the zone is.
struct Zone {
    IndexSet<Tet> holds;
    IndexSet<Vertex> has;                  // the vertices of these cells
    Array<Vertex, std::vector<Tet>> ball;  // the cells of the zone at a vertex, in ascending order
    Array<Vertex, unsigned char> axes;     // bits of the axes along which the vertex may slide, and `rim`

    // Of a step: what moves in it.
    std::vector<Vertex> bodies;            // vertices that move with a body
    std::vector<Vertex> vertices;          // of all cells, in ascending order
    std::vector<Tet> cells;                // with a vertex that moves, in ascending order
    std::vector<Tet> beyond;               // of which no vertex moves, but the target size changes, likewise
    Array<Vertex, unsigned char> moves;    // whether a vertex takes part: 0, by_itself, with_body, or by_size
    Array<Vertex, Vec3> place;             // where it is to go [m]
    Array<Vertex, double> size;            // the target size there [m]
    Array<Tet, double> ratio;              // of a cell of `cells`: its aspect ratio at `place`
    Array<Tet, Pull> pull;                 // room for optimise_places

    static constexpr unsigned char all_axes = 7, rim = 8;  // rim: some of its cells are not in the zone
    static constexpr unsigned char by_itself = 1, with_body = 2, by_size = 4;  // by_size: it does not move
};

/// Takes cells of one region in. Their vertices stay on the faces of the box they lie on; those that have cells out
/// of the zone, or lie on an interface or another patch, are held.
void add_cells(Zone& zone, const Mesh& mesh, std::span<const Tet> cells);
/// The slots of `replaced` have lost their cells or have others, which join the zone if they are of the surroundings.
/// The mesh may have fewer slots than before.
void follow(Zone& zone, const Mesh& mesh, const IndexSet<Tet>& replaced);
/// Leaves out all cells but those listed in `cells` and `beyond`.
void shrink(Zone& zone, const Mesh& mesh);
void clear(Zone& zone);

/// A zone of these cells (those that are alive), of which all vertices move that may.
void gather(Zone& zone, const Mesh& mesh, std::span<const Tet> cells);
/// Nothing moves.
void begin_motion(Zone& zone);
/// Lists the cells with a vertex that moves, and those beyond.
void list_cells(Zone& zone, const Mesh& mesh);
/// Asks for the target sizes where the vertices are to go.
void find_sizes(Zone& zone, const Snapshot& at_time);

/// The corners of four cells from the `first` on, at `places`; past the last cell, that one again.
[[nodiscard]] FourPlaces four_cells(std::span<const Tet> cells, const Mesh& mesh, std::size_t first,
                                    const Array<Vertex, Vec3>& places);
[[nodiscard]] double aspect_ratio(const Zone& zone, const Mesh& mesh, Tet t);
void star_of_ball(const Zone& zone, const Mesh& mesh, Vertex v, std::vector<StarFacet>& star);
/// Of a vertex, in a step: none if it does not move or is held.
[[nodiscard]] Freedom freedom(const Zone& zone, Vertex v);

/// The vertices of cells worse than `above` that may move, each once, in ascending order.
[[nodiscard]] std::vector<Vertex> vertices_of_worse(const Zone& zone, const Mesh& mesh, double above);

/// Moves vertices: `place` and `ratio` change. `size` is set. Returns the sweeps, and how many were moved for the worst
/// cells; nothing, and nothing is moved, if a cell is turned over or flat at `place`.
[[nodiscard]] std::optional<Changes> optimise_places(Zone& zone, const Mesh& mesh, const AdaptOptions& options);
/// Asks for the aspect ratios of all cells.
void measure(Zone& zone, const Mesh& mesh);
/// Do all cells keep a volume of at least `least` of what they have, all the way from `start` to `place`?
[[nodiscard]] MoveReport check_way(const Zone& zone, const Mesh& mesh, const Array<Vertex, Vec3>& start, double least);

/// As for cells: see adapt.h. The zone's places are those of the mesh. `tangled`: cells may be turned over.
Changes adapt_to_size(Mesh& mesh, const Zone& zone, const Snapshot& at_time, const AdaptOptions& options,
                      bool tangled = false);
void write_places(const Zone& zone, Mesh& mesh);

}  // namespace kropla
