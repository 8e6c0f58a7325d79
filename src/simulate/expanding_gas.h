#pragma once

#include "simulate/flow_conditions.h"
#include "simulate/flow_mass.h"

#include <array>
#include <vector>

namespace kropla {

/// A gas whose density depends on the temperature (flow.h) in a step of its flow: what it takes that its vertices gain in
/// each stage, and what passes the faces of the box.
class ExpandingGas {
public:
    /// Of a gas with these masses, in all of the pattern, in a step of `dt` [s]. What is given by reference outlives this;
    /// densities of the material are set in each stage.
    ExpandingGas(VertexMasses masses, const Pattern& pattern, const FlowBoundary& boundary, FlowMaterial& material, double dt);

    /// A stage begins, with its vertices at `position`, on the velocities that solid bodies have. Without a velocity of the
    /// mesh the flow is steady, and nothing is gained.
    void begin(const StageTime& stage, const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& velocity,
               const Array<Vertex, Vec3>& mesh_velocity);
    /// What it takes in this stage that the vertex gains [m^3/s].
    [[nodiscard]] double expansion(Vertex v) const { return expansion_[v]; }
    /// The stage has ended.
    void end(const StageTime& stage, const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& velocity);

    /// In the last stage [kg/m^3].
    [[nodiscard]] const Array<Vertex, double>& densities() const { return material_.densities; }
    /// What passed faces, in the mean over the step.
    [[nodiscard]] std::vector<FaceMass> through() const;
    /// [kg] gained in the step, and not through faces.
    [[nodiscard]] double mass_error() const;

private:
    VertexMasses masses_;
    const Pattern& pattern_;
    const FlowBoundary& boundary_;
    FlowMaterial& material_;
    double dt_;
    Array<Vertex, double> gained_;                 // [kg] in the stages so far
    Array<Vertex, double> expansion_;              // [m^3/s]
    std::array<Array<Vertex, double>, 6> passed_;  // [kg/s] out through faces, in the mean over the step
};

}  // namespace kropla
