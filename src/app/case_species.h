#pragma once

#include "app/case.h"
#include "app/case_table.h"

namespace kropla {

/// Reads every [[species]] into the case, whose bodies are known. Throws CaseError.
void read_species(const CaseTable& file, Case& it);

}  // namespace kropla
