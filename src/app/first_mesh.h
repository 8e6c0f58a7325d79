#pragma once

#include "case/case.h"

namespace kropla {

/// The mesh with which a case begins: that which it brings, improved with its boundary and interfaces kept; or one made for
/// its domain (step/initial_mesh.h). Throws as initial_mesh; StuckError too if what was brought cannot be improved to the
/// floor.
[[nodiscard]] Mesh first_mesh(const Case& given, const Watch* watch);

}  // namespace kropla
