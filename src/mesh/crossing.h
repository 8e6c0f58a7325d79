#pragma once

#include <kropla/mesh/prisms.h>
#include <kropla/mesh/topology.h>

#include <optional>
#include <variant>

namespace kropla {

/// Two facets of the boundary that have more in common than the vertices they share.
struct Crossing {
    Facet a, b;
    bool covers;  // they lie in one plane, on each other; else they cut each other
};
/// The first pair of facets without a neighbour, inner ones too, that cut, cover or touch each other beside the
/// vertices they share. Where there is none, and `verify` finds no fault, the mesh does not overlap itself but for a
/// part that lies wholly within another: see find_buried. That holds for prisms too: they fill what is between facets of
/// tets, their walls and shells, and none is turned over. Exact, by orient3d; n log n for n facets that are of alike
/// sizes where they are near each other. Tets are positively oriented.
[[nodiscard]] std::optional<Crossing> find_crossing(const Mesh& mesh);

/// A cell that lies where another one is too.
struct Buried {
    Tet cell;
    std::variant<Tet, Prism> within;
};
/// Whether the middle of a cell at each connected surface lies in another tet, or in a prism, by three tets that fill it: so
/// it is of parts that lie within others without crossing them.
[[nodiscard]] std::optional<Buried> find_buried(const Mesh& mesh);

}  // namespace kropla
