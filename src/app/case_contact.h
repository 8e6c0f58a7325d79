#pragma once

#include "app/case.h"
#include "app/case_table.h"

namespace kropla {

/// [contact], if it is there: bodies, sizes, the floor of R/r and the flow are known already. Throws CaseError.
void read_contact(const CaseTable& file, Case& it);

}  // namespace kropla
