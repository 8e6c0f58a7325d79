#pragma once

#include "app/case.h"
#include "app/case_table.h"

namespace kropla {

/// The values of [body.layer] side, in the order of LayerOptions::Side.
inline constexpr std::array<std::string_view, 3> side_names = {"outside", "inside", "both"};

/// Reads every [[body]] with [body.motion] and [body.layer] into the case, whose box is known. Throws CaseError.
void read_bodies(const CaseTable& file, Case& it);

}  // namespace kropla
