#pragma once

#include "domain/triangulated_surface.h"
#include "generate/sheet.h"
#include "mesh/box_tree.h"

#include <utility>
#include <vector>

namespace kropla {

/// The triangles of a surface as a sheet, with its creases, which stay where they are, and what holds its vertices: a corner
/// is where other than two creases meet, or two in a bend as `sharp` as they are.
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
