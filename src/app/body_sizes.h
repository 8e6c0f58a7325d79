#pragma once

#include "app/body_state.h"
#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

#include <filesystem>
#include <string>
#include <vector>

namespace kropla {

/// A body as it was asked for, and as the mesh has it.
struct BodySize {
    std::string name;
    Vec3 semi_axes;           // [m]
    double volume = 0;        // [m^3] of its shape
    double mesh_volume = 0;   // [m^3] of its cells: the same to rounding
    int triangles = 0;        // of its surface
    double mean_edge = 0;     // [m] of those
};
/// Of each body, in order. The mesh is of the domain, at any time.
[[nodiscard]] std::vector<BodySize> body_sizes(const Domain& domain, const Mesh& mesh);

/// A line for each body; of many, for the first few, and a line that says how many there are more.
[[nodiscard]] std::string describe(const std::vector<BodySize>& sizes);

/// Writes bodies.csv, a row per body: its sizes, where it is when the run starts, and if `warm`, its temperatures then.
/// Throws FileError.
void write_bodies(const std::filesystem::path& path, const std::vector<BodySize>& sizes,
                  const std::vector<BodyState>& at_start, bool warm);

}  // namespace kropla
