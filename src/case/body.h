#pragma once

#include "case/case.h"
#include "case/mesh.h"
#include "case/table.h"

namespace kropla {

/// The values of [body.layer] side, in the order of LayerOptions::Side.
inline constexpr std::array<std::string_view, 3> side_names = {"outside", "inside", "both"};

/// Reads every [[body]] with [body.motion] and [body.layer] into the case, whose box is known. Throws CaseError.
void read_bodies(const CaseTable& file, Case& given);

/// The same where bodies are regions of a mesh: returns the number of each; shapes are left to who knows the mesh.
[[nodiscard]] std::vector<int> read_region_bodies(const CaseTable& file, const CaseMesh& mesh, Case& given);

/// The name of a body as columns have it: letters, digits and `_.-`; anything else becomes `_`.
[[nodiscard]] std::string column_name(const std::string& body);

}  // namespace kropla
