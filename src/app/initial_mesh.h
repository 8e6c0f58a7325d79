#pragma once

#include "adapt/adapt.h"
#include "app/case.h"

namespace kropla {

/// How the case wants its mesh adapted, at the start and at every step.
[[nodiscard]] AdaptOptions adapt_options(const Case& it, const Watch* watch = nullptr);

/// The mesh that a run of the case starts from: generated, then improved until it meets the floor.
/// Throws DomainError if the bodies cannot be meshed; StuckError, saying where, what would help, and with the
/// mesh as it is, if the floor is not reached; Interrupted if the watch says so.
[[nodiscard]] Mesh initial_mesh(const Case& it, const Watch* watch = nullptr);

}  // namespace kropla
