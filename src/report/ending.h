#pragma once

#include "report/run_files.h"

#include <string>

namespace kropla {

/// The mesh of ended.vtu around the place where the run ended, in a close view and a wider one: a part of the
/// page. Empty if the run did not end early, or nobody knows where. Throws FileError if the mesh cannot be
/// read.
[[nodiscard]] std::string draw_ending(const RunFiles& run);

}  // namespace kropla
