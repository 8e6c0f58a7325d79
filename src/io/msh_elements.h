#pragma once

#include <array>
#include <string_view>

namespace kropla {

/// A type of element as MSH files number them.
struct MshType {
    int number;
    int dimension;
    int nodes;
    std::string_view name;
};

/// Those that are read or passed over, all linear.
inline constexpr std::array<MshType, 6> msh_types = {{{15, 0, 1, "point"},
                                                      {1, 1, 2, "line"},
                                                      {2, 2, 3, "triangle"},
                                                      {3, 2, 4, "quadrilateral"},
                                                      {4, 3, 4, "tetrahedron"},
                                                      {6, 3, 6, "prism"}}};
inline constexpr int msh_triangle = 2, msh_quad = 3, msh_tet = 4, msh_prism = 6;

/// Those that are refused by name; of any other the number is said.
inline constexpr std::array<MshType, 8> msh_refused = {{{5, 3, 8, "hexahedra"},
                                                        {7, 3, 5, "pyramids"},
                                                        {8, 1, 3, "second-order lines"},
                                                        {9, 2, 6, "second-order triangles"},
                                                        {11, 3, 10, "second-order tetrahedra"},
                                                        {13, 3, 18, "second-order prisms"},
                                                        {16, 2, 8, "second-order quadrilaterals"},
                                                        {18, 3, 15, "second-order prisms"}}};

inline constexpr std::string_view msh_surroundings = "surroundings";

}  // namespace kropla
