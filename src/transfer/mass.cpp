// The mass matrix of linear tets: a cell of volume V adds V/20 (1 + delta_ij).
//   [Wathen 1987] Realistic eigenvalue bounds for the Galerkin mass matrix. IMA J. Numer. Anal. 7: scaled by
//   its
//     diagonal its eigenvalues lie between 1/2 and 5/2, on any mesh, so that conjugate gradients need some 30
//     steps to rounding, fewer for small blocks.

#include "transfer/mass.h"

#include "base/tetrahedron.h"
#include <kropla/mesh/cells.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kropla {
namespace {

constexpr int most_iterations = 80;
constexpr double rounding = 1e-15;  // [-] of the right side's norm

double volume_of(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return tet_volume(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]);
}

void number_unknowns(const Mesh& after, const SlotMap& held, MassBlock& block) {
    SlotMap number(block.cells.size() / 2);
    for (MassCell& cell : block.cells)
        for (std::size_t k = 0; k < 4; ++k) {
            const Vertex v = after.tets[cell.tet][k];
            cell.unknown[k] = -1;
            if (held.contains(v.value) || after.layer_at[v].exists()) continue;
            cell.unknown[k] = number.insert(v.value, static_cast<std::int32_t>(block.free.size()));
            if (static_cast<std::size_t>(cell.unknown[k]) == block.free.size()) {
                block.free.push_back(v);
                block.mass.push_back(0);
            }
            block.mass[static_cast<std::size_t>(cell.unknown[k])] += cell.volume / 4;
        }
}

/// The cells of the block at each of its free vertices.
struct CellsAtFree {
    std::vector<std::uint32_t> end;   // per free vertex
    std::vector<std::int32_t> cells;  // places in MassBlock::cells
};

CellsAtFree cells_at_free(const MassBlock& block) {
    CellsAtFree at;
    at.end.assign(block.free.size(), 0);
    const auto for_each = [&](const auto& visit) {
        for (std::size_t c = 0; c < block.cells.size(); ++c)
            for (std::int32_t u : block.cells[c].unknown)
                if (u >= 0) visit(static_cast<std::size_t>(u), static_cast<std::int32_t>(c));
    };
    for_each([&](std::size_t u, std::int32_t) { ++at.end[u]; });
    std::exclusive_scan(at.end.begin(), at.end.end(), at.end.begin(), 0u);
    at.cells.resize(4 * block.cells.size());
    for_each([&](std::size_t u, std::int32_t c) { at.cells[at.end[u]++] = c; });
    return at;
}

MassRows mass_rows(const MassBlock& block) {
    MassRows rows;
    const CellsAtFree at = cells_at_free(block);
    std::vector<std::size_t> behind(block.free.size(), 0);  // the column's place, if that is in this row
    std::size_t c = 0;
    for (std::size_t row = 0; row < block.free.size(); ++row) {
        const std::size_t first = rows.column.size();
        for (; c < at.end[row]; ++c) {
            const MassCell& cell = block.cells[static_cast<std::size_t>(at.cells[c])];
            for (std::int32_t u : cell.unknown) {
                if (u < 0 || static_cast<std::size_t>(u) == row) continue;
                std::size_t& p = behind[static_cast<std::size_t>(u)];
                if (p <= first) {
                    rows.column.push_back(u);
                    rows.value.push_back(0);
                    p = rows.column.size();
                }
                rows.value[p - 1] += cell.volume / 20;
            }
        }
        rows.end.push_back(static_cast<std::uint32_t>(rows.column.size()));
    }
    return rows;
}

/// y = M x
void multiply(const MassBlock& block, const std::vector<double>& x, std::vector<double>& y) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        double sum = 0.4 * block.mass[i] * x[i];
        for (; k < block.rows.end[i]; ++k)
            sum += block.rows.value[k] * x[static_cast<std::size_t>(block.rows.column[k])];
        y[i] = sum;
    }
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

SlotMap places_of(std::span<const Tet> tets) {
    SlotMap places(tets.size());
    for (std::size_t i = 0; i < tets.size(); ++i) places.insert(tets[i].value, static_cast<std::int32_t>(i));
    return places;
}

MassBlock mass_block(const Mesh& before, const Mesh& after, const ChangedCells& changed, const SlotMap& come,
                     const Clusters& clusters, std::size_t cluster) {
    MassBlock block;
    for (Tet t : clusters.cells(cluster))
        block.cells.push_back({t, come.find(t.value), volume_of(after, t), {}});
    for (std::int32_t place : clusters.gone(cluster)) {
        const Tet t = changed.gone[static_cast<std::size_t>(place)];
        block.gone.push_back({before.tets[t], volume_of(before, t)});
    }
    for (const MassCell& cell : block.cells)
        if (cell.come < 0) block.gone.push_back({after.tets[cell.tet], cell.volume});
    number_unknowns(after, held_vertices(after, clusters, cluster), block);
    block.rows = mass_rows(block);
    block.shape.assign(block.free.size(), 1);
    solve_mass(block, block.mass, block.shape);
    block.shape_mass = product(block.mass, block.shape);
    return block;
}

void solve_mass(const MassBlock& block, std::span<const double> right, std::vector<double>& x) {
    const std::size_t n = block.free.size();
    std::vector<double> residual(n), scaled(n), direction(n, 0), image(n);
    multiply(block, x, image);
    for (std::size_t i = 0; i < n; ++i) residual[i] = right[i] - image[i];
    const double norm = std::sqrt(std::inner_product(right.begin(), right.end(), right.begin(), 0.0));
    double old = 0;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        if (std::sqrt(product(residual, residual)) <= rounding * norm) break;
        for (std::size_t i = 0; i < n; ++i) scaled[i] = residual[i] / block.mass[i];
        const double now = product(residual, scaled), turn = iteration == 0 ? 0 : now / old;
        for (std::size_t i = 0; i < n; ++i) direction[i] = scaled[i] + turn * direction[i];
        multiply(block, direction, image);
        const double along = product(direction, image);
        if (!(along > 0)) break;
        const double length = now / along;
        for (std::size_t i = 0; i < n; ++i) {
            x[i] += length * direction[i];
            residual[i] -= length * image[i];
        }
        old = now;
    }
}

}  // namespace kropla
