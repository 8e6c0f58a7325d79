#pragma once

#include "app/case.h"
#include "app/run.h"

#include <cstdint>
#include <string>

namespace kropla {

// What a run says of itself at its beginning and at its end: one line each, without its end.

/// `droplet.toml: about 75,000 tets, 50 steps to 10.0 ms, 2 threads`.
[[nodiscard]] std::string opening_line(const RunOptions& options, const Case& it);
/// `initial mesh: 74,364 tets, 13,240 vertices, worst R/r 4.98, in 2.31 s`.
[[nodiscard]] std::string mesh_line(const Mesh& mesh, double seconds);
/// `done: 50 steps to 10.0 ms in 0:14; see droplet/report.html, or paraview droplet/frames.pvd`.
[[nodiscard]] std::string closing_line(const RunOptions& options, std::int64_t step, double time, double seconds);

}  // namespace kropla
