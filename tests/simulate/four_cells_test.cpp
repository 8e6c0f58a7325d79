// Four tets at once give the bits that each of them gives alone.
#include "base/random.h"
#include "meshes.h"
#include "simulate/flow_cell.h"
#include "simulate/heat_cell.h"
#include <kropla/mesh/topology.h>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace kropla {
namespace {

/// A stage of a flow with random places, velocities, pressures and forces; with densities at vertices if it expands.
class RandomStage {
public:
    explicit RandomStage(bool convection, bool expands) : mesh_(unit_cube(4)), convection_(convection) {
        Array<Vertex, double> densities;
        for (const Vertex v : mesh_.position.indices()) {
            position_.push_back(mesh_.position[v] + 0.02 * vector());
            mesh_velocity_.push_back(vector());
            old_.push_back(vector());
            guess_.velocity.push_back(vector());
            guess_.pressure.push_back(random_.uniform(-1, 1));
            force_.push_back(vector());
            if (expands) densities.push_back(random_.uniform(1, 2));
        }
        material_.push_back({.density = 1.3, .viscosity = 0.07, .densities = densities, .viscosities = {}, .density_rate = {}, .force = force_});
        open_.fill(false);
        open_[1] = true;
        open_pressure_[1] = guess_.pressure;
    }
    [[nodiscard]] FlowStage stage(double per_time) const {
        return {mesh_, position_, mesh_velocity_, old_, guess_, material_, open_, open_pressure_, {0.3, -2, 9.8}, per_time, convection_, upper_};
    }
    [[nodiscard]] const Mesh& mesh() const { return mesh_; }

    static constexpr std::uint64_t seed = 5;

private:
    Vec3 vector() { return {random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1)}; }

    Random random_{seed};
    Mesh mesh_;
    bool convection_;
    Array<Vertex, Vec3> position_, mesh_velocity_, old_, force_;
    FlowState guess_;
    Array<Region, FlowMaterial> material_;
    std::array<bool, 6> open_;
    std::array<Array<Vertex, double>, 6> open_pressure_;
    UpperSides upper_;
};

TEST(FourCells, OfAFlowHaveTheResidualsOfEach) {
    SCOPED_TRACE("seed " + std::to_string(RandomStage::seed));
    for (const auto& [convection, expands] : {std::pair{true, false}, {false, false}, {true, true}}) {
        const RandomStage random(convection, expands);
        for (const double per_time : {0.0, 20.0}) {
            const FlowStage stage = random.stage(per_time);
            const std::vector<Tet> tets = all_tets(random.mesh());
            for (std::size_t first = 0; first + 4 <= tets.size(); first += 4) {
                const std::array four = {tets[first], tets[first + 1], tets[first + 2], tets[first + 3]};
                std::array<CellBlocks<4>, 4> together;
                flow_residuals(stage, four, together);
                for (std::size_t which = 0; which < 4; ++which) {
                    CellBlocks<4> alone;
                    flow_cell(stage, four[which], false, alone);
                    ASSERT_EQ(together[which].residual, alone.residual) << "cell " << four[which].value;
                }
            }
        }
    }
}

TEST(FourCells, OfHeatHaveTheSystemsOfEach) {
    constexpr std::uint64_t seed = 6;
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random{seed};
    const auto vector = [&] { return Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; };
    const Mesh before = unit_cube(4);
    Mesh current = before;
    Array<Vertex, double> temperature, potential, source;
    Array<Vertex, Vec3> velocity;
    Array<Vertex, char> low;
    for (const Vertex v : current.position.indices()) {
        current.position[v] += 0.02 * vector();
        temperature.push_back(random.uniform(300, 2400));
        potential.push_back(random.uniform(-1, 1));
        source.push_back(random.uniform(-1, 1));
        velocity.push_back(vector());
        low.push_back(random.uniform() < 0.2 ? 1 : 0);  // so that fours are of one kind, or not
    }
    const HeatOptions options{.regions = {HeatRegion{.material = {.conductivity = 3, .density = 2, .specific_heat = 5}}}};
    const MaterialFlow flow{.potential = {potential}, .velocity = velocity};
    const Array<Region, Array<Vertex, double>> sources = {source};
    const HeatStep step{.before = before, .current = current, .options = options, .old_temperature = temperature, .flow = flow,
                        .carried = Array<Region, Array<Vertex, Vec3>>(1), .source = sources, .dt = 0.01,
                        .enthalpy = enthalpy_curves(options), .material = Array<Region, MaterialState>(1), .low = low};
    const std::vector<Tet> tets = all_tets(current);
    for (std::size_t first = 0; first + 4 <= tets.size(); first += 4) {
        const std::array four = {tets[first], tets[first + 1], tets[first + 2], tets[first + 3]};
        std::array<CellSystem<4>, 4> together;
        cell_systems(step, four, {&together[0], &together[1], &together[2], &together[3]});
        for (std::size_t which = 0; which < 4; ++which) {
            const CellSystem<4> alone = cell_system(step, four[which]);
            for (std::size_t i = 0; i < 4; ++i)
                for (std::size_t j = 0; j < 4; ++j)
                    if (i != j) {
                        ASSERT_EQ(together[which].matrix[i][j], alone.matrix[i][j]) << "cell " << four[which].value;
                    }
            ASSERT_EQ(together[which].row_sum, alone.row_sum);
            ASSERT_EQ(together[which].held, alone.held);
            ASSERT_EQ(together[which].right, alone.right);
            ASSERT_EQ(together[which].load, alone.load);
        }
    }
}

}  // namespace
}  // namespace kropla
