#pragma once

#include <array>
#include <string>
#include <vector>

// The reader of the comparison with other mesh generators. It shares no code with the library it judges.

namespace peers {

using Point = std::array<double, 3>;

/// The tets of a mesh file: places of the vertices [m], four vertices and a region per tet.
struct Cells {
    std::vector<Point> places;
    std::vector<std::array<int, 4>> tets;
    std::vector<int> region;
};

/// Reads .vtu (VTK's XML, tets only), .msh (Gmsh 2.2, ASCII), .mesh (Medit, ASCII) or .ele with .node beside it
/// (TetGen). Throws std::runtime_error with the file's name if it cannot.
Cells read_cells(const std::string& file);

Point difference(const Point& a, const Point& b);
Point cross(const Point& a, const Point& b);
double dot(const Point& a, const Point& b);
double length(const Point& a);

}  // namespace peers
