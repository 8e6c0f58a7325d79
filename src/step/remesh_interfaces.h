#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/mesh/mesh.h>

#include <array>
#include <span>
#include <vector>

namespace kropla {

/// The facets at which cells of two regions meet.
struct Interface {
    Region inner, outer;                           // `inner` has the larger number
    std::vector<std::array<Vertex, 3>> triangles;  // counter-clockwise seen from `outer`
    bool is_apart = false;  // closed and smooth enough to be adapted: none of its vertices is at the boundary, at a third
                            //   region, or where the surface touches itself
};
/// All of them, by their regions.
[[nodiscard]] std::vector<Interface> interfaces(const Mesh& mesh);

/// Improves a mesh of which no domain is known as `improve_mesh` does, and with it the triangles of these interfaces, which are
/// to be apart: splits, collapses, swaps and slides towards even edges and good angles, each keeping the volume of the
/// regions to rounding; edges of 75 degrees and more are only split. Vertices of splits lie on the quadric through those
/// around them. Returns what was done.
Changes remesh_interfaces(Mesh& mesh, std::span<const Interface> interfaces, const AdaptOptions& options = {});

/// How good the triangles of interfaces are.
struct TriangleSummary {
    std::size_t triangles = 0;
    double least_angle = 0, greatest_angle = 0;  // [degrees]; of none 0
};
[[nodiscard]] TriangleSummary summarise_triangles(const Mesh& mesh, std::span<const Interface> interfaces);

}  // namespace kropla
