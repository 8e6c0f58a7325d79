#pragma once

#include "base/tetrahedron.h"
#include <kropla/mesh/mesh.h>

#include <algorithm>
#include <span>

namespace kropla {

/// The corners of four cells from the `first` on, at `places`; past the last cell, that one again.
[[nodiscard]] inline FourPlaces four_cells(std::span<const Tet> cells, const Mesh& mesh, std::size_t first,
                                           const Array<Vertex, Vec3>& places) {
    FourPlaces tets;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& v = mesh.tets[cells[std::min(first + i, cells.size() - 1)]];
        for (std::size_t k = 0; k < 4; ++k) tets[i][k] = &places[v[k]];
    }
    return tets;
}

}  // namespace kropla
