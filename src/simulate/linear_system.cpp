#include "simulate/linear_system.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

std::size_t local(const LinearSystem& system, int row) {
    return static_cast<std::size_t>(row - system.first_row);
}

bool owns(const LinearSystem& system, int row) {
    return row >= system.first_row && row < system.first_row + system.rows();
}

/// Rows that are coupled, in compressed rows: begin[r] ... begin[r + 1] - 1 in `column`.
struct Couplings {
    std::vector<PetscInt> begin, column;
};

/// Per owned row the rows it is coupled to, itself among them, in no order, with repetitions.
Couplings repeated_couplings(const Mesh& mesh, const Cells& cells, const Numbering& numbering, int first,
                             int rows) {
    const auto for_each_row = [&](const auto& visit) {
        for_each_cell(cells, [&](const auto& cell) {
            const auto vertices = cell_vertices(mesh, cell);
            for (Vertex a : vertices) {
                const int r = numbering.row[a] - first;
                if (r >= 0 && r < rows) visit(static_cast<std::size_t>(r), vertices);
            }
        });
    };
    Couplings all{std::vector<PetscInt>(static_cast<std::size_t>(rows) + 1, 0), {}};
    for_each_row([&](std::size_t r, const auto& vertices) {
        all.begin[r + 1] += static_cast<PetscInt>(vertices.size());
    });
    for (std::size_t r = 1; r < all.begin.size(); ++r) all.begin[r] += all.begin[r - 1];
    all.column.resize(static_cast<std::size_t>(all.begin.back()));
    std::vector<PetscInt> next(all.begin.begin(), all.begin.end() - 1);
    for_each_row([&](std::size_t r, const auto& vertices) {
        for (Vertex b : vertices) all.column[static_cast<std::size_t>(next[r]++)] = numbering.row[b];
    });
    return all;
}

/// In order, and each once.
Couplings couplings(Couplings all) {
    PetscInt kept = 0;
    for (std::size_t r = 0; r + 1 < all.begin.size(); ++r) {
        const auto first = all.column.begin() + all.begin[r], last = all.column.begin() + all.begin[r + 1];
        std::sort(first, last);
        const auto end = std::copy(first, std::unique(first, last), all.column.begin() + kept);
        all.begin[r] = kept;
        kept = static_cast<PetscInt>(end - all.column.begin());
    }
    all.begin.back() = kept;
    all.column.resize(static_cast<std::size_t>(kept));
    return all;
}

}  // namespace

LinearSystem empty_system(const Mesh& mesh, const Cells& cells, const Numbering& numbering, int rank) {
    const auto k = static_cast<std::size_t>(rank);
    LinearSystem system;
    system.first_row = numbering.first_row[k];
    const int rows = numbering.first_row[k + 1] - system.first_row;
    Couplings coupled = couplings(repeated_couplings(mesh, cells, numbering, system.first_row, rows));
    system.begin = std::move(coupled.begin);
    system.column = std::move(coupled.column);
    system.value.assign(system.column.size(), 0.0);
    for (auto* per_row : {&system.row_sum, &system.right, &system.guess, &system.negligible, &system.held})
        per_row->assign(static_cast<std::size_t>(rows), 0.0);
    return system;
}

void add_to(LinearSystem& system, const Numbering& numbering, std::span<const Vertex> vertices,
            const double* matrix) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const int row = numbering.row[vertices[i]];
        if (!owns(system, row)) continue;
        const std::size_t r = local(system, row);
        const PetscInt* const first = system.column.data() + system.begin[r];
        const PetscInt* const last = system.column.data() + system.begin[r + 1];
        for (std::size_t j = 0; j < vertices.size(); ++j) {
            if (j == i) continue;
            const PetscInt* const place = std::lower_bound(first, last, numbering.row[vertices[j]]);
            system.value[static_cast<std::size_t>(place - system.column.data())] +=
                matrix[i * vertices.size() + j];
        }
    }
}

void add_to_right(LinearSystem& system, int row, double value) {
    if (owns(system, row)) system.right[local(system, row)] += value;
}

void add_to_row_sum(LinearSystem& system, int row, double value) {
    if (owns(system, row)) system.row_sum[local(system, row)] += value;
}

void add_to_negligible(LinearSystem& system, int row, double value) {
    if (owns(system, row)) system.negligible[local(system, row)] += value;
}

void add_to_held(LinearSystem& system, int row, double value) {
    if (owns(system, row)) system.held[local(system, row)] += value;
}

double row_size(const LinearSystem& system, std::size_t owned_row) {
    double size = std::abs(system.row_sum[owned_row]);
    for (PetscInt k = system.begin[owned_row]; k < system.begin[owned_row + 1]; ++k)
        size += std::abs(system.value[static_cast<std::size_t>(k)]);
    return size;
}

void fix_unknown(LinearSystem& system, int row, double value) {
    system.closed = false;
    if (!owns(system, row)) return;
    const std::size_t r = local(system, row);
    system.row_sum[r] = system.held[r] = row_size(system, r);
    system.right[r] = system.row_sum[r] * value;
    system.guess[r] = value;
    std::fill(system.value.begin() + system.begin[r], system.value.begin() + system.begin[r + 1], 0.0);
}

}  // namespace kropla
