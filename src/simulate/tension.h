#pragma once

#include "simulate/cells.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace kropla {

// Surface tension sigma, as the weak form of the surface's divergence has it, integral(sigma div_S v): a vertex i of a
// surface of triangles is pulled by - sum of sigma A grad_S phi_i over the triangles around. Of that only the part along
// the normal is taken, that of what the volume gains with the vertex, to which the pressure's jump is opposed. So a
// surface on which both are in balance at each vertex rests, wherever its vertices are along it. Along the surface pulls
// the gradient of sigma, integral(phi_i grad_S sigma) (Marangoni). A closed surface neither pulls nor turns itself: what is
// left of all forces together is taken off along the normals, and of their moments as by a turn.
//
// On a face of the box a surface may end, in a line that is pinned or moves along the face. One that moves is pulled along
// the face by the surface's own gradient of area, of which the part along the gradient of the volume counts, as elsewhere, and by
// Young's force, the gradient of sigma cos(theta) times the area that the liquid wets there: both are in balance at the
// angle theta, measured in the liquid.
//   [Gerbeau, Lelievre 2009] Generalized Navier boundary condition and geometric conservation law for surface tension.
//     Comput. Methods Appl. Mech. Engrg. 198.
//
// Where the surface goes on by d against the places it is reckoned for, the tension follows in linear terms,
// by integral(sigma grad_S (d.n) . grad_S (v.n)): symmetric and positive, which makes it stable for any time step.
//   [Dziuk 1991] An algorithm for evolutionary surfaces. Numer. Math. 58.
//   [Baensch 2001] Finite element discretization of the Navier-Stokes equations with a free capillary surface.
//     Numer. Math. 88.
//   [Barrett, Garcke, Nuernberg 2008] On the parametric approximation of motion by mean curvature. J. Comput. Phys. 227:
//     only the normal's part counts.

/// Where the surface of a liquid ends on a face of the box.
struct ContactLine {
    std::size_t face = 0;
    std::vector<Vertex> vertices;               // ascending
    std::vector<std::array<Vertex, 3>> wetted;  // the liquid's facets on the face
    std::optional<double> cosine;               // of the angle at which it rests, in the liquid; none: it is pinned
};

/// The surface of a liquid.
struct LiquidSurface {
    Region body;
    std::vector<std::array<Vertex, 3>> facets;  // normals out of the body
    std::vector<Vertex> vertices;               // ascending
    std::vector<double> tension;                // [N/m] at them
    double denser = 0;                          // [kg/m^3] than what is around
    std::vector<ContactLine> lines = {};
    // Of the directions x, y and z that a vertex may go along with the surface 1, of the others 0: across a face of the box.
    std::vector<Vec3> free = {};  // empty: all
};

/// What acts on a surface at one set of places.
struct SurfaceTension {
    /// How tightly the normal parts of two vertices are bound [N/m].
    struct Bond {
        std::size_t row, column;  // places in LiquidSurface::vertices
        double stiffness;
    };
    std::vector<Vec3> force;   // [N] per vertex; on a face of the box also what it pulls across that
    std::vector<Vec3> normal;  // unit, out of the body
    std::vector<Bond> bonds;   // by rows, each pair once; both ways
    double area = 0;           // [m^2]
    double energy = 0;         // [J] tension times area, less Young's of what is wetted
};
[[nodiscard]] SurfaceTension surface_tension(const LiquidSurface& surface, const Array<Vertex, Vec3>& position);

/// The vertices of facets, ascending; and the place of one among them.
[[nodiscard]] std::vector<Vertex> vertices_of(std::span<const std::array<Vertex, 3>> facets);
[[nodiscard]] std::size_t place_of(std::span<const Vertex> vertices, Vertex v);

/// The lines in which the surface of a region ends on faces of the box, by faces; their angles are not set.
[[nodiscard]] std::array<ContactLine, 6> contact_lines(const Mesh& mesh, Region body, std::span<const Vertex> surface);
/// The directions in which its vertices are free (LiquidSurface::free); empty without such lines.
[[nodiscard]] std::vector<Vec3> free_directions(std::span<const Vertex> surface, const std::array<ContactLine, 6>& lines);

/// Unit normals along the faces on which vertices are that are not free in all directions.
[[nodiscard]] std::vector<Vec3> along_faces(std::vector<Vec3> normals, std::span<const Vec3> free);

/// Unit normals at the vertices, along what the volume gains with them.
[[nodiscard]] std::vector<Vec3> surface_normals(std::span<const std::array<Vertex, 3>> facets,
                                                std::span<const Vertex> vertices, const Array<Vertex, Vec3>& position);

}  // namespace kropla
