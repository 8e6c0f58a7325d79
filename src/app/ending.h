#pragma once

#include "base/error.h"
#include "mesh/mesh.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace kropla {

/// A FloorError that knows where [m]; and the mesh that failed there, if there is no better one to show.
struct StuckError : FloorError {
    StuckError(const std::string& what, const std::optional<Vec3>& at, std::optional<Mesh> reached = {})
        : FloorError(what), place(at), mesh(std::move(reached)) {}
    std::optional<Vec3> place;
    std::optional<Mesh> mesh;
};

/// Leaves in a run's folder why the run ended early, with the mesh as it was last, and the page that begins
/// with it: ended.toml, ended.vtu, report.html. `mesh` may be null. A folder without a run gets the page too.
/// Throws FileError.
void report_end(const std::filesystem::path& folder, const std::exception& why, const Mesh* mesh);

/// Takes away what `report_end` has left but for the page: the run goes on.
void forget_end(const std::filesystem::path& folder);

}  // namespace kropla
