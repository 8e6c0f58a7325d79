#pragma once

#include "adapt/adapt.h"
#include "app/case.h"

namespace kropla {

/// How the case wants its mesh adapted, at the start and at every step.
[[nodiscard]] AdaptOptions adapt_options(const Case& it, const Watch* watch = nullptr);

/// Throws DomainError if on its way through the whole run a body goes where it cannot (`check_paths`), Interrupted
/// if the watch says so.
void check_all_paths(const Case& it, const Watch* watch = nullptr);

/// The mesh that a run of the case starts from: generated, then improved until it meets the floor.
/// Throws DomainError if the bodies cannot be meshed, FloorError, naming the worst cell, if the floor is not
/// reached, Interrupted if the watch says so.
[[nodiscard]] Mesh initial_mesh(const Case& it, const Watch* watch = nullptr);

}  // namespace kropla
