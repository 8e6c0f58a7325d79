#include "report/chart.h"

#include "io/xml.h"
#include "report/svg.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace kropla {
namespace {

// The drawing [pixels]: as wide as a column of the page; room for numbers at the left and below.
constexpr double width = 420, height = 200, left = 60, right = 410, top = 8, bottom = 166;
constexpr std::size_t most_rows = 400;  // more would be narrower than a pixel

/// Where values are on the drawing.
struct Axes {
    double x_least, x_most, y_least, y_most;
};

Point2 on_drawing(const Axes& axes, double x, double y) {
    return {left + (right - left) * (x - axes.x_least) / (axes.x_most - axes.x_least),
            bottom - (bottom - top) * (y - axes.y_least) / (axes.y_most - axes.y_least)};
}

/// The largest by size of each group of `group` rows.
std::vector<double> largest_of_groups(const std::vector<double>& values, std::size_t group) {
    std::vector<double> result;
    for (std::size_t i = 0; i < values.size(); i += group) {
        const auto end = values.begin() + static_cast<std::ptrdiff_t>(std::min(i + group, values.size()));
        result.push_back(*std::max_element(values.begin() + static_cast<std::ptrdiff_t>(i), end,
                                           [](double a, double b) { return std::abs(a) < std::abs(b); }));
    }
    return result;
}

Chart thinned(Chart chart) {
    const std::size_t group = (chart.x.size() + most_rows - 1) / most_rows;
    if (group <= 1) return chart;
    chart.x = largest_of_groups(chart.x, group);
    for (Series& s : chart.series) s.values = largest_of_groups(s.values, group);
    return chart;
}

double stacked(const Chart& chart, std::size_t row) {
    double sum = 0;
    for (const Series& s : chart.series) sum += std::isfinite(s.values[row]) ? s.values[row] : 0;
    return sum;
}

struct Range {
    double least = std::numeric_limits<double>::infinity(), most = -std::numeric_limits<double>::infinity();
    void include(double value) {
        if (!std::isfinite(value)) return;
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

Range range_of_values(const Chart& chart) {
    Range range;
    if (chart.limit) range.include(*chart.limit);
    for (std::size_t row = 0; row < chart.x.size(); ++row) {
        if (chart.marks == Chart::Marks::columns) range.include(stacked(chart, row));
        else
            for (const Series& s : chart.series) range.include(s.values[row]);
    }
    if (chart.marks == Chart::Marks::columns) range.include(0);
    return range;
}

Axes axes_of(const Chart& chart) {
    Range y = range_of_values(chart);
    if (!(y.least <= y.most)) y = {0, 1};  // no value is finite
    const bool flat = is_flat(y.least, y.most);
    const double flat_margin = y.most == 0 ? 1 : 0.05 * std::abs(y.most);
    const double margin = flat ? flat_margin : 0.06 * (y.most - y.least);
    const double foot = chart.marks == Chart::Marks::columns && y.least == 0 ? 0 : margin;
    // Half a row of room at both ends, for the columns.
    const double half = chart.x.size() > 1 ? (chart.x.back() - chart.x.front()) /
                                                 (2 * static_cast<double>(chart.x.size() - 1))
                                           : std::max(0.5 * std::abs(chart.x.front()), 1e-12);
    return {chart.x.front() - half, chart.x.back() + half, y.least - foot, y.most + margin};
}

std::string text_at(Point2 at, const char* anchor, const std::string& text, const char* kind = "tick") {
    return std::string("<text class=\"") + kind + "\" x=\"" + pixels(at.x) + "\" y=\"" + pixels(at.y) +
           "\" text-anchor=\"" + anchor + "\">" + escaped(text) + "</text>";
}

std::string level_line(double y, const char* kind) {
    return std::string("<path class=\"") + kind + "\" d=\"M" + pixels(left) + ',' + pixels(y) + 'H' +
           pixels(right) + "\"/>";
}

std::string draw_axes(const Chart& chart, const Axes& axes) {
    std::string svg;
    const std::vector<double> ticks = round_ticks(axes.y_least, axes.y_most, 5);
    for (const double value : ticks) {
        const double y = on_drawing(axes, axes.x_least, value).y;
        svg += level_line(y, "grid") + text_at({left - 6, y + 4}, "end", readable(value, digits_for(ticks)));
    }
    for (const double value : round_ticks(axes.x_least, axes.x_most, 6)) {
        const double x = on_drawing(axes, value, axes.y_least).x;
        svg += "<path class=\"grid\" d=\"M" + pixels(x) + ',' + pixels(bottom) + "v4\"/>";
        svg += text_at({x, bottom + 17}, "middle", readable(value, 4));
    }
    return svg + text_at({(left + right) / 2, bottom + 32}, "middle", chart.x_title);
}

/// The attribute for a colour of its own.
std::string style(const char* what, const Series& series) {
    return series.colour.empty() ? "" : std::string(" style=\"") + what + ':' + series.colour + '"';
}

/// Has a point no neighbour that a line could lead to?
bool is_alone(const std::vector<Point2>& points, std::size_t i) {
    const auto is_drawn = [&](std::size_t k) { return k < points.size() && std::isfinite(points[k].y); };
    return is_drawn(i) && !is_drawn(i - 1) && !is_drawn(i + 1);  // before 0 is beyond the end
}

std::string draw_lines(const Chart& chart, const Axes& axes) {
    std::string svg;
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
        std::vector<Point2> points;
        for (std::size_t row = 0; row < chart.x.size(); ++row) {
            points.push_back(on_drawing(axes, chart.x[row], chart.series[s].values[row]));
        }
        const std::string place = std::to_string(s);
        svg += "<path class=\"line s" + place + '"' + style("stroke", chart.series[s]) + " d=\"" + line_path(points) +
               "\"/>";
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (!is_alone(points, i)) continue;
            svg += "<circle class=\"column s" + place + '"' + style("fill", chart.series[s]) + " r=\"3\" cx=\"" +
                   pixels(points[i].x) + "\" cy=\"" + pixels(points[i].y) + "\"/>";
        }
    }
    return svg;
}

double column_width(const Chart& chart) { return (right - left) / static_cast<double>(chart.x.size()); }

std::string draw_columns(const Chart& chart, const Axes& axes) {
    const double wide = column_width(chart) * 0.8;
    std::vector<double> base(chart.x.size(), 0.0);
    std::string svg;
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
        std::string path;
        for (std::size_t row = 0; row < chart.x.size(); ++row) {
            const double value = chart.series[s].values[row];
            if (!std::isfinite(value) || value == 0) continue;
            const Point2 foot = on_drawing(axes, chart.x[row], base[row]);
            const Point2 head = on_drawing(axes, chart.x[row], base[row] += value);
            path += 'M' + pixels(foot.x - wide / 2) + ',' + pixels(foot.y) + 'h' + pixels(wide) + 'V' +
                    pixels(head.y) + 'h' + pixels(-wide) + 'z';
        }
        svg += "<path class=\"column s" + std::to_string(s) + "\" d=\"" + path + "\"/>";
    }
    return svg;
}

/// Strips that show nothing but the values of their row when pointed at.
std::string draw_hints(const Chart& chart, const Axes& axes) {
    const double wide = column_width(chart);
    std::string svg = "<g class=\"hints\">";
    for (std::size_t row = 0; row < chart.x.size(); ++row) {
        std::string hint = chart.x_title + ": " + readable(chart.x[row]);
        for (const Series& s : chart.series) {
            hint += "\n" + s.name + ": " + readable(s.values[row], 5) +
                    (chart.unit.empty() ? "" : " " + chart.unit);
        }
        svg += "<rect x=\"" + pixels(on_drawing(axes, chart.x[row], 0).x - wide / 2) + "\" y=\"" +
               pixels(top) + "\" width=\"" + pixels(wide) + "\" height=\"" + pixels(bottom - top) +
               "\"><title>" + escaped(hint) + "</title></rect>";
    }
    return svg + "</g>";
}

std::string draw_legend(const Chart& chart) {
    std::string html = "<div class=\"legend\">";
    for (std::size_t s = 0; s < chart.series.size() && (chart.series.size() > 1 || chart.limit); ++s) {
        html += "<span><i class=\"swatch b" + std::to_string(s) + '"' + style("background", chart.series[s]) + "></i>" +
                escaped(chart.series[s].name) + "</span>";
    }
    if (chart.limit) {
        html += "<span><i class=\"swatch limit\"></i>limit " + readable(*chart.limit) + "</span>";
    }
    return html + "</div>";
}

}  // namespace

TimeAxis time_axis(std::vector<double> seconds) {
    const double end = seconds.empty() ? 1 : seconds.back();
    const auto [scale, unit] = unit_for(end, "s");
    for (double& t : seconds) t *= scale;
    return {std::move(seconds), "time [" + unit + "]"};
}

std::string draw_chart(const Chart& whole) {
    const Chart chart = thinned(whole);
    const std::string title =
        escaped(chart.title) + (chart.unit.empty() ? "" : " [" + escaped(chart.unit) + "]");
    std::string html = "<figure class=\"card\"><figcaption>" + title + "</figcaption>" + draw_legend(chart);
    if (chart.x.empty()) return html + "<p class=\"soft\">No step yet.</p></figure>";
    const Axes axes = axes_of(chart);
    html += "<svg viewBox=\"0 0 " + pixels(width) + ' ' + pixels(height) + "\" role=\"img\" aria-label=\"" +
            title + "\">";
    html += draw_axes(chart, axes);
    html += chart.marks == Chart::Marks::lines ? draw_lines(chart, axes) : draw_columns(chart, axes);
    if (chart.limit) html += level_line(on_drawing(axes, axes.x_least, *chart.limit).y, "limit");
    return html + draw_hints(chart, axes) + "</svg></figure>";
}

std::vector<std::size_t> chosen_lines(std::size_t count) {
    std::vector<std::size_t> all;
    const std::size_t most = std::min(count, most_lines);
    for (std::size_t i = 0; i < most; ++i) all.push_back(most == count ? i : i * (count - 1) / (most - 1));
    return all;
}

std::string not_all_lines(std::size_t count, const char* what) {
    if (count <= most_lines) return {};
    return "<p class=\"soft\">" + readable_count(most_lines) + " of " + readable_count(static_cast<double>(count)) +
           " " + what + ", evenly chosen.</p>";
}

void colour_lines(std::vector<Series>& series) {
    constexpr std::size_t of_page = 3;
    constexpr double dark = 0.3, light = 0.82;  // on white and on black
    const double step = (light - dark) / static_cast<double>(series.size() - 1);
    for (std::size_t i = 0; series.size() > of_page && i < series.size(); ++i)
        series[i].colour = inferno(dark + step * static_cast<double>(i));
}

}  // namespace kropla
