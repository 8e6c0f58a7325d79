#pragma once

#include "app/case.h"

namespace kropla {

/// The mesh that a run of the case starts from: generated, then improved until it meets the floor.
/// Throws DomainError if the bodies cannot be meshed, FloorError, naming the worst cell, if the floor is not
/// reached.
[[nodiscard]] Mesh initial_mesh(const Case& it);

}  // namespace kropla
