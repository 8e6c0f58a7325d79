#pragma once

#include "simulate/flow_conditions.h"
#include "simulate/pattern.h"

#include <vector>

namespace kropla {

/// The surfaces of liquids in a step of a flow: what pulls them in each stage, and where the flow takes them.
class FlowSurfaces {
public:
    /// All outlive this.
    FlowSurfaces(const Pattern& pattern, const std::vector<LiquidSurface>& liquids) : pattern_(pattern), liquids_(liquids) {}

    /// What pulls them in a stage, with its vertices at `position`; and how far the mesh, whose vertices have gone by
    /// `by_mesh` times their velocity [s], is ahead of the flow, but for what that takes them on in this one. Without a
    /// velocity of the mesh nothing goes on.
    void begin(const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& mesh_velocity, double by_mesh);
    /// Adds the tension, with what it gains as the surfaces go on for `time` [s] with the velocity; and the derivative.
    void add(const Array<Vertex, Vec3>& velocity, double time, bool derivative, BlockSystem& system) const;
    /// A stage has ended that counts for `time` [s] in the mean.
    void end(const Array<Vertex, Vec3>& velocity, double time);

    [[nodiscard]] std::vector<SurfaceCourse> courses() const;
    [[nodiscard]] double energy() const;  // [J] in the last stage

private:
    const Pattern& pattern_;
    const std::vector<LiquidSurface>& liquids_;
    // Of each, in their order:
    std::vector<SurfaceTension> tensions_;    // in this stage
    std::vector<std::vector<Vec3>> gone_;     // [m] with the flow, in the stages so far
    std::vector<std::vector<Vec3>> behind_;   // [m] of that the mesh has not done
};

}  // namespace kropla
