#pragma once

#include <kropla/adapt/moving_mesh.h>
#include <kropla/simulate/flow.h>
#include <kropla/step/advance.h>

#include <vector>

namespace kropla {

// Bodies of liquid go with the flow: along the normal of their surface as it does, and along the surface with the body as a
// whole, so that a flow along it, as in a drop that rises, does not sweep the triangles together. Normals are those half-way,
// which makes this of second order in time.
//
// In a step, the mesh first goes where the flow at its begin, and the rate it had, would take the surfaces. On that the flow
// is solved for, with the tension of where it takes them itself (flow.h), and the mesh goes there. If that is far from what
// was expected, it is solved for again.

/// A step of the surfaces of all liquid bodies.
class LiquidStep {
public:
    /// From t [s] on, for dt, as `velocity` [m/s] and its `rate` [m/s^2] let expect on the mesh at the step's begin.
    LiquidStep(std::vector<Region> liquids, const Mesh& begin, const Array<Vertex, Vec3>& velocity,
               const Array<Vertex, Vec3>& rate, double t, double dt);

    /// Where the surfaces go, by what is known.
    [[nodiscard]] const std::vector<BodyCourse>& courses() const { return courses_; }

    enum class Verdict {
        arrived,   ///< the mesh is where the flow takes it
        near,      ///< so near that the flow is known: the mesh is to go on its courses, and that is all
        elsewhere  ///< the flow is to be solved for again there
    };
    /// Takes where the flow took them on the step's mesh.
    Verdict take(const Mesh& before, const Mesh& current, const std::vector<SurfaceCourse>& surfaces);

private:
    double t_, dt_;
    std::vector<BodyCourse> courses_;
};

}  // namespace kropla
