#pragma once

#include "case/case.h"
#include "case/table.h"

namespace kropla {

/// Reads every [[species]] into the case, whose bodies are known. Throws CaseError.
void read_species(const CaseTable& file, Case& given);

}  // namespace kropla
