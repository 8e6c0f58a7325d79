#include "layout.h"

#include <kropla/base/vec3.h>
#include "report/svg.h"

#include <array>
#include <cmath>

namespace kropla::pictures {
namespace {

/// The largest of 1, 2 or 5 times a power of ten that is no more than `most`.
double round_number(double most) {
    const double ten = std::pow(10.0, std::floor(std::log10(most)));
    return (most >= 5 * ten ? 5 : most >= 2 * ten ? 2 : 1) * ten;
}

}  // namespace

std::string time_label(double time) { return "t = " + readable_time(time); }

View whole_box(const RunFrame& frame, const Place& place) {
    const Vec3 extent = frame.max - frame.min;
    const Vec3 middle = 0.5 * (frame.min + frame.max);
    const double scale = std::min(place.width / extent.x, place.height / extent.z);
    const double width = extent.x * scale, height = extent.z * scale;
    return {{place.left + (place.width - width) / 2, place.top + (place.height - height) / 2, width, height},
            middle.x,
            frame.centre.y,
            middle.z,
            extent.z};
}

double bar_length(const View& view) { return round_number(view.place.width * metres_per_pixel(view) / 3); }

void add_colour_bar(Sheet& sheet, const Place& place, vtkScalarsToColors* colours, double least,
                    double most) {
    std::vector<Colour> bands(static_cast<std::size_t>(place.height));
    for (std::size_t i = 0; i < bands.size(); ++i) {
        const double fraction = (static_cast<double>(i) + 0.5) / static_cast<double>(bands.size());
        std::array<double, 3> rgb;
        colours->GetColor(most - (most - least) * fraction, rgb.data());
        bands[i] = {rgb[0], rgb[1], rgb[2]};
    }
    add_bands(sheet, place, bands);
    add_outline(sheet, place, border_colour, 1);
    const std::vector<double> ticks = round_ticks(least, most, 6);
    for (const double value : ticks) {
        const double y = place.top + place.height * (most - value) / (most - least);
        add_filled(sheet, {place.left + place.width, y - 0.75, 7, 1.5}, border_colour);
        add_text(sheet, place.left + place.width + 12, y, readable(value, digits_for(ticks)),
                 {.size = 18, .align = 0});
    }
}

}  // namespace kropla::pictures
