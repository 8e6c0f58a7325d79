#pragma once

#include <string>
#include <vector>

namespace kropla {

/// Tries PETSc's options, as the command line gave them, on a small system; PETSc is there already. Throws
/// CaseError, in one line, if a value is not taken or nothing asks for an option, which most often is misspelt.
void check_solver_options(const std::vector<std::string>& words);

/// Those of them that nobody has asked for since they were checked: "-pc_factor_levels".
[[nodiscard]] std::vector<std::string> unused_solver_options(const std::vector<std::string>& words);

}  // namespace kropla
