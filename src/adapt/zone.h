#pragma once

#include "adapt/adapt.h"
#include "adapt/star.h"
#include "base/tetrahedron.h"
#include "mesh/index_set.h"
#include "mesh/numbering.h"

namespace kropla {

/// A part of the mesh that is moved as a whole: its cells and their vertices by numbers of its own, close
/// together in memory, with copies of their places. Nothing in the mesh changes before `write_places`. To be
/// kept from step to step: what it holds is used again.
struct Zone {
    IndexSet<Tet> holds;
    std::vector<Tet> cells;                   // the same, in ascending order
    std::vector<std::array<int, 4>> corners;  // per cell: numbers of its vertices
    std::vector<Vertex> vertices;
    std::vector<Vec3> start;                  // per vertex: its place in the mesh [m]
    std::vector<Vec3> place;                  // per vertex: where it is to go [m]
    std::vector<unsigned char> axes;          // per vertex: bits of the axes along which it may slide
    std::vector<double> size;                 // per vertex: the target size there [m]
    std::vector<int> ball_begin, ball;        // per vertex, and one more: where its cells stand in `ball`
    std::vector<double> ratio;                // per cell: its aspect ratio at `place`
    Numbering<Vertex> number;                 // of `vertices`
};

/// A zone is made in this order: it is emptied; vertices are added that do not slide, with the numbers 0, 1, ...;
/// `holds` is filled; then it is closed.
void clear(Zone& zone);
void add_held(Zone& zone, const Mesh& mesh, Vertex v);
/// Numbers the vertices and finds the balls. Vertices stay on the faces of the box they lie on; those that have
/// cells out of the zone, or lie on an interface, are held.
void close(Zone& zone, const Mesh& mesh);

/// A zone of these cells (those that are alive).
void gather(Zone& zone, const Mesh& mesh, std::span<const Tet> cells);
/// Asks for the target sizes where the vertices are to go.
void find_sizes(Zone& zone, const Snapshot& at_time);

[[nodiscard]] double aspect_ratio(const Zone& zone, int cell);
/// The corners of four cells from the `first` on, at `places`, one per vertex; past the last cell, that one again.
[[nodiscard]] FourPlaces four_cells(const Zone& zone, std::size_t first, const std::vector<Vec3>& places);
void star_of_ball(const Zone& zone, int vertex, std::vector<StarFacet>& star);
[[nodiscard]] Freedom freedom(const Zone& zone, int vertex);

/// Moves vertices: `place` and `ratio` change. `size` is set. Returns how many were moved for the worst
/// cells.
int optimise_places(Zone& zone, const AdaptOptions& options);
/// Asks for the aspect ratios of all cells.
void measure(Zone& zone);
/// Do all cells keep a volume of at least `least` of what they have, all the way from `start` to `place`?
[[nodiscard]] MoveReport check_way(const Zone& zone, double least);

/// As for cells: see adapt.h. The zone's places are those of the mesh.
Changes adapt_to_size(Mesh& mesh, const Zone& zone, const Snapshot& at_time, const AdaptOptions& options);
void write_places(const Zone& zone, Mesh& mesh);

}  // namespace kropla
