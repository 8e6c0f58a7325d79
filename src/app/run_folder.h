#pragma once

#include "app/run.h"

namespace kropla {

inline constexpr const char* checkpoint_name = "checkpoint.h5";

/// Throws CaseError, saying what to do, if no folder is named; if it holds another run and neither `resume` nor
/// `force` is asked for; or `resume` is asked for and there is no checkpoint; FileError if there is a file of that name.
void check_run_folder(const RunOptions& options);

/// Removes what a run leaves in its folder, and nothing else. Throws FileError.
void clear_run_folder(const std::filesystem::path& folder);

}  // namespace kropla
