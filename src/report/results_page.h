#pragma once

#include "report/results.h"

#include <string>

namespace kropla {

/// What came out of the run, as tables and charts: a part of the page. `pictures` are its fields on a cut, as HTML.
[[nodiscard]] std::string draw_results(const RunResults& results, const std::string& pictures);

}  // namespace kropla
