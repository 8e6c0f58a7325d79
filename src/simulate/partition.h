#pragma once

#include "simulate/cells.h"

#include <vector>

namespace kropla {

/// At vertices of interfaces, the region of the higher number that meets another there; none elsewhere. Empty: nowhere.
using UpperSides = Array<Vertex, Region>;
/// Where regions of `cells` meet. Throws CaseError, with the place, where three do.
[[nodiscard]] UpperSides upper_sides(const Mesh& mesh, const Cells& cells);

/// Unknowns: a row per vertex, numbered along a space-filling curve, and the curve cut into equal pieces, one
/// per rank. The rows of rank r are first_row[r] ... first_row[r + 1] - 1. Depends on the mesh alone. Where there are
/// sides, vertices of interfaces have a further row, the next one, of what is once per side: that of the upper side.
struct Numbering {
    Array<Vertex, int> row;         // -1: the vertex has no unknown
    std::vector<Vertex> vertex;     // of each row
    std::vector<int> first_row;     // ranks + 1 entries
    UpperSides upper = {};          // empty: one row a vertex

    [[nodiscard]] int rows() const { return static_cast<int>(vertex.size()); }
    [[nodiscard]] bool is_upper(Vertex v, Region region) const { return !upper.empty() && upper[v] == region; }
    /// Of what is once per side: that of a cell of the region.
    [[nodiscard]] int row_at(Vertex v, Region region) const { return row[v] + (is_upper(v, region) ? 1 : 0); }
    [[nodiscard]] bool is_further(std::size_t r) const { return row[vertex[r]] != static_cast<int>(r); }
    [[nodiscard]] bool owns(int rank, int r) const {
        const auto k = static_cast<std::size_t>(rank);
        return first_row[k] <= r && r < first_row[k + 1];
    }
};

/// Numbers the vertices of `cells` (each alive) for so many ranks.
[[nodiscard]] Numbering number_vertices(const Mesh& mesh, const Cells& cells, int ranks, UpperSides upper = {});

/// Those of `cells` that have an unknown of the rank: what it assembles. Cells astride a cut are on both
/// lists, so that every rank fills its rows alone and in the same order, whatever the number of ranks.
[[nodiscard]] Cells cells_of_rank(const Mesh& mesh, const Cells& cells, const Numbering& numbering, int rank);

}  // namespace kropla
