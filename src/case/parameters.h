#pragma once

#include "case/table.h"

namespace kropla {

/// Reads [parameters] into `reading`: numbers, and expressions of other parameters in any order. Throws CaseError for a
/// name that expressions have a meaning for already, for one that is not known, and for parameters that depend on
/// themselves.
void read_parameters(const CaseTable& table, CaseReading& reading);

}  // namespace kropla
