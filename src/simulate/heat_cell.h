#pragma once

#include "simulate/elements.h"
#include "simulate/heat.h"

namespace kropla {

/// All that a cell needs to know of the step.
struct HeatStep {
    const Mesh& before;
    const Mesh& current;
    const HeatOptions& options;
    const Array<Vertex, double>& old_temperature;
    Array<Region, Array<Vertex, double>> potential;  // of the flow of material at rest [m^2/s], or empty
    Array<Region, Array<Vertex, Vec3>> carried;      // where a body's vertices came from [m], or empty
    Array<Region, Array<Vertex, double>> source;     // at the region's vertices [W/m^3], or empty
    double dt;                                       // [s]
};

/// What a cell adds to the rows of its corners.
template <std::size_t n>
struct CellSystem {
    std::array<std::array<double, n>, n> matrix = {};  // [J/K]
    std::array<double, n> right = {};                  // [J]
};

/// The cell's part of the system derived in heat.h.
[[nodiscard]] CellSystem<4> cell_system(const HeatStep& step, Tet t);
[[nodiscard]] CellSystem<6> cell_system(const HeatStep& step, const Prism& prism);

}  // namespace kropla
