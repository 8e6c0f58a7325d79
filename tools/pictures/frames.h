#pragma once

#include <kropla/base/vec3.h>
#include <kropla/io/pvd.h>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <filesystem>
#include <vector>

namespace kropla::pictures {

/// A frame of a run, and where its first body is.
struct RunFrame {
    double time;  // [s]
    vtkSmartPointer<vtkUnstructuredGrid> grid;
    Vec3 min, max;  // [m] corners of the box
    Vec3 centre;    // [m] of the first body
    double radius;  // [m] half its greatest extent
};

/// The frames that DIR/frames.pvd names, by time. Throws FileError if there is none.
[[nodiscard]] std::vector<SeriesEntry> frames_of_run(const std::filesystem::path& dir);

/// Throws FileError, naming the file, if it is missing, damaged, or has no cell arrays region and
/// aspect_ratio. Without a body (no cell of region 1) the middle of the box stands for its centre.
[[nodiscard]] RunFrame read_run_frame(const std::filesystem::path& dir, const SeriesEntry& entry);

[[nodiscard]] bool has_field(const RunFrame& frame, const char* name);

/// `count` of the entries, evenly over the run, first and last among them; all, if they are fewer.
[[nodiscard]] std::vector<SeriesEntry> evenly(const std::vector<SeriesEntry>& entries, std::size_t count);

}  // namespace kropla::pictures
