#pragma once

#include <optional>
#include <string>
#include <vector>

namespace kropla {

/// One quantity of a chart: a value per place on the x axis. Not finite: not drawn.
struct Series {
    std::string name;
    std::vector<double> values;
    std::string colour = {};  // such as "#cf4446"; empty: of the page, which has three for a chart
};

/// Times in the unit that suits them, and what the axis is called.
struct TimeAxis {
    std::vector<double> values;
    std::string title;
};
/// Of times [s], ascending: "time [ms]".
[[nodiscard]] TimeAxis time_axis(std::vector<double> seconds);

/// A quantity over time, or over another, as it will be drawn.
struct Chart {
    enum class Marks {
        lines,
        columns  ///< from zero; several series are stacked
    };
    std::string title;
    std::string unit;       // of the values; empty: none
    std::vector<double> x;  // ascending
    std::string x_title;    // with its unit
    std::vector<Series> series;
    Marks marks = Marks::lines;
    std::optional<double> limit = {};  // drawn as a line of its own, "limit"
};

/// The chart as an HTML figure: title, legend, inline SVG whose colours are the page's. Rows beyond some
/// hundreds are drawn together, each place showing the largest of its rows; hovering shows the values.
[[nodiscard]] std::string draw_chart(const Chart& chart);

/// Lines of one chart that can be told apart.
inline constexpr std::size_t most_lines = 12;
/// Of `count` lines at most so many, evenly chosen.
[[nodiscard]] std::vector<std::size_t> chosen_lines(std::size_t count);
/// What is said of lines that are not all drawn: "12 of 40 bodies, evenly chosen", as a paragraph; empty if all are.
[[nodiscard]] std::string not_all_lines(std::size_t count, const char* what);
/// Gives lines colours from dark to light where the page has not enough of its own.
void colour_lines(std::vector<Series>& series);

}  // namespace kropla
