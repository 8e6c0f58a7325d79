#pragma once

#include <kropla/mesh/mesh.h>

#include <string>
#include <vector>

namespace kropla {

/// A scalar per vertex of a mesh, linear in every tet; in a prism linear in the triangle and along
/// the column.
struct NodalField {
    std::string name;  // as in output: "temperature"
    std::string unit;  // "K"
    Array<Vertex, double> values;  // free slots hold nothing of meaning
};

}  // namespace kropla
