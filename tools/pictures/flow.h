#pragma once

#include <filesystem>

namespace kropla::pictures {

/// The speed of a flow with arrows, and its pressure, on the section through the first body at four times;
/// neither, if no frame flows. Throws FileError.
void draw_flow(const std::filesystem::path& run, const std::filesystem::path& velocity_file,
               const std::filesystem::path& pressure_file);

}  // namespace kropla::pictures
