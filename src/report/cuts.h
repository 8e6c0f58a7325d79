#pragma once

#include <kropla/base/watch.h>
#include "report/run_files.h"

#include <string>

namespace kropla {

/// Parts of the page; empty if there is nothing to show.
struct CutPictures {
    std::string mesh, field;
};
/// The run's mesh and its first field on the plane through its first body's path, at the start, the middle
/// and the end. Empty without frames. Throws FileError, naming the file, if a frame cannot be read, Interrupted if the
/// watch says so.
[[nodiscard]] CutPictures draw_cuts(const RunFiles& run, const Watch* watch = nullptr);

}  // namespace kropla
