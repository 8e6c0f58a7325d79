#pragma once

#include <kropla/mesh/topology.h>

#include <optional>

namespace kropla {

/// A vertex that lies in a facet without being one of its corners: cells meet there, but do not share facets.
struct HangingVertex {
    Vertex vertex;
    Facet facet;
};
/// The first facet on which a vertex hangs. To `verify` such a place is a boundary like any other, closed and
/// without volume; it is found here by where the vertices are, to one part in 10^6 of the facet's edges, as
/// files may hold coordinates in single precision. Facets in the faces of the bounding box are passed over,
/// so that the work is small for a mesh that fills its box.
[[nodiscard]] std::optional<HangingVertex> hanging_vertex(const Mesh& mesh);

}  // namespace kropla
