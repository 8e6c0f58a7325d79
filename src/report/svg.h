#pragma once

#include "report/point2.h"

#include <span>
#include <string>
#include <vector>

namespace kropla {

/// A coordinate of a drawing, to a tenth of a pixel: "12.3", "-4", "0".
[[nodiscard]] std::string pixels(double value);

/// A number for reading, `digits` of it: "0.00123", "9.87", "1.2e+09", "49481".
[[nodiscard]] std::string readable(double value, int digits = 4);
/// A count, its thousands apart: "49 481".
[[nodiscard]] std::string readable_count(double value);
/// A time [s] in the unit that suits it: "12.5 ms", "3 min 20 s".
[[nodiscard]] std::string readable_time(double seconds);

/// The path data of a closed polygon: "M1,2 3,4 5,6z".
[[nodiscard]] std::string polygon_path(std::span<const Point2> corners);
/// The path data of a line through the points, interrupted where one is not finite.
[[nodiscard]] std::string line_path(std::span<const Point2> points);

/// Round numbers (1, 2, 5 times powers of ten apart) that cover least ... most, at most `count` of them.
[[nodiscard]] std::vector<double> round_ticks(double least, double most, int count);

/// As many digits as tell ticks apart, from five to eight.
[[nodiscard]] int digits_for(std::span<const double> ticks);
/// Are the ends of the range the same to the digits at its ticks?
[[nodiscard]] bool is_flat(double least, double most);

/// A colour of the map "inferno", black over red to light yellow and even to the eye, at 0 ... 1: "#cf4446".
/// By van der Walt and Smith for matplotlib (CC0), linear between ten of its colours.
[[nodiscard]] std::string inferno(double fraction);
/// A map of light colours, yellow over green to blue, on which dark arrows are seen: seven of the nine
/// colours "YlGnBu" of ColorBrewer (Brewer, Harrower; Apache License 2.0).
[[nodiscard]] std::string light_blues(double fraction);
/// A map for what has a sign, blue over white at 0.5 to red: "RdBu" of ColorBrewer, turned over.
[[nodiscard]] std::string blue_to_red(double fraction);

}  // namespace kropla
