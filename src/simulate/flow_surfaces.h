#pragma once

#include "simulate/flow_conditions.h"
#include "simulate/pattern.h"

#include <vector>

namespace kropla {

/// The surfaces of liquids in a step of a flow: what pulls them in each stage, and where the flow takes them.
class FlowSurfaces {
public:
    /// All outlive this.
    FlowSurfaces(const Pattern& pattern, const std::vector<LiquidSurface>& liquids)
        : pattern_(pattern), liquids_(liquids), state_(liquids.size()) {}

    /// What pulls them in a stage, with its vertices at `position`; and how far the mesh, whose vertices have gone by
    /// `by_mesh` times their velocity [s], is ahead of the flow, but for what that takes them on in this one. Without a
    /// velocity of the mesh nothing goes on.
    void begin(const Array<Vertex, Vec3>& position, const Array<Vertex, Vec3>& mesh_velocity, double by_mesh);
    /// Adds the tension, with what it gains as the surfaces go on for `time` [s] with the velocity; and the derivative.
    void add(const Array<Vertex, Vec3>& velocity, double time, bool derivative, BlockSystem& system) const;
    /// Adds the momentum of what would pass the surfaces. Where the flow slips along the mesh it passes facets to and fro, as
    /// around a vertex they are not all along it; what is denser on one side would lose or gain by that.
    void add_passing(const Array<Vertex, Vec3>& velocity, bool derivative, BlockSystem& system) const;
    [[nodiscard]] Vec3 passing(const Array<Vertex, Vec3>& velocity) const;  // [N] of all that is added
    /// A stage has ended that counts for `time` [s] in the mean.
    void end(const Array<Vertex, Vec3>& velocity, double time);

    [[nodiscard]] std::vector<SurfaceCourse> courses() const;
    [[nodiscard]] double energy() const;  // [J] in the last stage

private:
    struct State {
        SurfaceTension tension;      // in this stage, as all but `gone`
        std::vector<Vec3> mesh;      // [m/s] its vertices' velocities
        std::vector<Vec3> areas;     // [m^2] of its facets, along their normals
        std::vector<Vec3> gone;      // [m] with the flow, in the stages so far
        std::vector<Vec3> behind;    // [m] of that the mesh has not done
    };
    /// A facet, and what the flow takes through it, at its corners.
    struct PassedFacet {
        std::array<Vertex, 3> vertices;
        Vec3 area;                     // [kg/m] times what is denser
        std::array<Vec3, 3> velocity;  // [m/s] less the surface's mean
        std::array<double, 3> flux;    // [kg/s] as if it were the same all over the facet
    };
    template <class Visit>
    void for_each_passing(const Array<Vertex, Vec3>& velocity, const Visit& visit) const;
    void add_force(Vertex v, const Vec3& force, BlockSystem& system) const;
    [[nodiscard]] double* block_of(Vertex row, Vertex column, BlockSystem& system) const;  // none if the row is not owned

    const Pattern& pattern_;
    const std::vector<LiquidSurface>& liquids_;
    std::vector<State> state_;  // of each, in their order
};

}  // namespace kropla
