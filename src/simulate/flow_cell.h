#pragma once

#include "simulate/block_system.h"
#include "simulate/elements.h"
#include <kropla/simulate/flow.h>

namespace kropla {

/// What acts in a liquid or gas.
struct FlowMaterial {
    double density = 0, viscosity = 0;           // where they do not depend on the temperature
    Array<Vertex, double> densities, viscosities;  // at vertices, where they do
    Array<Vertex, double> density_rate;          // [kg/(m^3 s)] at vertices, as they move; empty: zero
    Array<Vertex, Vec3> force;                   // [N/m^3] at vertices, besides gravity; empty: none
};

/// Of a cell: a constant, or the mean of values at vertices, if there are any.
template <std::size_t n>
[[nodiscard]] double mean_property(double value, const Array<Vertex, double>& values, const std::array<Vertex, n>& vertices) {
    return values.empty() ? value : mean_of(at_corners(values, vertices));
}

/// When a stage is, as a share of the step, and its weight in the means over the step.
struct StageTime {
    double share, weight;
};

/// A stage of a step: all that a cell needs to know of it. Arrays that are empty are of zeros.
struct FlowStage {
    const Mesh& mesh;                          // for its connectivity
    const Array<Vertex, Vec3>& position;       // [m] at the stage's time
    const Array<Vertex, Vec3>& mesh_velocity;  // [m/s]
    const Array<Vertex, Vec3>& old;            // [m/s] from which the rate is reckoned, u* in flow.h
    const FlowState& guess;                    // about which the equations are taken as linear
    const Array<Region, FlowMaterial>& material;
    const std::array<bool, 6>& open;                            // faces
    const std::array<Array<Vertex, double>, 6>& open_pressure;  // [Pa]
    Vec3 gravity;                                               // [m/s^2]
    double per_time;                                            // [1/s] 1 / (gamma dt), or zero
    bool convection;
    const UpperSides& upper;  // where the pressure of a cell is in FlowState::within
};

/// The cell's part of the residual, rows of momentum [N] and of volume [m^3/s]; and of its derivative if it
/// is wanted.
void flow_cell(const FlowStage& stage, Tet t, bool derivative, CellBlocks<4>& blocks);
void flow_cell(const FlowStage& stage, const Prism& prism, bool derivative, CellBlocks<6>& blocks);

/// The residuals of four tets at once, to the same bits.
void flow_residuals(const FlowStage& stage, const std::array<Tet, 4>& tets, std::array<CellBlocks<4>, 4>& blocks);

/// What assemble_blocks is to ask.
struct FlowKernel {
    const FlowStage& stage;
    bool derivative;

    template <class Cell, std::size_t n>
    void operator()(const Cell& cell, CellBlocks<n>& blocks) const { flow_cell(stage, cell, derivative, blocks); }
    void operator()(const std::array<Tet, 4>& tets, std::array<CellBlocks<4>, 4>& blocks) const {
        flow_residuals(stage, tets, blocks);
    }
};

/// How many of its heights the flow crosses in a cell, per time [1/s]: as the cell goes with the mesh, and as if it stood.
struct CrossingRates {
    double going, standing;
};
[[nodiscard]] CrossingRates crossing_rates(const FlowStage& stage, Tet t);
[[nodiscard]] CrossingRates crossing_rates(const FlowStage& stage, const Prism& prism);

}  // namespace kropla
