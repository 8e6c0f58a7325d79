#pragma once

#include "frames.h"
#include "sheet.h"

#include <vtkScalarsToColors.h>

#include <algorithm>
#include <string>
#include <vector>

namespace kropla::pictures {

inline constexpr Colour border_colour = {0.55, 0.60, 0.66};

/// "t = 2.4 ms"
[[nodiscard]] std::string time_label(double time);

/// The whole box, fitted into `place`.
[[nodiscard]] View whole_box(const RunFrame& frame, const Place& place);

/// A round length [m] of up to a third of the view's width.
[[nodiscard]] double bar_length(const View& view);

/// The colours of a map, from least to most upwards, with round numbers beside them.
void add_colour_bar(Sheet& sheet, const Place& place, vtkScalarsToColors* colours, double least,
                    double most);

/// Whole boxes side by side, one per frame; `add` draws a view of a frame. Returns the sheet for what else it
/// holds.
template <class Add>
[[nodiscard]] Sheet boxes_side_by_side(const std::vector<RunFrame>& frames, double right_margin, Add add) {
    const Vec3 extent = frames.front().max - frames.front().min;
    const double gap = 18, count = static_cast<double>(frames.size());
    const double width = (1600 - right_margin - gap) / count - gap;
    const double height = std::min(800.0, width * extent.z / extent.x);
    Sheet sheet = make_sheet(1600, static_cast<int>(height + gap + 52));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const double left = gap + static_cast<double>(i) * (width + gap);
        const View view = whole_box(frames[i], {left, gap, width, height});
        add(sheet, view, frames[i]);
        add_text(sheet, left + width / 2, gap + height + 26, time_label(frames[i].time), {.size = 24});
        if (i + 1 == frames.size()) add_scale_bar(sheet, view, bar_length(view));
    }
    return sheet;
}

}  // namespace kropla::pictures
