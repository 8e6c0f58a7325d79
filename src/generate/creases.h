#pragma once

#include "domain/triangulated_surface.h"
#include "generate/sheet.h"
#include "mesh/box_tree.h"

#include <utility>
#include <vector>

namespace kropla {

/// Edges at which a surface's triangles meet at more than this angle [rad] (35 degrees) are creases, and stay where they
/// are; flatter ones are taken for those of triangles on a smooth surface. A crease that bends so sharply has a corner.
inline constexpr double sharp = 0.61;

/// The triangles of a surface as a sheet, with its creases, and what holds its vertices: a corner is where other than two
/// creases meet, or two in a bend.
[[nodiscard]] Sheet sheet_of(const TriangulatedSurface& surface);

/// Tells what holds the vertices, from the creases.
void find_holds(Sheet& sheet);

/// The creases of a surface, as places.
class Creases {
public:
    explicit Creases(const Sheet& sheet);
    /// The nearest place on a crease; there is one.
    [[nodiscard]] Vec3 nearest(const Vec3& x) const;

private:
    std::vector<std::pair<Vec3, Vec3>> segments_;
    BoxTree tree_;
};

}  // namespace kropla
