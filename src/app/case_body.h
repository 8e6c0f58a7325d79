#pragma once

#include "app/case.h"
#include "app/case_mesh.h"
#include "app/case_table.h"

namespace kropla {

/// The values of [body.layer] side, in the order of LayerOptions::Side.
inline constexpr std::array<std::string_view, 3> side_names = {"outside", "inside", "both"};

/// Reads every [[body]] with [body.motion] and [body.layer] into the case, whose box is known. Throws CaseError.
void read_bodies(const CaseTable& file, Case& it);

/// The same where bodies are regions of a mesh: returns the number of each; shapes are left to who knows the mesh.
[[nodiscard]] std::vector<int> read_region_bodies(const CaseTable& file, const CaseMesh& mesh, Case& it);

}  // namespace kropla
