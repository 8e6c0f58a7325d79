#include "simulate/flow_scales.h"

#include "simulate/assembly.h"

#include <array>
#include <cmath>

namespace kropla {
namespace {

constexpr int many_vertices = 60000;  // where multigrid becomes cheaper than incomplete factors, if nearly
constexpr double next_to_all = 0.95;  // [-] of the cells have rates of viscosity so many times
constexpr double viscous_share = 2;   // [-] the others; measured at Reynolds numbers of 0 and 100

/// Of a conduction-like matrix, what the pressure's preconditioner needs of a cell: in `matrix` that of the
/// Laplacian.
template <std::size_t n>
CellSystem<n> pressure_cell(const CellPoints<n>& points, double laplacian, double viscous) {
    CellSystem<n> system;
    for (std::size_t k = 0; k < points.size(); ++k)
        for (std::size_t i = 0; i < n; ++i) {
            system.held[i] += viscous * points[k].volume * shape_means<n>[k].value[i];
            for (std::size_t j = 0; j < n; ++j)
                system.matrix[i][j] += laplacian / points[k].volume *
                                       dot(points[k].volume_gradient[i], points[k].volume_gradient[j]);
        }
    return system;
}

}  // namespace

bool is_viscous(const Ranks& ranks, const Pattern& pattern, const FlowStage& stage) {
    if (pattern.numbering.rows() < many_vertices || !pattern.numbering.upper.empty()) return false;
    std::array<double, 2> mine = {0, 0}, all = {0, 0};  // cells, and those where viscosity rules
    for_each_cell(pattern.cells, [&](const auto& cell) {
        const FlowMaterial& material = stage.material[cell_region(stage.mesh, cell)];
        const auto vertices = cell_vertices(stage.mesh, cell);
        const double kinematic = mean_property(material.viscosity, material.viscosities, vertices) /
                                 mean_property(material.density, material.densities, vertices);
        const double length =
            std::cbrt(total_volume(cell_points(corners(stage.position, stage.mesh, cell))));
        mine[0] += 1;
        if (kinematic / (length * length) > viscous_share * (stage.per_time + crossing_rates(stage, cell).going))
            mine[1] += 1;
    });
    MPI_Allreduce(mine.data(), all.data(), 2, MPI_DOUBLE, MPI_SUM, ranks.communicator);
    return all[1] > next_to_all * all[0];
}

PressureScales pressure_scales(const Ranks& ranks, const Pattern& pattern, const FlowStage& stage) {
    CellSystems systems;
    ask_cells(
        pattern.cells,
        [&](const auto& cell) {
            const FlowMaterial& material = stage.material[cell_region(stage.mesh, cell)];
            const auto vertices = cell_vertices(stage.mesh, cell);
            const double density = mean_property(material.density, material.densities, vertices),
                         viscosity = mean_property(material.viscosity, material.viscosities, vertices);
            const double laplacian = stage.per_time > 0 ? 1 / (density * stage.per_time) : 0;
            return pressure_cell(cell_points(corners(stage.position, stage.mesh, cell)), laplacian,
                                 1 / viscosity);
        },
        [](const auto&) { return true; }, systems, ranks.watch);
    LinearSystem sums(pattern.rows);
    add_cells(pattern, systems, sums);
    return {std::move(sums.value), std::move(sums.held)};
}

}  // namespace kropla
