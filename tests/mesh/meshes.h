#pragma once

#include <kropla/mesh/mesh.h>

#include <cstdint>

namespace kropla {

// Tiny meshes by name, for the tests. All are valid (`verify` is empty), and of region 0 unless said so.

/// The corner of the unit cube: vertices 0, x, y, z; the facet opposite corner i is patch i.
///
///      3 (0,0,1)
///      |\ .
///      | \  2 (0,1,0)
///      |  \ .
///      0---1 (1,0,0)
[[nodiscard]] Mesh one_tet();

/// The regular tet with corners at corners of the cube [-1, 1]^3: R/r = 3, volume 8/3.
[[nodiscard]] Mesh regular_tet();

/// Two tets on either side of the triangle 0, 1, 2 of the plane z = 0, with the apexes 3 (tet 0) and 4
/// (tet 1). Convex: the edge 3-4 passes through the triangle, so that 2-3 is possible. One patch, 0.
///
///        3 (0,0,1)
///       /|\ .
///      / | \          0 (1,0,0), 1 (0,1,0), 2 (-1,-1,0)
///     2--|--0
///      \ | /          1 is behind the edge 3-4
///       \|/
///        4 (0,0,-1)
[[nodiscard]] Mesh two_tets();

/// n tets around the edge 0-1, n >= 3; the ring 2 ... n+1 is a regular polygon at z = 0. One patch, 0.
///
///              1 (0,0,1)
///            / | \ .
///      2+i --- | --- 2+i+1    tet i = 0, 1, 2+i, 2+(i+1 mod n)
///            \ | /
///              0 (0,0,-1)
[[nodiscard]] Mesh shell_of_edge(int n);

/// n tets around the edge 0-1 of a flat boundary face, n >= 2: one half of shell_of_edge(2n), y >= 0. The
/// ring 2 ... n+2 runs from (1,0,0) over (0,1,0) to (-1,0,0). The flat face y = 0 is patch 2, below is 4,
/// above is 5.
///
///              1 (0,0,1)             the face y = 0:        1
///            / | \ .                                      / | \ .
///      2+i --- | --- 3+i                               n+2--|---2
///            \ | /                                        \ | /
///              0 (0,0,-1)                                   0
[[nodiscard]] Mesh open_shell_of_edge(int n);

/// 8 tets around the inner vertex 0, the centre of the octahedron 1 ... 6 at +x, -x, +y, -y, +z, -z. One
/// patch, 0.
[[nodiscard]] Mesh ball_of_vertex();

/// The unit cube as a grid of n^3 cubes, each cut into 6 tets around its diagonal from the least to the
/// largest corner. Vertex (i, j, k) is number i + (n+1) (j + (n+1) k); the faces are the patches 0 ... 5.
[[nodiscard]] Mesh cube_of_tets(int n);

/// cube_of_tets(n), n >= 3, in which all but the outermost cubes of the grid are region 1.
[[nodiscard]] Mesh cube_in_cube(int n);

/// cube_in_cube(3) whose inner cube, region 1, is shrunk to half, the gap filled by a layer outside of
/// `count` prisms per column, all as high: 6 tets in the body, 12 wall triangles, 8 columns.
///
///      +-----------+
///      | +-------+ |    the shell at 1/3 and 2/3, tets of the surroundings beyond
///      | |\ ___ /| |
///      | | |   | | |    the wall at 5/12 and 7/12, tets of region 1 in it
///      | | |___| | |
///      | |/_____\| |
///      +-----------+
[[nodiscard]] Mesh layered_cube(int count);

/// Moves each inner vertex, those of interfaces too, by up to `amount` [m] along each axis. Random, the same
/// for the same seed. Keeps a cube_of_tets(n) valid while amount <= 0.1 / n.
void jiggle(Mesh& mesh, double amount, std::uint64_t seed);

}  // namespace kropla
