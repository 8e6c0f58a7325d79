#pragma once

#include "simulate/elements.h"
#include <kropla/simulate/heat.h>

namespace kropla {

/// All that a cell needs to know of the step.
struct HeatStep {
    const Mesh& before;
    const Mesh& current;
    const HeatOptions& options;
    const Array<Vertex, double>& old_temperature;
    Array<Region, Array<Vertex, double>> potential;  // of the flow of material at rest [m^2/s], or empty
    Array<Region, Array<Vertex, Vec3>> carried;      // where a body's vertices came from [m], or empty
    Array<Region, Array<Vertex, double>> source;     // its mean at the region's vertices [W/m^3], or empty
    double dt;                                       // [s]
};

/// What a cell adds to the rows of its corners: the row i of its matrix A on values T is
///     row_sum[i] T_i + sum over j of matrix[i][j] (T_j - T_i).
/// Heat that is conducted is in the second part alone: of a constant it makes exactly nothing.
template <std::size_t n>
struct CellSystem {
    std::array<std::array<double, n>, n> matrix = {};  // [J/K] A off its diagonal; what is on it is of no matter
    std::array<double, n> row_sum = {};                // [J/K] of A
    std::array<double, n> held = {};                   // [J/K] of it, by the mass that is there
    std::array<double, n> right = {};                  // [J]
};

/// A T - b of the cell.
template <std::size_t n>
[[nodiscard]] std::array<double, n> gained(const CellSystem<n>& system, const std::array<double, n>& temperature) {
    std::array<double, n> sum;
    for (std::size_t i = 0; i < n; ++i) {
        sum[i] = system.row_sum[i] * temperature[i] - system.right[i];
        for (std::size_t j = 0; j < n; ++j)
            sum[i] += system.matrix[i][j] * (temperature[j] - temperature[i]);
    }
    return sum;
}

/// The cell's part of the system derived in heat.h.
[[nodiscard]] CellSystem<4> cell_system(const HeatStep& step, Tet t);
[[nodiscard]] CellSystem<6> cell_system(const HeatStep& step, const Prism& prism);

}  // namespace kropla
