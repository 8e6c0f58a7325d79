#pragma once

#include "case/case.h"
#include "case/table.h"

namespace kropla {

/// [contact], if it is there: bodies, sizes, the floor of R/r and the flow are known already. Throws CaseError.
void read_contact(const CaseTable& file, Case& given);

}  // namespace kropla
