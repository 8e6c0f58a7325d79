#pragma once

#include "simulate/block_system.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace kropla {

/// What a viscous flow's solver needs beside the matrix: the pressure's part of the inverse, see
/// flow_solver.cpp.
struct PressureScales {
    std::vector<double> value;  // of the Laplacian, a place for each of the pattern's rows.column [m^4 s/kg]
    std::vector<double> viscous;  // per owned row: integral of phi_i / mu [m^3/(Pa s)]
};

/// Solves J delta = -residual for corrections of a flow, J kept from one call of `take` to the next. Where no face is open
/// the pressure is known but for a constant, which stays as it is or drifts; the residual is to be balanced.
class FlowSolver {
public:
    /// `fixed`: block_size per global row, whether the unknown is given.
    FlowSolver(const Ranks& ranks, const BlockPattern& blocks, std::vector<char> fixed);
    ~FlowSolver();
    FlowSolver(const FlowSolver&) = delete;
    FlowSolver& operator=(const FlowSolver&) = delete;

    /// Where the matrix is to be assembled: BlockSystem::value.
    [[nodiscard]] std::span<double> values();
    /// Takes the matrix that is there now; its values are overwritten. With `scales`, for large time steps
    /// and Stokes flow.
    void take(const PressureScales* scales);
    [[nodiscard]] bool has_matrix() const;

    /// The size of what is left of the equations that are not given, each by the diagonal of the matrix:
    /// units are of no matter. Over all ranks.
    [[nodiscard]] double size(const std::vector<double>& residual) const;
    /// The same of what the terms of the residual are each by itself, by the last matrix: of `unknown`,
    /// block_size per global row. Below a share of this there is rounding.
    [[nodiscard]] double size_of_terms(const std::vector<double>& unknown) const;

    /// block_size per global row; where the unknown is given, zero. Throws SolverError if it does not
    /// converge.
    [[nodiscard]] std::vector<double> solve(const std::vector<double>& residual, double tolerance);
    [[nodiscard]] int iterations() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Sets up each solver that a flow may choose, for a small system, as `rehearse` (solver.h).
void rehearse_flow(const Ranks& this_rank);

}  // namespace kropla
