#include "report/page.h"

#include "io/file.h"
#include "io/xml.h"
#include "report/chart.h"
#include "report/cuts.h"
#include "report/ending.h"
#include "report/html.h"
#include "report/results.h"
#include "report/results_page.h"
#include "report/run_files.h"
#include "report/summary.h"
#include "report/svg.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

namespace kropla {
namespace {

/// A quantity of steps.csv and what it is called on the page.
struct Source {
    const char* name;
    std::string column;
};

/// Draws charts of one run's steps, all over the same axis of time.
class Charts {
public:
    explicit Charts(const Table& steps) : steps_(steps), time_(time_axis(numbers(steps, "time"))) {}

    /// In the unit that suits the values, which are `scale` times as large in `unit` as in the file.
    [[nodiscard]] Chart chart(std::string title, const std::string& unit, Chart::Marks marks,
                              std::initializer_list<Source> sources, double scale = 1) const {
        Chart c{std::move(title), unit, time_.values, time_.title, {}, marks};
        double size = 0;
        for (const Source& source : sources) {
            c.series.push_back({source.name, numbers(steps_, source.column)});
            for (const double value : c.series.back().values) size = std::max(size, std::abs(value));
        }
        const ScaledUnit suits = unit_for(size, unit);
        c.unit = suits.name;
        for (Series& s : c.series)
            for (double& value : s.values) value *= scale * suits.scale;
        return c;
    }

    /// As columns; empty if a column is missing, or none of them ever has anything.
    [[nodiscard]] std::string columns(std::string title, const std::string& unit, std::initializer_list<Source> sources,
                                      double scale = 1) const {
        const auto is_known = [&](const Source& source) { return has_column(steps_, source.column); };
        const auto is_zero = [](double value) { return value == 0; };
        const auto is_empty = [&](const Source& source) {
            return std::ranges::all_of(numbers(steps_, source.column), is_zero);
        };
        if (!std::ranges::all_of(sources, is_known) || std::ranges::all_of(sources, is_empty)) return {};
        return draw_chart(chart(std::move(title), unit, Chart::Marks::columns, sources, scale));
    }

private:
    const Table& steps_;
    TimeAxis time_;
};

/// The largest size of a value in the columns whose names begin and end so; 0 without such a column.
double largest_in(const Table& steps, std::string_view begin, std::string_view end) {
    double most = 0;
    for (const Column& column : steps.columns) {
        if (!column.name.starts_with(begin) || !column.name.ends_with(end)) continue;
        for (const double value : numbers(steps, column.name)) most = std::max(most, std::abs(value));
    }
    return most;
}

/// What the transfer missed and moved, where that is more than rounding.
std::string draw_transfer(const Table& steps, const Charts& of) {
    std::string html;
    if (has_column(steps, "energy_transfer_error") && !is_rounding(largest_in(steps, "energy_transfer_error", ""), 1))
        html += draw_chart(of.chart("Error of the transfer, share of the energy", "", Chart::Marks::lines,
                                    {{"error", "energy_transfer_error"}}));
    if (!is_rounding(largest_in(steps, "energy_limited", ""), largest_in(steps, "temperature_max_", "")))
        html += of.columns("Largest correction in the transfer", "K", {{"correction", "energy_limited"}});
    return html;
}

std::string draw_charts(const RunFiles& run, const RunSummary& summary) {
    const Charts of(run.steps);
    constexpr auto lines = Chart::Marks::lines;
    Chart aspect =
        of.chart("Aspect ratio R/r", "", lines,
                 {{"worst cell", "max_aspect_ratio"}, {"99.9 % of cells below", "p999_aspect_ratio"}});
    aspect.limit = summary.floor;
    std::string html = draw_chart(aspect);
    html += draw_chart(
        of.chart("Dihedral angles", "°", lines, {{"least", "min_dihedral"}, {"largest", "max_dihedral"}}));
    html += draw_chart(of.chart("Tets", "", lines, {{"tets", "tets"}}));
    html += draw_chart(of.chart("Vertices", "", lines, {{"vertices", "vertices"}}));
    html += of.columns("Cells touched by a step", "%", {{"touched", "touched_fraction"}}, 100);
    html += of.columns("Cells in the transfer", "%", {{"in the transfer", "transferred_fraction"}}, 100);
    html += of.columns("Swaps", "", {{"swaps", "swaps"}});
    html += of.columns("Splits and collapses", "", {{"splits", "splits"}, {"collapses", "collapses"}});
    html += of.columns("Remeshes", "", {{"local", "local_remeshes"}, {"global", "global_remeshes"}});
    html += draw_transfer(run.steps, of);
    html += of.columns(
        "Computing time of a step", "s",
        {{"mesh", "mesh_seconds"}, {"simulation", "simulate_seconds"}, {"transfer", "transfer_seconds"}});
    return "<h3>Over time</h3><div class=\"charts\">" + html + "</div>";
}

/// How the flow was solved for; empty without one.
std::string draw_solver(const Table& steps) {
    if (!has_column(steps, "courant") || steps.rows == 0) return {};
    const Charts of(steps);
    const auto largest = [&](const char* column) { return largest_in(steps, column, column); };
    const auto sum = [&](const char* column) {
        const std::vector<double> all = numbers(steps, column);
        return std::accumulate(all.begin(), all.end(), 0.0);
    };
    const auto in_step = [&](const char* column) {
        return readable(sum(column) / static_cast<double>(steps.rows), 3) + " in the mean, " +
               readable_count(largest(column)) + " at most";
    };
    const std::string table =
        table_row("td", {"largest Courant number", readable(largest("courant"), 3)}) +
        table_row("td",
                  {"rounds of a step, until bodies go where the flow takes them", in_step("flow_rounds")}) +
        table_row("td", {"linear systems of a step, in its last round", in_step("flow_passes")}) +
        table_row("td", {"iterations of the linear solver in these", in_step("flow_iterations")}) +
        table_row("td", {"computing time of the simulation", readable_time(sum("simulate_seconds"))});
    const std::string charts =
        draw_chart(of.chart("Courant number: heights of a cell crossed in a step, at most", "",
                            Chart::Marks::lines, {{"Courant number", "courant"}})) +
        draw_chart(of.chart("Rounds of a step, and linear systems in the last", "", Chart::Marks::lines,
                            {{"rounds", "flow_rounds"}, {"linear systems", "flow_passes"}})) +
        of.columns("Iterations of the linear solver in a step", "", {{"iterations", "flow_iterations"}});
    return "<section><h2>Solver of the flow</h2><table>" + table + "</table><div class=\"charts\">" + charts +
           "</div></section>\n";
}

std::string draw_head(const RunFiles& run, const RunSummary& s) {
    const Verdict v = verdict(s);
    const char* kind = v.kind == Verdict::Kind::good  ? "good"
                       : v.kind == Verdict::Kind::bad ? "bad"
                                                      : "unfinished";
    return "<h1>Run: " + escaped(run.name) + "</h1><p class=\"verdict " + kind + "\">" + escaped(v.text) + "</p>";
}

std::string draw_tiles(const RunFiles& run, const RunSummary& s) {
    const std::string floor = s.floor ? " (limit " + readable(*s.floor, 3) + ")" : "";
    return "<div class=\"tiles\">" + tile("steps", readable_count(s.steps)) +
           tile("worst aspect ratio R/r" + floor, s.steps > 0 ? readable(s.worst_aspect_ratio, 4) : "–") +
           tile(s.refused == 1 ? "refused attempt" : "refused attempts", readable_count(s.refused)) +
           tile("computing time of the mesh", readable_time(s.mesh_seconds)) +
           (has_column(run.steps, "energy_integral") || has_column(run.steps, "courant")
                ? tile("of the simulation", readable_time(s.simulate_seconds)) +
                      tile("of the transfer", readable_time(s.transfer_seconds))
                : "") +
           "</div>";
}

/// How far the mesh misses a size, for reading.
std::string off_by(double share) {
    return is_rounding(share, 1) ? "the same to rounding" : "off by " + readable(share, 1) + " of it";
}

/// The sizes of the bodies, as asked for and as the mesh has them.
std::string draw_sizes(const RunFiles& run) {
    if (!run.bodies || run.bodies->rows == 0) return {};
    const Table& bodies = *run.bodies;
    const auto of = [&](const char* column) { return numbers(bodies, column); };
    const auto number = of("body"), a = of("semi_axis_1"), b = of("semi_axis_2"), c = of("semi_axis_3"),
               volume = of("volume"), of_mesh = of("mesh_volume"), triangles = of("triangles"),
               edge = of("mean_edge");
    const auto name = std::ranges::find(bodies.columns, "name", &Column::name);
    std::string html = "<h3>Sizes of the bodies</h3><div class=\"wide\"><table>" +
                       table_row("th", {"body", "semi-axes", "volume", "volume of the mesh", "triangles of its surface",
                                        "their mean edge"});
    for (std::size_t i = 0; i < number.size(); ++i) {
        const auto [scale, unit] = unit_for(std::max({a[i], b[i], c[i]}), "m");
        const std::string axes = readable(a[i] * scale) + ", " + readable(b[i] * scale) + ", " + readable(c[i] * scale);
        html += table_row("td", {name != bodies.columns.end() ? escaped(name->cells[i]) : readable_count(number[i]),
                                 axes + " " + unit, with_unit(volume[i], "m^3"), off_by(of_mesh[i] / volume[i] - 1),
                                 readable_count(triangles[i]), with_unit(edge[i], "m", 3)});
    }
    return html + "</table></div>\n";
}

std::string draw_figures(const RunFiles& run, const RunSummary& summary) {
    std::string html = "<h3>Figures</h3><table>";
    for (const auto& [name, value] : figures(run, summary)) {
        html += "<tr><td>" + escaped(name) + "</td><td>" + escaped(value) + "</td></tr>";
    }
    return html + "</table>\n";
}

/// What is known of a run once it has begun: what came out, then the mesh.
std::string draw_steps(const RunFiles& run, const RunSummary& summary, const PageOptions& options) {
    CutPictures cuts{"<p class=\"soft\">Its pictures are not drawn, as the run was interrupted: <code>kropla "
                     "report</code> draws them.</p>",
                     ""};
    if (options.cuts) cuts = draw_cuts(run, options.watch);
    return draw_results(results_of(run), cuts.field) + draw_solver(run.steps) + "<section><h2>Mesh</h2>" +
           draw_tiles(run, summary) + draw_charts(run, summary) + '\n' + cuts.mesh + '\n' + draw_sizes(run) +
           draw_figures(run, summary) + "</section>\n<section><h2>The case</h2><pre>" +
           escaped(run.case_text) + "</pre></section>\n";
}

}  // namespace

void write_report(const std::filesystem::path& dir, const PageOptions& options) {
    const RunFiles run = read_run_files(dir);
    const RunSummary summary = summarise_run(run);
    std::string html = draw_head(run, summary) + '\n' + draw_ending(run);
    if (!run.steps.columns.empty()) html += draw_steps(run, summary, options);
    html += "<p class=\"soft\">Drawn from the files of the run; <code>kropla report</code> draws it again.</p>";
    write_file(dir / "report.html", html_page(run.name, html), options.watch);
}

}  // namespace kropla
