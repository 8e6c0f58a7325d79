#pragma once

#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

#include <string>
#include <vector>

namespace kropla {

/// Where a body is and how warm, as the mesh has it.
struct BodyState {
    Vec3 place;                              // [m] of its centroid
    double volume = 0, area = 0;             // [m^3], [m^2]
    double on_faces = 0;                     // [m^2] of the faces of the box through which it reaches, what is within its lines
    double coldest = 0, mean = 0, hottest = 0;  // [K] if there is a temperature; the mean over its volume
};
/// Of each body of the domain, in order.
[[nodiscard]] std::vector<BodyState> body_states(const Domain& domain, const Mesh& mesh,
                                                 const Array<Vertex, double>* temperature);

}  // namespace kropla
