#pragma once

#include "case/case.h"
#include "case/table.h"

namespace kropla {

/// Reads [flow]: gravity, convection, [flow.region.NAME] of each region that is a liquid or gas, and [flow.face]. Bodies
/// without such a table are solid. Throws CaseError.
void read_flow(const CaseTable& file, Case& given);

}  // namespace kropla
