#include "simulate/linear_system.h"

#include <algorithm>
#include <cmath>

namespace kropla {

SparseRows chain() {
    constexpr PetscInt count = 512;
    SparseRows rows;
    for (PetscInt r = 0; r < count; ++r) {
        for (PetscInt c = std::max<PetscInt>(r - 1, 0); c <= std::min<PetscInt>(r + 1, count - 1); ++c)
            rows.column.push_back(c);
        rows.begin.push_back(static_cast<PetscInt>(rows.column.size()));
    }
    return rows;
}

LinearSystem::LinearSystem(const SparseRows& sparse_rows) : rows(sparse_rows) {
    clear();
}

void LinearSystem::clear() {
    value.assign(rows.column.size(), 0.0);
    for (auto* per_row : {&row_sum, &right, &guess, &negligible, &held}) per_row->assign(rows.count(), 0.0);
    closed.assign(static_cast<std::size_t>(rows.pieces), 1);
}

double row_size(const LinearSystem& system, std::size_t owned_row) {
    double size = std::abs(system.row_sum[owned_row]);
    for (PetscInt k = system.rows.begin[owned_row]; k < system.rows.begin[owned_row + 1]; ++k)
        size += std::abs(system.value[static_cast<std::size_t>(k)]);
    return size;
}

void fix_unknown(LinearSystem& system, int row, double value) {
    system.closed[system.rows.piece_of(static_cast<std::size_t>(row))] = 0;
    if (!system.owns(row)) return;
    const std::size_t r = system.local(row);
    system.row_sum[r] = system.held[r] = row_size(system, r);
    system.right[r] = system.row_sum[r] * value;
    system.guess[r] = value;
    std::fill(system.value.begin() + system.rows.begin[r], system.value.begin() + system.rows.begin[r + 1], 0.0);
}

}  // namespace kropla
