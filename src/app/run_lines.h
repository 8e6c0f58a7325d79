#pragma once

#include "case/case.h"
#include "app/run.h"

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

// What a run says of itself at its beginning and at its end, in lines without their ends.

/// `droplet.toml: about 75,000 tets, 50 steps to 10.0 ms, 2 threads`.
[[nodiscard]] std::string opening_line(const RunOptions& options, const Case& given);
/// `initial mesh: 74,364 tets, 13,240 vertices, worst R/r 4.98, in 2.31 s`.
[[nodiscard]] std::string mesh_line(const Mesh& mesh, double seconds);
/// What came out, by the files in its folder, and what to open:
///     done: 50 steps to 10.0 ms in 0:14, worst R/r 5.0
///     droplet: 2,391 K in the mean (2,400 K at the start), gave off 850 mJ, now at (0.0, 0.0, 3.0) mm
///     energy: 56.3 J stored, kept to 2e-14
///     see droplet/report.html, or paraview droplet/frames.pvd
/// and in a flow `sphere: now at (0.0, 0.0, 12.3) mm, going at 95.4 mm/s`. Of many bodies the first two, and
/// how many there are more. `seconds` is what it took. Throws FileError.
[[nodiscard]] std::vector<std::string> closing_lines(const std::filesystem::path& folder, double seconds);

}  // namespace kropla
