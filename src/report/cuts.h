#pragma once

#include <kropla/base/watch.h>
#include "report/run_files.h"

#include <string>

namespace kropla {

/// The run's mesh and its first field on the plane through its first body's path, at the start, the middle
/// and the end: a part of the page. Empty without frames. Throws FileError, naming the file, if a frame
/// cannot be read, Interrupted if the watch says so.
[[nodiscard]] std::string draw_cuts(const RunFiles& run, const Watch* watch = nullptr);

}  // namespace kropla
