#pragma once

#include "simulate/assembly.h"
#include <kropla/simulate/heat.h>

#include <vector>

namespace kropla {

/// What a step was assembled from, and what came out.
struct Assembled {
    const Pattern& pattern;
    const CellSystems& systems;
    const std::vector<double>& diffusion;  // along each coupling of the pattern's rows, per unit of the difference
    const std::vector<double>& exchanged;  // along it: what the row got from the column, besides
    const Array<Vertex, double>& after;  // as it was solved for
};

/// What the cells at an owned row that are wanted gain at its vertex, and did not get from other vertices; and what
/// diffusion along edges brought from the columns that are wanted.
template <class CellWanted, class ColumnWanted>
[[nodiscard]] double gained_at(const Assembled& step, const Mesh& mesh, std::size_t row, const CellWanted& cell_wanted,
                               const ColumnWanted& column_wanted) {
    double sum = 0;
    const auto add = [&](const auto& at_rows, const auto& systems, const auto& cells) {
        for (const auto& at : at_rows.of(row)) {
            const auto& cell = cells[at.cell];
            if (cell_wanted(cell))
                sum += gained(systems[at.cell], at_corners(step.after, cell_vertices(mesh, cell)))[at.corner];
        }
    };
    add(step.pattern.tets, step.systems.tets, step.pattern.cells.tets);
    add(step.pattern.prisms, step.systems.prisms, step.pattern.cells.prisms);
    const SparseRows& rows = step.pattern.rows;
    const std::vector<Vertex>& vertex = step.pattern.numbering.vertex;
    const Vertex own = vertex[static_cast<std::size_t>(rows.first_row) + row];
    for (auto k = static_cast<std::size_t>(rows.begin[row]); k < static_cast<std::size_t>(rows.begin[row + 1]); ++k) {
        const Vertex other = vertex[static_cast<std::size_t>(rows.column[k])];
        if ((step.diffusion[k] != 0 || step.exchanged[k] != 0) && column_wanted(other))
            sum -= step.diffusion[k] * (step.after[other] - step.after[own]) + step.exchanged[k];
    }
    return sum;
}

/// What leaves each body, region 1 and on: the consistent flux of SurfaceFlux. The same on all ranks.
[[nodiscard]] std::vector<SurfaceFlux> surface_fluxes(const Ranks& ranks, const Mesh& mesh, const Assembled& step,
                                                      double dt);

}  // namespace kropla
