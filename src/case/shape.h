#pragma once

#include "case/case.h"
#include "case/table.h"

namespace kropla {

/// Reads `shape` and the keys that go with it; `written` comes to hold how they were given. Throws CaseError.
[[nodiscard]] Shape read_shape(const CaseTable& table, const Box& box, WrittenBody& written);

}  // namespace kropla
