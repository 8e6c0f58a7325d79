#pragma once

#include <kropla/mesh/mesh.h>

#include <functional>
#include <string>
#include <vector>

namespace kropla {

/// A quantity at a place [m] and a time [s].
using Quantity = std::function<double(const Vec3& place, double t)>;

/// A scalar per vertex of a mesh, linear in every tet; in a prism linear in the triangle and along
/// the column.
struct NodalField {
    std::string name;  // as in output: "temperature"
    std::string unit;  // "K"
    Array<Vertex, double> values;  // free slots hold nothing of meaning
};

/// The same of cells: living tets in order, then prisms as `all_prisms` has them.
struct CellField {
    std::string name, unit;
    std::vector<double> values;
};

/// The same of vectors.
struct NodalVectorField {
    std::string name;  // "velocity"
    std::string unit;  // "m/s"
    Array<Vertex, Vec3> values;
};

}  // namespace kropla
