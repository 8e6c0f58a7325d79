#include "simulate/assembly.h"

namespace kropla {
namespace {

template <std::size_t n>
void add_to_row(std::size_t row, const CellsAtRows<n>& at, const std::vector<CellSystem<n>>& systems,
                LinearSystem& system) {
    double* const value = system.value.data() + system.rows.begin[row];
    for (const CellAtRow<n>& cell : at.of(row)) {
        const CellSystem<n>& part = systems[cell.cell];
        const std::size_t i = cell.corner;
        for (std::size_t j = 0; j < n; ++j) value[cell.place[j]] += part.matrix[i][j];
        system.row_sum[row] += part.row_sum[i];
        system.held[row] += part.held[i];
        system.right[row] += part.right[i] + part.load[i];
    }
}

}  // namespace

void add_cells(const Pattern& pattern, const CellSystems& systems, LinearSystem& system) {
    for_all(pattern.rows.count(), [&](std::size_t row) {
        add_to_row(row, pattern.tets, systems.tets, system);
        add_to_row(row, pattern.prisms, systems.prisms, system);
    });
}

}  // namespace kropla
