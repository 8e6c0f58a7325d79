#pragma once

#include "meshes.h"
#include <kropla/simulate/flow.h>

#include <cstdint>
#include <functional>
#include <string>

namespace kropla {

/// A velocity by its three components, and the three constant.
VectorQuantity velocity_of(const std::function<Vec3(const Vec3& place, double t)>& velocity);
VectorQuantity uniform(const Vec3& velocity);

/// One region without a body; all faces with this velocity.
FlowOptions fluid(double density, double viscosity, const VectorQuantity& on_faces);

/// The unit cube with a body in the middle, two prisms around it and, if `inside`, two in it.
Mesh cube_with_layers(int n, bool inside);

/// The mesh's body, region 1, with its layers turned about z and shifted, what is around following; and every
/// vertex but those of the body's surface moved by up to `shake` [m] along each axis, those on the box along
/// it.
Mesh moved(const Mesh& start, const Vec3& shift, double angle, double shake, std::uint64_t seed);

/// A sphere of this radius [m] around the origin, region 1, in a cube of half-width `half` [m]: `around`
/// cells a quarter, so many prisms of the height `layer` in all, and `out` shells of tets that grow outwards.
/// The facets of the sphere, and of that around it if it is round, keep their volumes.
struct SphereInCube {
    double radius, half;
    int around, prisms;
    double layer;
    int out;
    bool round = false;  // in a sphere of radius `half` instead of the cube
};
Mesh sphere_in_cube(const SphereInCube& shape);

/// How many triangles are under the mesh's first layer, how many prisms and tets there are: for a table.
std::string in_words(const Mesh& mesh);

/// The flow of speed `speed` along z around a fixed sphere that viscosity alone makes [Stokes 1851], and its
/// pressure for a viscosity of 1.
Vec3 stokes_velocity(const Vec3& place, double radius, double speed);
double stokes_pressure(const Vec3& place, double radius, double speed);

/// Errors against a solution, at vertices weighted by their volume: the root of the mean square.
double velocity_error(const Mesh& mesh, const FlowState& state,
                      const std::function<Vec3(const Vec3&)>& exact);
double pressure_error(const Mesh& mesh, const FlowState& state,
                      const std::function<double(const Vec3&)>& exact);

}  // namespace kropla
