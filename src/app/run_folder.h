#pragma once

#include "app/run.h"

namespace kropla {

inline constexpr const char* checkpoint_name = "checkpoint.h5";

/// Throws CaseError, saying what to do, if the folder of a run holds another one and `resume` is not asked
/// for, or `resume` is asked for and there is no checkpoint; FileError if there is a file of that name.
void check_run_folder(const RunOptions& options);

}  // namespace kropla
