#pragma once

#include "adapt/adapt.h"
#include "adapt/star.h"
#include "mesh/numbering.h"

namespace kropla {

/// A part of the mesh that is moved as a whole: its cells and their vertices by numbers of its own, close
/// together in memory, with copies of their places. Nothing in the mesh changes before `write_places`. To be
/// kept from step to step: what it holds is used again.
struct Zone {
    std::vector<Tet> cells;
    std::vector<std::array<int, 4>> corners;  // per cell: numbers of its vertices
    std::vector<Vertex> vertices;
    std::vector<Vec3> start;                  // per vertex: its place in the mesh [m]
    std::vector<Vec3> place;                  // per vertex: where it is to go [m]
    std::vector<unsigned char> axes;          // per vertex: bits of the axes along which it may slide
    std::vector<double> size;                 // per vertex: the target size there [m]
    std::vector<int> ball_begin, ball;        // per vertex, and one more: where its cells stand in `ball`
    std::vector<double> ratio;                // per cell: its aspect ratio at `place`
    std::optional<std::size_t> turn;          // see has_turn
    Numbering<Vertex> number;                 // of `vertices`
    Numbering<Tet> cell_number;
};

/// Most cells and edges that could be better have been tried in vain before: those that have not become worse
/// are tried again by turns only, by their `name`; always if the zone has no `turn`.
[[nodiscard]] bool has_turn(const Zone& zone, int name);

/// Empties the zone.
void clear(Zone& zone);
/// Adds a vertex, which does not slide, if it is not in the zone; returns its number.
int add_held(Zone& zone, const Mesh& mesh, Vertex v);
/// Adds a cell and its vertices, if it is not in the zone. Vertices are held by the boundary that the zone's
/// cells have there.
void add_cell(Zone& zone, const Mesh& mesh, Tet t);
/// Once all cells are there: finds the balls. Vertices that have cells out of the zone, or lie on an
/// interface, are held.
void close(Zone& zone, const Mesh& mesh);

/// A zone of these cells (those that are alive).
void gather(Zone& zone, const Mesh& mesh, std::span<const Tet> cells);
/// Asks for the target sizes where the vertices are to go.
void find_sizes(Zone& zone, const Snapshot& at_time);

[[nodiscard]] double aspect_ratio(const Zone& zone, int cell);
[[nodiscard]] double start_ratio(const Zone& zone, int cell);  // its aspect ratio in the mesh
void star_of_ball(const Zone& zone, int vertex, std::vector<StarFacet>& star);
[[nodiscard]] Freedom freedom(const Zone& zone, int vertex);

/// Moves vertices: `place` and `ratio` change. `size` is set. Returns how many were moved for the worst
/// cells.
int optimise_places(Zone& zone, const AdaptOptions& options);
/// Asks for the aspect ratios of all cells.
void measure(Zone& zone);
[[nodiscard]] double safe_fraction(const Zone& zone, int cell, double least);

/// As for cells: see adapt.h. The zone's places are those of the mesh.
Changes adapt_to_size(Mesh& mesh, const Zone& zone, const Snapshot& at_time, const AdaptOptions& options);
void write_places(const Zone& zone, Mesh& mesh);

}  // namespace kropla
