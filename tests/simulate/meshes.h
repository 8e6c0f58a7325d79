#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/simulate/heat.h>

#include <functional>
#include <vector>

namespace kropla {

/// Where the grid's vertex (i, j, k) stands [m], and which region the cube from (i, j, k) on is of (-1: a
/// hole).
using Place = std::function<Vec3(int i, int j, int k)>;
using RegionOfCube = std::function<int(int i, int j, int k)>;

/// A grid of cubes, six tets each around the diagonal that points away from the middle of the grid. Patches
/// are the grid's faces, 0 ... 5; a hole's surface is patch 0 too.
Mesh cube_grid(int nx, int ny, int nz, const Place& place, const RegionOfCube& region);

/// The unit cube, n^3 cubes, one region; and with a body, region 1: the cubes within a quarter of the middle
/// (n is a multiple of 4).
Mesh unit_cube(int n);
Mesh unit_cube_with_body(int n);

/// Shell m of the grid, counted from its middle, on the sphere of radii[m]; the middle is where there are as many steps
/// before as radii but one.
Place on_spheres(std::vector<double> radii);

/// A ball: cubes within the grid's shell m are taken to the sphere of radii[m]; regions by shell (-1:
/// hollow).
Mesh ball_of_shells(const std::vector<double>& radii, const std::function<int(int shell)>& region);

/// The mesh with prisms on the surface of its body, region 1, outside (`of` = 0) or inside it (1): the body
/// is shrunk towards `middle` by `depth` of its size, and what came free is filled with `count` prisms per
/// column. For layers on both sides the outer one comes first.
Mesh with_layer(const Mesh& mesh, const Vec3& middle, Region of, int count, double depth);

/// The vertices of a region's cells: 1, else 0.
Array<Vertex, char> vertices_of(const Mesh& mesh, Region region);

/// The square root of the integral of the squared difference to `exact`, by a rule exact for quadratics.
double l2_error(const Mesh& mesh, const NodalField& field, const std::function<double(const Vec3&)>& exact);

double largest_difference(const Mesh& mesh, const NodalField& field, double value);

}  // namespace kropla
