#include "report/page.h"

#include "io/file.h"
#include "io/xml.h"
#include "report/chart.h"
#include "report/cuts.h"
#include "report/ending.h"
#include "report/html.h"
#include "report/run_files.h"
#include "report/summary.h"
#include "report/svg.h"

#include <cmath>
#include <utility>

namespace kropla {
namespace {

/// A quantity of steps.csv and what it is called on the page.
struct Source {
    const char* name;
    const char* column;
};

/// Makes charts of one run's steps, all over the same axis of time.
class Charts {
public:
    explicit Charts(const Table& steps) : steps_(steps), time_(time_axis(numbers(steps, "time"))) {}

    [[nodiscard]] Chart chart(std::string title, std::string unit, Chart::Marks marks,
                              std::initializer_list<Source> sources, double scale = 1) const {
        Chart c{std::move(title), std::move(unit), time_.values, time_.title, {}, marks};
        for (const Source& source : sources) {
            c.series.push_back({source.name, numbers(steps_, source.column)});
            for (double& value : c.series.back().values) value *= scale;
        }
        return c;
    }

    /// The change of an integral against its first value, relative where that is not zero.
    [[nodiscard]] Chart drift(const Column& integral) const {
        const std::string field = integral.name.substr(0, integral.name.rfind('_'));
        Chart c = chart("Drift of the integral of " + field, integral.unit, Chart::Marks::lines,
                        {{field.c_str(), integral.name.c_str()}});
        std::vector<double>& values = c.series.front().values;
        const double first = values.empty() ? 0 : values.front();
        if (first != 0) c.unit = "relative";
        for (double& value : values) value = (value - first) / (first != 0 ? std::abs(first) : 1);
        return c;
    }

private:
    const Table& steps_;
    TimeAxis time_;
};

std::string draw_charts(const RunFiles& run, const RunSummary& summary) {
    const Charts of(run.steps);
    constexpr auto lines = Chart::Marks::lines, columns = Chart::Marks::columns;
    Chart aspect =
        of.chart("Aspect ratio R/r", "", lines,
                 {{"worst cell", "max_aspect_ratio"}, {"99.9 % of cells below", "p999_aspect_ratio"}});
    aspect.limit = summary.floor;
    std::string html = draw_chart(aspect);
    html += draw_chart(of.chart("Cells touched", "%", columns, {{"touched", "touched_fraction"}}, 100));
    if (has_column(run.steps, "transferred_fraction"))
        html += draw_chart(
            of.chart("Cells in the transfer", "%", columns, {{"in the transfer", "transferred_fraction"}}, 100));
    html += draw_chart(of.chart(
        "Time per step", "s", columns,
        {{"mesh", "mesh_seconds"}, {"simulation", "simulate_seconds"}, {"transfer", "transfer_seconds"}}));
    html += draw_chart(of.chart("Tets", "", lines, {{"tets", "tets"}}));
    html += draw_chart(of.chart("Vertices", "", lines, {{"vertices", "vertices"}}));
    html += draw_chart(
        of.chart("Dihedral angles", "°", lines, {{"least", "min_dihedral"}, {"largest", "max_dihedral"}}));
    html += draw_chart(of.chart("Swaps", "", columns, {{"swaps", "swaps"}}));
    html += draw_chart(
        of.chart("Splits and collapses", "", columns, {{"splits", "splits"}, {"collapses", "collapses"}}));
    html += draw_chart(
        of.chart("Remeshes", "", columns, {{"local", "local_remeshes"}, {"global", "global_remeshes"}}));
    for (const Column& column : run.steps.columns) {
        if (column.name.ends_with("_integral")) html += draw_chart(of.drift(column));
        if (const auto from = column.name.find("_from_body_"); from != std::string::npos) {
            const std::string field = column.name.substr(0, from), body = column.name.substr(from + 11);
            html += draw_chart(of.chart("Flux of " + field + " out of body " + body, column.unit, lines,
                                        {{field.c_str(), column.name.c_str()}}));
        }
        if (column.name.ends_with("_transfer_error")) {
            const std::string field =
                column.name.substr(0, column.name.size() - std::string("_transfer_error").size());
            html += draw_chart(of.chart("Error of the transfer of " + field, "relative", lines,
                                        {{field.c_str(), column.name.c_str()}}));
        }
        if (column.name.ends_with("_limited")) {
            html += draw_chart(of.chart("Largest value moved by the limiter", column.unit, columns,
                                        {{"moved", column.name.c_str()}}));
        }
    }
    return "<section><h2>Over time</h2><div class=\"charts\">" + html + "</div></section>";
}

std::string draw_head(const RunFiles& run, const RunSummary& s) {
    const Verdict v = verdict(s);
    const char* kind = v.kind == Verdict::Kind::good  ? "good"
                       : v.kind == Verdict::Kind::bad ? "bad"
                                                      : "unfinished";
    const std::string floor = s.floor ? " (limit " + readable(*s.floor, 3) + ")" : "";
    const std::string head = "<h1>Run: " + escaped(run.name) + "</h1><p class=\"verdict " + kind + "\">" +
                             escaped(v.text) + "</p>";
    if (run.steps.columns.empty()) return head;
    return head + "<div class=\"tiles\">" + tile("steps", readable_count(s.steps)) +
           tile("worst aspect ratio R/r" + floor, s.steps > 0 ? readable(s.worst_aspect_ratio, 4) : "–") +
           tile(s.refused == 1 ? "refused attempt" : "refused attempts", readable_count(s.refused)) +
           tile("mesh", readable_time(s.mesh_seconds)) +
           tile("simulation", readable_time(s.simulate_seconds)) +
           tile("transfer", readable_time(s.transfer_seconds)) + "</div>";
}

/// The sizes of the bodies, as asked for and as the mesh has them.
std::string draw_bodies(const RunFiles& run) {
    if (!run.bodies || run.bodies->rows == 0) return {};
    const auto of = [&](const char* column) { return numbers(*run.bodies, column); };
    const auto body = of("body"), a = of("semi_axis_1"), b = of("semi_axis_2"), c = of("semi_axis_3"),
               volume = of("volume"), of_mesh = of("mesh_volume"), triangles = of("triangles"),
               edge = of("mean_edge");
    std::string html = "<section><h2>Bodies</h2><table>" +
                       table_row("th", {"body", "semi-axes [m]", "volume [m³]", "volume of the mesh",
                                        "triangles", "their mean edge [m]"});
    for (std::size_t i = 0; i < body.size(); ++i) {
        const std::string axes = readable(a[i]) + ", " + readable(b[i]) + ", " + readable(c[i]),
                          off = "off by " + readable(of_mesh[i] / volume[i] - 1, 1) + " of it";
        html += table_row("td", {readable_count(body[i]), axes, readable(volume[i], 6), off,
                                 readable_count(triangles[i]), readable(edge[i], 3)});
    }
    return html + "</table></section>\n";
}

std::string draw_figures(const RunFiles& run, const RunSummary& summary) {
    std::string html = "<section><h2>Figures</h2><table>";
    for (const auto& [name, value] : figures(run, summary)) {
        html += "<tr><td>" + escaped(name) + "</td><td>" + escaped(value) + "</td></tr>";
    }
    return html + "</table></section>";
}

/// What is known of a run once it has begun.
std::string draw_steps(const RunFiles& run, const RunSummary& summary, const PageOptions& options) {
    const std::string cuts = options.cuts ? draw_cuts(run, options.watch)
                                          : "<section><h2>The mesh, cut</h2><p class=\"soft\">Not drawn, as the run was "
                                            "interrupted: <code>kropla report</code> draws it.</p></section>";
    return draw_charts(run, summary) + '\n' + cuts + '\n' + draw_bodies(run) + draw_figures(run, summary) +
           "\n<section><h2>The case</h2><pre>" + escaped(run.case_text) + "</pre></section>\n";
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
