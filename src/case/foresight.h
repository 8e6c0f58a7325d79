#pragma once

#include "case/case.h"
#include <kropla/base/watch.h>

#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// Looks at a case before it is run: where its bodies stand, the paths that they go (`look_at_paths`), how
/// narrow their gaps become on the way, and how many tets all this asks for. Returns what may keep the run
/// from its end, a sentence each; a reader is told. Throws DomainError, one sentence, for what surely does:
/// it says what is in the way, where and when, and sizes that satisfy all that is known, or that none does.
/// Interrupted if the watch says so.
[[nodiscard]] std::vector<std::string> foresee(const Case& given, const Watch* watch = nullptr);

/// Prints each on stderr, "kropla: warning: ...".
void warn(const std::vector<std::string>& warnings);

/// Whether the box is 300 times as large as a body, or a body as the box, or the size as a body: a sentence
/// that asks for mixed units, to be put at the end of a refusal; else empty.
[[nodiscard]] std::string unit_hint(const Domain& domain);

/// The numbers that stand in a formula, in their order.
[[nodiscard]] std::vector<double> numbers_in(std::string_view formula);

}  // namespace kropla
