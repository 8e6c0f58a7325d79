#pragma once

#include "report/cut_frame.h"

namespace kropla {

/// The fields of a flow, as frames have them.
inline constexpr const char *velocity_name = "velocity", *pressure_name = "pressure";

/// Rows of pictures of the speed, with arrows, and of the pressure, from the first of the frames that flows;
/// empty if none does.
[[nodiscard]] std::string draw_flow_cuts(const RunFiles& run, std::span<const CutFrame> frames,
                                         const Watch* watch);

}  // namespace kropla
