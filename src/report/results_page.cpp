#include "report/results_page.h"

#include "io/xml.h"
#include "report/chart.h"
#include "report/html.h"
#include "report/svg.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace kropla {
namespace {

constexpr const char* nothing = "–";
constexpr std::size_t own_charts = 3;  // so many bodies have charts of their own, more share them

/// The scale of energies, with which a heat is compared.
double energy_size(const RunResults& results) { return results.energy ? results.energy->size : 0; }

/// "x_min" as it is said.
std::string spoken_face(std::string name) {
    std::ranges::replace(name, '_', ' ');
    return name;
}

/// Does a power [W] amount to anything over the run?
bool passes(const RunResults& results, const std::vector<double>& power) {
    double most = 0;
    for (const double watts : power) most = std::max(most, std::abs(watts));
    return !is_rounding(most * results.time.back(), energy_size(results));
}

std::string temperatures(const BodyResult& body) {
    if (body.mean.empty()) return nothing;
    const int decimals = decimals_to_tell(*body.start_mean, body.mean.back());
    return fixed(*body.start_mean, decimals) + " → " + fixed(body.mean.back(), decimals);
}

std::string extremes(const BodyResult& body) {
    if (body.mean.empty()) return nothing;
    const int decimals = decimals_to_tell(*body.least, *body.most);
    return fixed(*body.least, decimals) + " … " + fixed(*body.most, decimals);
}

double most_by_size(const std::vector<double>& values) {
    return *std::ranges::max_element(values, {}, [](double value) { return std::abs(value); });
}

std::string volume(const BodyResult& body) {
    const double change = body.volume.back() - body.volume.front();
    const std::string changed = is_rounding(change, body.volume.front())
                                    ? ""
                                    : ", changed by " + readable(100 * change / body.volume.front(), 2) + " %";
    return with_unit(body.volume.back(), "m^3") + changed;
}

std::string draw_bodies(const RunResults& results) {
    if (results.bodies.empty()) return {};
    const bool warm = !results.bodies.front().mean.empty();
    std::vector<std::string> head = {"body"};
    if (warm)
        head.insert(head.end(), {"mean temperature, start → end [K]", "least … most [K]", "heat given off",
                                 "at most"});
    head.insert(head.end(), {"centre, at the start", "at the end", "speed at the end", "volume"});
    std::string html = "<h3>Bodies</h3><div class=\"wide\"><table>" + table_row("th", head);
    for (const BodyResult& body : results.bodies) {
        std::vector<std::string> cells = {escaped(body.name)};
        if (warm) cells.insert(cells.end(), {temperatures(body), extremes(body)});
        if (warm && passes(results, body.heat_from))
            cells.insert(cells.end(), {with_unit(body.given_off, "J"), with_unit(most_by_size(body.heat_from), "W")});
        else if (warm) cells.insert(cells.end(), {nothing, nothing});
        const double size = length_scale(body);
        cells.insert(cells.end(), {place_with_unit(body.start_place, size), place_with_unit(body.place.back(), size),
                                   moves(body) ? with_unit(norm(body.velocity.back()), "m/s", 3) : "at rest",
                                   volume(body)});
        html += table_row("td", cells);
    }
    const char* taken = warm ? "<p class=\"soft\">Heat given off: what is conducted through the surface into the "
                               "surroundings; negative: into the body. What the surface itself sets free or radiates "
                               "is not in it.</p>"
                             : "";
    const char* first =
        results.start_known ? "" : "<p class=\"soft\">For the start stands the end of the first step.</p>";
    return html + "</table></div>" + taken + first;
}

std::string draw_faces(const RunResults& results) {
    if (results.faces.empty()) return {};
    std::string rows;
    for (const FaceResult& face : results.faces) {
        if (!passes(results, face.out)) continue;
        rows += table_row("td", {spoken_face(face.name), with_unit(face.out.back(), "W"), with_unit(face.total, "J")});
    }
    if (rows.empty()) return "<h3>Faces of the box</h3><p class=\"soft\">No heat passes them.</p>";
    return "<h3>Faces of the box</h3><table>" +
           table_row("th", {"face", "heat that leaves, at the end", "in all (negative: comes in)"}) + rows + "</table>";
}

std::string draw_energy(const RunResults& results) {
    if (!results.energy) return {};
    const EnergyBalance& energy = *results.energy;
    constexpr int digits = 6;
    const auto row = [](const char* name, const std::string& value) { return table_row("td", {name, value}); };
    const auto brought = [&](const char* name, double joules) {
        return row(name, is_rounding(joules, energy.size) ? nothing : with_unit(joules, "J"));
    };
    const std::string share = readable(std::abs(energy.relative_error()), 1) + " of the energy";
    const std::string error =
        is_rounding(energy.error(), energy.size) ? "none but rounding" : with_unit(energy.error(), "J", 2);
    return "<h3>Energy of the whole box</h3><table>" +
           row("stored at the start", with_unit(energy.start, "J", digits)) +
           brought("in through faces", energy.faces) + brought("by sources", energy.sources) + brought("at surfaces of bodies", energy.surfaces) +
           brought("to hold regions at their temperature", energy.held) +
           row("stored at the end", with_unit(energy.end, "J", digits)) +
           row("error of the balance", error + ", " + share) + "</table>";
}

/// A chart over the run's time, in the unit that suits its values.
std::string draw(const RunResults& results, std::string title, const std::string& si, std::vector<Series> series) {
    if (series.empty()) return {};
    double size = 0;
    for (const Series& s : series)
        for (const double value : s.values) size = std::max(size, std::abs(value));
    const auto [scale, unit] = unit_for(size, si);
    for (Series& s : series)
        for (double& value : s.values) value *= scale;
    const TimeAxis axis = time_axis(results.time);
    colour_lines(series);
    return draw_chart({std::move(title), unit, axis.values, axis.title, std::move(series)});
}

/// A line for each of the bodies that have something to show; of many, for some.
template <class Values>
std::vector<Series> of_bodies(const std::vector<const BodyResult*>& bodies, Values values) {
    std::vector<Series> all;
    for (const std::size_t i : chosen_lines(bodies.size())) all.push_back({bodies[i]->name, values(*bodies[i])});
    return all;
}

template <class Is>
std::vector<const BodyResult*> bodies_that(const RunResults& results, Is is) {
    std::vector<const BodyResult*> found;
    for (const BodyResult& body : results.bodies)
        if (is(body)) found.push_back(&body);
    return found;
}

std::string whose(const std::vector<const BodyResult*>& bodies) {
    return bodies.size() == 1 ? " of " + bodies.front()->name : "";
}

std::string draw_temperatures(const RunResults& results) {
    const auto warm = bodies_that(results, [](const BodyResult& body) { return !body.mean.empty(); });
    std::string html;
    for (const BodyResult* body : warm)
        if (warm.size() <= own_charts)
            html += draw(results, "Temperature of " + body->name, "K",
                         {{"least", body->coldest}, {"mean", body->mean}, {"most", body->hottest}});
    if (warm.size() <= own_charts) return html;
    html += draw(results, "Mean temperature", "K", of_bodies(warm, [](const BodyResult& body) { return body.mean; }));
    html += draw(results, "Least temperature", "K",
                 of_bodies(warm, [](const BodyResult& body) { return body.coldest; }));
    return html + draw(results, "Largest temperature", "K",
                       of_bodies(warm, [](const BodyResult& body) { return body.hottest; }));
}

std::string draw_heat(const RunResults& results) {
    const auto giving = bodies_that(results, [&](const BodyResult& body) { return passes(results, body.heat_from); });
    const std::string from = giving.size() == 1 ? "Heat from " + giving.front()->name : "Heat from bodies";
    const auto heat_from = [](const BodyResult& body) { return body.heat_from; };
    std::string html = draw(results, from, "W", of_bodies(giving, heat_from));
    std::vector<Series> faces;
    for (const FaceResult& face : results.faces)
        if (passes(results, face.out)) faces.push_back({spoken_face(face.name), face.out});
    const std::string through = faces.size() == 1 ? "Heat out through " + faces.front().name : "Heat out through faces";
    return html + draw(results, through, "W", std::move(faces));
}

std::vector<double> displacement(const BodyResult& body, int axis) {
    std::vector<double> values;
    for (const Vec3& place : body.place) values.push_back(place[axis] - body.start_place[axis]);
    return values;
}

/// Is it more than rounding along the axis?
bool moves_along(const BodyResult& body, int axis) {
    return !is_rounding(most_by_size(displacement(body, axis)), length_scale(body));
}

std::string draw_displacements(const RunResults& results) {
    const auto moving = bodies_that(results, moves);
    std::string html;
    for (const BodyResult* body : moving) {
        if (moving.size() > own_charts) break;
        std::vector<Series> axes;
        for (const int axis : {0, 1, 2})
            if (moves_along(*body, axis)) axes.push_back({std::string(1, "xyz"[axis]), displacement(*body, axis)});
        const std::string along = axes.size() == 1 ? " along " + axes.front().name : "";
        html += draw(results, "Displacement of " + body->name + along, "m", std::move(axes));
    }
    for (const int axis : {0, 1, 2}) {
        const auto along = bodies_that(results, [&](const BodyResult& body) { return moves_along(body, axis); });
        if (moving.size() > own_charts)
            html += draw(results, std::string("Displacement along ") + "xyz"[axis] + whose(along), "m",
                         of_bodies(along, [&](const BodyResult& body) { return displacement(body, axis); }));
    }
    return html;
}

std::string draw_speeds(const RunResults& results) {
    const auto moving = bodies_that(results, moves);
    const auto speeds = [](const BodyResult& body) {
        std::vector<double> all;
        for (const Vec3& velocity : body.velocity) all.push_back(norm(velocity));
        return all;
    };
    return draw(results, "Speed" + whose(moving), "m/s", of_bodies(moving, speeds));
}

std::string draw_stored(const RunResults& results) {
    if (!results.energy) return {};
    std::vector<double> change;
    for (const double joules : results.energy->stored) change.push_back(joules - results.energy->start);
    if (is_rounding(most_by_size(change), results.energy->size)) return {};
    return draw(results, "Energy stored since the start", "J", {{"stored", change}});
}

}  // namespace

std::string draw_results(const RunResults& results, const std::string& pictures) {
    if (results.time.empty()) return {};
    const std::string charts = draw_temperatures(results) + draw_heat(results) + draw_stored(results) +
                               draw_displacements(results) + draw_speeds(results);
    const std::string content =
        draw_bodies(results) + draw_faces(results) + draw_energy(results) +
        (charts.empty() ? "" : "<h3>Over time</h3>" + not_all_lines(results.bodies.size(), "bodies") +
                                   "<div class=\"charts\">" + charts + "</div>") +
        pictures;
    return content.empty() ? "" : "<section><h2>Results</h2>" + content + "</section>\n";
}

}  // namespace kropla
