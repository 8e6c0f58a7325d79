#include "report/sweep_page.h"

#include "io/file.h"
#include "io/xml.h"
#include "report/chart.h"
#include "report/html.h"
#include "report/run_files.h"
#include "report/svg.h"
#include "report/sweep_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace kropla {
namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

std::optional<double> number_of(const std::string& cell) {
    double value = 0;
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
    return error == std::errc() && end == cell.data() + cell.size() ? std::optional(value) : std::nullopt;
}

bool differs(const std::vector<std::string>& cells) {
    std::set<std::string> known(cells.begin(), cells.end());
    known.erase("");  // of runs that have no step
    return known.size() > 1;
}

std::vector<std::string> values_of(const SweepFile& sweep, std::size_t key) {
    std::vector<std::string> values;
    for (const SweptRun& run : sweep.runs) values.push_back(run.values[key]);
    return values;
}

/// The keys that have several values.
std::vector<std::size_t> swept_keys(const SweepFile& sweep) {
    std::vector<std::size_t> keys;
    for (std::size_t key = 0; key < sweep.keys.size(); ++key)
        if (differs(values_of(sweep, key))) keys.push_back(key);
    return keys;
}

/// The axis of the first key that has several values: as numbers, or where they are none, counted.
class ParameterAxis {
public:
    ParameterAxis(const SweepFile& sweep, std::size_t key) : key_(key), title_(sweep.keys[key]) {
        const std::vector<std::string> values = values_of(sweep, key);
        std::set<double> places;
        const auto is_number = [](const std::string& value) { return number_of(value).has_value(); };
        const bool are_numbers = std::ranges::all_of(values, is_number);
        for (const std::string& value : values) {
            const auto count = static_cast<int>(places_.size()) + 1;
            const bool is_new = places_.emplace(value, are_numbers ? *number_of(value) : count).second;
            if (is_new && !are_numbers) title_ += (count == 1 ? ": " : ", ") + std::to_string(count) + " " + value;
        }
        for (const auto& [value, place] : places_) places.insert(place);
        x_.assign(places.begin(), places.end());
    }

    [[nodiscard]] const std::vector<double>& x() const { return x_; }
    [[nodiscard]] const std::string& title() const { return title_; }
    [[nodiscard]] std::size_t place(const SweptRun& run) const {
        return static_cast<std::size_t>(std::ranges::lower_bound(x_, places_.at(run.values[key_])) - x_.begin());
    }

private:
    std::size_t key_;
    std::string title_;
    std::map<std::string, double> places_;
    std::vector<double> x_;
};

/// What a run is called in a chart over `key`: by the values of the others that differ.
std::string others(const SweepFile& sweep, const SweptRun& run, std::size_t key) {
    std::string name;
    for (const std::size_t other : swept_keys(sweep))
        if (other != key) name += (name.empty() ? "" : ", ") + sweep.keys[other] + " = " + run.values[other];
    return name;
}

Chart over_parameter(const SweepFile& sweep, const ParameterAxis& axis, std::size_t key, const Column& column) {
    Chart chart{column.name, column.unit, axis.x(), axis.title(), {}};
    for (std::size_t r = 0; r < sweep.runs.size(); ++r) {
        const std::string name = others(sweep, sweep.runs[r], key);
        auto series = std::ranges::find(chart.series, name, &Series::name);
        if (series == chart.series.end())
            series = chart.series.insert(series, {name, std::vector<double>(axis.x().size(), no_number)});
        if (sweep.runs[r].code == 0)
            series->values[axis.place(sweep.runs[r])] = number_of(column.cells[r]).value_or(no_number);
    }
    std::vector<Series> shown;
    for (const std::size_t s : chosen_lines(chart.series.size())) shown.push_back(chart.series[s]);
    if (shown.size() == 1) shown.front().name = column.name;
    chart.series = std::move(shown);
    colour_lines(chart.series);
    return chart;
}

/// The steps of a run that has some.
struct Steps {
    std::string name;
    Table table;
    std::vector<double> time;  // [s]
};

std::vector<Steps> read_steps(const std::filesystem::path& dir, const SweepFile& sweep) {
    std::vector<Steps> all;
    for (const SweptRun& run : sweep.runs) {
        const std::filesystem::path file = dir / run.name / "steps.csv";
        if (!std::filesystem::exists(file)) continue;
        Table table = read_table(file);
        std::vector<double> time = numbers(table, "time");
        if (!time.empty()) all.push_back({run.name, std::move(table), std::move(time)});
    }
    return all;
}

/// The values at other times, linear between; none before the first and after the last.
std::vector<double> at_times(const std::vector<double>& times, const std::vector<double>& t,
                             const std::vector<double>& v) {
    constexpr double same = 1e-9;  // of the time: rounding
    std::vector<double> values;
    for (const double time : times) {
        const auto next = static_cast<std::size_t>(std::ranges::lower_bound(t, time * (1 - same)) - t.begin());
        if (next < t.size() && t[next] <= time * (1 + same)) values.push_back(v[next]);
        else if (next == 0 || next == t.size()) values.push_back(no_number);
        else values.push_back(std::lerp(v[next - 1], v[next], (time - t[next - 1]) / (t[next] - t[next - 1])));
    }
    return values;
}

/// Over the times of the run that went farthest, with the most steps.
Chart over_time(const std::vector<Steps>& runs, const Column& column) {
    const auto& longest = *std::ranges::max_element(
        runs, {}, [](const Steps& run) { return std::pair(run.time.back(), run.time.size()); });
    const TimeAxis axis = time_axis(longest.time);
    Chart chart{column.name, column.unit, axis.values, axis.title, {}};
    for (const std::size_t r : chosen_lines(runs.size()))
        if (has_column(runs[r].table, column.name))
            chart.series.push_back(
                {runs[r].name, at_times(longest.time, runs[r].time, numbers(runs[r].table, column.name))});
    colour_lines(chart.series);
    return chart;
}

std::string charts(const std::string& title, const std::string& note, const std::string& drawn) {
    if (drawn.empty()) return {};
    return "<section><h2>" + escaped(title) + "</h2>" + note + "<div class=\"charts\">" + drawn + "</div></section>\n";
}

/// The run's folder, leading to its page if it has one. Names of folders have % of their own.
std::string link(const std::filesystem::path& dir, const std::string& folder) {
    if (!std::filesystem::exists(dir / folder / "report.html")) return escaped(folder);
    std::string address;
    for (const char c : folder) address += c == '%' ? "%25" : std::string(1, c);
    return "<a href=\"" + escaped(address) + "/report.html\">" + escaped(folder) + "</a>";
}

std::string result(int code) {
    constexpr int interrupted = 130;
    return code == 0 ? "done" : code == interrupted ? "interrupted" : "failed, exit code " + std::to_string(code);
}

std::string cell_of(const std::string& cell) {
    const auto number = number_of(cell);
    return number ? readable(*number, 5) : escaped(cell);
}

std::string draw_table(const std::filesystem::path& dir, const SweepFile& sweep,
                       const std::vector<const Column*>& differing) {
    std::vector<std::string> head = {"run"};
    for (const std::string& key : sweep.keys) head.push_back(escaped(key));
    head.insert(head.end(), {"result", "wall time"});
    for (const Column* column : differing)
        head.push_back(escaped(column->name + (column->unit.empty() ? "" : " [" + column->unit + "]")));
    std::string html = "<section><h2>Runs</h2><p class=\"soft\">With what differs at their last steps.</p>"
                       "<div class=\"wide\"><table>" + table_row("th", head);
    for (std::size_t r = 0; r < sweep.runs.size(); ++r) {
        const SweptRun& run = sweep.runs[r];
        std::vector<std::string> cells = {link(dir, run.name)};
        for (const std::string& value : run.values) cells.push_back(escaped(value));
        cells.insert(cells.end(), {result(run.code), readable_time(run.seconds)});
        for (const Column* column : differing) cells.push_back(cell_of(column->cells[r]));
        html += table_row("td", cells);
    }
    return html + "</table></div></section>\n";
}

std::string draw_head(const std::string& name, const SweepFile& sweep) {
    const auto count = [&](auto is) { return std::ranges::count_if(sweep.runs, is, &SweptRun::code); };
    const auto done = count([](int code) { return code == 0; });
    const auto failed = count([](int code) { return code != 0 && code != 130; });
    double seconds = 0;
    for (const SweptRun& run : sweep.runs) seconds += run.seconds;
    const bool all_done = done == std::ssize(sweep.runs);
    const char* kind = all_done ? "good" : failed > 0 ? "bad" : "unfinished";
    const std::string number = readable_count(static_cast<double>(sweep.runs.size()));
    std::string text = all_done ? "All " : readable_count(static_cast<double>(done)) + " of ";
    text += number + " runs are done";
    if (failed > 0) text += ", " + readable_count(static_cast<double>(failed)) + " failed";
    return "<h1>Sweep: " + escaped(name) + "</h1><p class=\"verdict " + kind + "\">" + text +
           "</p><div class=\"tiles\">" + tile("runs", number) + tile("wall time of all", readable_time(seconds)) +
           "</div>\n";
}

std::string draw_over_parameter(const SweepFile& sweep, const std::vector<const Column*>& differing) {
    const auto keys = swept_keys(sweep);
    if (keys.empty()) return {};
    const ParameterAxis axis(sweep, keys.front());
    std::set<std::string> lines;
    for (const SweptRun& run : sweep.runs) lines.insert(others(sweep, run, keys.front()));
    std::string drawn;
    for (const Column* column : differing) drawn += draw_chart(over_parameter(sweep, axis, keys.front(), *column));
    const std::string note = "<p class=\"soft\">At the last step of the runs that are done.</p>";
    return charts("Over " + sweep.keys[keys.front()], note + not_all_lines(lines.size(), "lines"), drawn);
}

std::string draw_over_time(const std::filesystem::path& dir, const SweepFile& sweep,
                           const std::vector<const Column*>& differing) {
    const std::vector<Steps> runs = read_steps(dir, sweep);
    if (runs.empty()) return {};
    std::string drawn;
    for (const Column* column : differing)
        if (column->name != "step" && column->name != "time") drawn += draw_chart(over_time(runs, *column));
    return charts("Over time", not_all_lines(runs.size(), "runs"), drawn);
}

}  // namespace

void write_sweep_report(const std::filesystem::path& dir) {
    const SweepFile sweep = read_sweep_file(dir);
    std::vector<const Column*> differing;
    for (const Column& column : sweep.last)
        if (differs(column.cells)) differing.push_back(&column);
    const std::string html = draw_head(folder_name(dir), sweep) + draw_table(dir, sweep, differing) +
                             draw_over_parameter(sweep, differing) + draw_over_time(dir, sweep, differing) +
                             "<p class=\"soft\">Drawn from sweep.csv and the files of the runs; <code>kropla "
                             "report</code> draws it again.</p>";
    write_file(dir / sweep_page_name, html_page(folder_name(dir), html));
}

}  // namespace kropla
