#pragma once

#include <kropla/mesh/mesh.h>
#include <kropla/step/stuck.h>

#include <exception>
#include <filesystem>

namespace kropla {

/// Leaves in a run's folder why the run ended early, with the mesh as it was last, and the page that begins
/// with it: ended.toml, ended.vtu, report.html. `mesh` may be null. A folder without a run gets the page too.
/// Throws FileError.
void report_end(const std::filesystem::path& folder, const std::exception& why, const Mesh* mesh);

/// Takes away what `report_end` has left but for the page: the run goes on.
void forget_end(const std::filesystem::path& folder);

}  // namespace kropla
