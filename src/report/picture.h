#pragma once

#include "report/arrows.h"
#include "report/section.h"
#include "report/svg.h"
#include <kropla/simulate/fields.h>

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kropla {

[[nodiscard]] CutWindow extent(std::span<const CutPolygon> cut);
[[nodiscard]] CutWindow around(Point2 middle, double half_side);

/// The window, drawn in towards `middle` until no more than `most` polygons are seen: drawings have to stay
/// small.
[[nodiscard]] CutWindow narrowed(CutWindow window, std::span<const CutPolygon> cut, Point2 middle,
                                 std::size_t most);

/// The cells of a cut as inline SVG, every region in its colour (class r0, r1, ... of the page), its prisms in
/// a shade of their own (p0, p1, ...); with a ring around `mark`, if it is given.
[[nodiscard]] std::string draw_cells(std::span<const CutPolygon> cut, const CutWindow& window,
                                     std::optional<Point2> mark = {});

/// The values between which colours go.
struct ColourScale {
    double least, most;
    std::function<std::string(double fraction)> colour = inferno;
};

/// Over the range; or, if values are the same to the digits at a scale, around them, so that they have one colour.
[[nodiscard]] ColourScale scale_over(double least, double most, std::function<std::string(double)> colour = inferno);
/// Likewise; white where values are zero, blue below and red above, as strong to both sides.
[[nodiscard]] ColourScale signed_scale(double least, double most);

/// A field on a cut as inline SVG, in bands of one colour each: exact level lines.
[[nodiscard]] std::string draw_field(std::span<const CutPolygon> cut, const Array<Vertex, double>& field,
                                     const ColourScale& scale, const CutWindow& window);

/// The same of a flow: cells of `solids` are grey, with an outline, and arrows show where it goes.
[[nodiscard]] std::string draw_flow(std::span<const CutPolygon> cut, const Array<Vertex, double>& field,
                                    const ColourScale& scale, const CutWindow& window,
                                    std::span<const CutPolygon> solids, std::span<const Arrow> arrows);

/// The colours of draw_field with numbers.
[[nodiscard]] std::string draw_colour_bar(const std::string& title, const ColourScale& scale);

}  // namespace kropla
