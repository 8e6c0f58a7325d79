#pragma once

#include "mesh/mesh.h"

#include <vector>

namespace kropla {

/// Unknowns: a row per vertex, numbered along a space-filling curve, and the curve cut into equal pieces, one
/// per rank. The rows of rank r are first_row[r] ... first_row[r + 1] - 1. Depends on the mesh alone.
struct Numbering {
    Array<Vertex, int> row;         // -1: the vertex has no unknown
    std::vector<Vertex> vertex;     // of each row
    std::vector<int> first_row;     // ranks + 1 entries

    [[nodiscard]] int rows() const { return static_cast<int>(vertex.size()); }
    [[nodiscard]] bool owns(int rank, int r) const {
        const auto k = static_cast<std::size_t>(rank);
        return first_row[k] <= r && r < first_row[k + 1];
    }
};

/// Numbers the vertices of the tets of `cells` (each alive) for so many ranks.
[[nodiscard]] Numbering number_vertices(const Mesh& mesh, const std::vector<Tet>& cells, int ranks);

/// Those of `cells` that have an unknown of the rank: what it assembles. Cells astride a cut are on both
/// lists, so that every rank fills its rows alone and in the same order, whatever the number of ranks.
[[nodiscard]] std::vector<Tet> cells_of_rank(const Mesh& mesh, const std::vector<Tet>& cells,
                                             const Numbering& numbering, int rank);

}  // namespace kropla
