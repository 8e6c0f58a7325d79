#include "report/picture.h"

#include "io/xml.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

namespace kropla {
namespace {

constexpr double width = 300;  // [pixels] of a picture
constexpr double mark_radius = 13;  // [pixels]
constexpr int bands = 32;      // of colour
constexpr int body_classes = 4;

/// From the plane [m] to the drawing.
struct Drawing {
    CutWindow window;
    double scale;  // [pixels/m]
    double height;
};

Drawing drawing_of(const CutWindow& window) {
    const double scale = width / (window.max.x - window.min.x);
    return {window, scale, (window.max.y - window.min.y) * scale};
}

Point2 on_drawing(const Drawing& drawing, Point2 p) {
    return {(p.x - drawing.window.min.x) * drawing.scale, (drawing.window.max.y - p.y) * drawing.scale};
}

std::vector<Point2> on_drawing(const Drawing& drawing, const CutPolygon& polygon) {
    std::vector<Point2> places;
    for (const CutCorner& corner : corners(polygon)) places.push_back(on_drawing(drawing, corner.place));
    return places;
}

/// Whether anything of it may lie in the window.
bool seen(const CutPolygon& polygon, const CutWindow& window) {
    const auto all = [&](auto outside) {
        return std::ranges::all_of(corners(polygon), outside, &CutCorner::place);
    };
    return !all([&](Point2 p) { return p.x < window.min.x; }) &&
           !all([&](Point2 p) { return p.x > window.max.x; }) &&
           !all([&](Point2 p) { return p.y < window.min.y; }) &&
           !all([&](Point2 p) { return p.y > window.max.y; });
}

bool is_within(const CutWindow& window, Point2 p) {
    return p.x >= window.min.x && p.x <= window.max.x && p.y >= window.min.y && p.y <= window.max.y;
}

std::string opening(const Drawing& drawing, const char* kind) {
    return std::string("<svg class=\"") + kind + "\" viewBox=\"0 0 " + pixels(width) + ' ' +
           pixels(drawing.height) + "\" role=\"img\">";
}

/// Of the cells in one colour: a region's tets, or its prisms.
std::string cells_class(Region region, bool of_prisms) {
    const int number = region == surroundings ? 0 : 1 + (region.value - 1) % body_classes;
    std::string name = of_prisms ? "p" : "r";
    return name += std::to_string(number);
}

struct ValuedPoint {
    Point2 place;
    double value;
};

/// The part of a convex polygon whose values are at least `level`, or with `below` at most [Sutherland,
/// Hodgman 1974].
std::vector<ValuedPoint> clipped(const std::vector<ValuedPoint>& polygon, double level, bool below) {
    const double sign = below ? -1 : 1;
    std::vector<ValuedPoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const ValuedPoint &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = sign * (p.value - level), at_q = sign * (q.value - level);
        if (at_p >= 0) kept.push_back(p);
        if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
            const double share = at_p / (at_p - at_q);
            kept.push_back(
                {{p.place.x + share * (q.place.x - p.place.x), p.place.y + share * (q.place.y - p.place.y)},
                 level});
        }
    }
    return kept;
}

int band_of(double value, double least, double most) {
    return std::clamp(static_cast<int>(std::floor((value - least) / (most - least) * bands)), 0, bands - 1);
}

std::string band_colour(const ColourScale& scale, int band) { return scale.colour((band + 0.5) / bands); }

/// Adds the polygon, divided at the levels between bands, to the paths of the bands.
void add_in_bands(const std::vector<ValuedPoint>& polygon, double least, double most,
                  std::array<std::string, bands>& paths) {
    const auto [low, high] = std::ranges::minmax(polygon, {}, &ValuedPoint::value);
    const int first = band_of(low.value, least, most), last = band_of(high.value, least, most);
    for (int band = first; band <= last; ++band) {
        std::vector<ValuedPoint> part = polygon;
        if (band > first) part = clipped(part, least + (most - least) * band / bands, false);
        if (band < last) part = clipped(part, least + (most - least) * (band + 1) / bands, true);
        if (part.size() < 3) continue;
        std::vector<Point2> places;
        for (const ValuedPoint& p : part) places.push_back(p.place);
        paths[static_cast<std::size_t>(band)] += polygon_path(places);
    }
}

/// The bands of a field, a path each.
std::string field_paths(std::span<const CutPolygon> cut, const Array<Vertex, double>& field,
                        const ColourScale& scale, const Drawing& drawing) {
    std::array<std::string, bands> paths;
    for (const CutPolygon& polygon : cut) {
        if (!seen(polygon, drawing.window)) continue;
        std::vector<ValuedPoint> valued;
        for (const CutCorner& corner : corners(polygon))
            valued.push_back({on_drawing(drawing, corner.place), value_at(corner, field)});
        add_in_bands(valued, scale.least, scale.most, paths);
    }
    std::string svg;
    for (int band = 0; band < bands; ++band) {
        const std::string& path = paths[static_cast<std::size_t>(band)];
        if (path.empty()) continue;
        const std::string colour = band_colour(scale, band);
        svg += "<path fill=\"" + colour + "\" stroke=\"" + colour + "\" d=\"" + path + "\"/>";
    }
    return svg;
}

/// Its middle is in its place. The head is a part of it, but no more than a size that is seen well.
void add_arrow(const Drawing& drawing, const Arrow& arrow, std::string& shafts, std::string& heads) {
    constexpr double most_head = 5, least_length = 4;  // [pixels]
    const double length = arrow.length * drawing.scale, head = std::min(most_head, 0.6 * length);
    if (length < least_length) return;
    const Point2 middle = on_drawing(drawing, arrow.place), along = {arrow.direction.x, -arrow.direction.y};
    const auto shifted = [&](double forth, double aside) {
        return Point2{middle.x + forth * along.x - aside * along.y,
                      middle.y + forth * along.y + aside * along.x};
    };
    shafts += line_path(std::array{shifted(-length / 2, 0), shifted(length / 2 - head / 2, 0)});
    heads += polygon_path(
        std::array{shifted(length / 2, 0), shifted(length / 2 - head, 0.4 * head), shifted(length / 2 - head, -0.4 * head)});
}

}  // namespace

ColourScale scale_over(double least, double most, std::function<std::string(double)> colour) {
    if (!is_flat(least, most)) return {least, most, std::move(colour)};
    if (most == 0) return {0, 1, std::move(colour)};
    const double around = 0.05 * std::abs(most);
    return {least - around, most + around, std::move(colour)};
}

ColourScale signed_scale(double least, double most) {
    ColourScale scale = scale_over(least, most);
    const double size = std::max(std::abs(scale.least), std::abs(scale.most));
    scale.colour = [from = scale.least, to = scale.most, size](double fraction) {
        return blue_to_red(0.5 + 0.5 * (from + fraction * (to - from)) / size);
    };
    return scale;
}

CutWindow extent(std::span<const CutPolygon> cut) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CutWindow window = {{infinity, infinity}, {-infinity, -infinity}};
    for (const CutPolygon& polygon : cut) {
        for (const CutCorner& corner : corners(polygon)) {
            const Point2 p = corner.place;
            window.min = {std::min(window.min.x, p.x), std::min(window.min.y, p.y)};
            window.max = {std::max(window.max.x, p.x), std::max(window.max.y, p.y)};
        }
    }
    return window;
}

CutWindow around(Point2 middle, double half_side) {
    return {{middle.x - half_side, middle.y - half_side}, {middle.x + half_side, middle.y + half_side}};
}

CutWindow narrowed(CutWindow window, std::span<const CutPolygon> cut, Point2 middle, std::size_t most) {
    const auto towards = [](double a, double b) { return b + 0.8 * (a - b); };
    while (static_cast<std::size_t>(std::ranges::count_if(
               cut, [&](const CutPolygon& polygon) { return seen(polygon, window); })) > most) {
        window = {{towards(window.min.x, middle.x), towards(window.min.y, middle.y)},
                  {towards(window.max.x, middle.x), towards(window.max.y, middle.y)}};
    }
    return window;
}

std::string draw_cells(std::span<const CutPolygon> cut, const CutWindow& window, std::optional<Point2> mark) {
    const Drawing drawing = drawing_of(window);
    std::map<std::pair<Region, bool>, std::string> paths;
    for (const CutPolygon& polygon : cut) {
        if (!seen(polygon, window)) continue;
        paths[{polygon.region, polygon.of_prism}] += polygon_path(on_drawing(drawing, polygon));
    }
    std::string svg = opening(drawing, "picture cells");
    for (const auto& [cells, path] : paths) {
        svg += "<path class=\"" + cells_class(cells.first, cells.second) + "\" d=\"" + path + "\"/>";
    }
    if (mark) {
        const Point2 at = on_drawing(drawing, *mark);
        svg += "<circle class=\"mark\" cx=\"" + pixels(at.x) + "\" cy=\"" + pixels(at.y) + "\" r=\"" +
               pixels(mark_radius) + "\"/>";
    }
    return svg + "</svg>";
}

std::string draw_field(std::span<const CutPolygon> cut, const Array<Vertex, double>& field,
                       const ColourScale& scale, const CutWindow& window) {
    const Drawing drawing = drawing_of(window);
    return opening(drawing, "picture field") + field_paths(cut, field, scale, drawing) + "</svg>";
}

std::string draw_flow(std::span<const CutPolygon> cut, const Array<Vertex, double>& field,
                      const ColourScale& scale, const CutWindow& window, std::span<const CutPolygon> solids,
                      std::span<const Arrow> arrows) {
    const Drawing drawing = drawing_of(window);
    std::string bodies, shafts, heads;
    for (const CutPolygon& polygon : solids)
        if (seen(polygon, window)) bodies += polygon_path(on_drawing(drawing, polygon));
    for (const Arrow& arrow : arrows)
        if (is_within(window, arrow.place)) add_arrow(drawing, arrow, shafts, heads);
    std::string svg = opening(drawing, "picture field") + field_paths(cut, field, scale, drawing);
    if (!bodies.empty())
        svg += "<path class=\"outline\" d=\"" + bodies + "\"/><path class=\"solid\" d=\"" + bodies + "\"/>";
    if (!shafts.empty())
        svg += "<path class=\"shaft\" d=\"" + shafts + "\"/><path class=\"head\" d=\"" + heads + "\"/>";
    return svg + "</svg>";
}

std::string draw_colour_bar(const std::string& title, const ColourScale& scale) {
    constexpr double bar_width = 420, left = 20, right = 400;
    std::string svg = "<svg class=\"bar\" viewBox=\"0 0 " + pixels(bar_width) + " 58\" role=\"img\">";
    for (int band = 0; band < bands; ++band) {
        const double step = (right - left) / bands;
        svg += "<rect fill=\"" + band_colour(scale, band) + "\" x=\"" + pixels(left + step * band) +
               "\" y=\"20\" width=\"" + pixels(step + 0.5) + "\" height=\"16\"/>";
    }
    svg += "<text class=\"tick\" x=\"" + pixels(left) + "\" y=\"14\">" + escaped(title) + "</text>";
    const std::vector<double> ticks = round_ticks(scale.least, scale.most, 6);
    for (const double value : ticks) {
        const double x = left + (right - left) * (value - scale.least) / (scale.most - scale.least);
        svg += "<text class=\"tick\" text-anchor=\"middle\" x=\"" + pixels(x) + "\" y=\"52\">" +
               readable(value, digits_for(ticks)) + "</text>";
    }
    return svg + "</svg>";
}

}  // namespace kropla
