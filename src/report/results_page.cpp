#include "report/results_page.h"

#include "io/xml.h"
#include "report/chart.h"
#include "report/html.h"
#include "report/svg.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <iterator>
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

/// What the flow does to a body: its largest speed, the force at the end and the largest.
std::vector<std::string> flow_cells(const BodyResult& body) {
    const std::vector<double> forces = sizes(body.force);
    return {moves(body) ? with_unit(most_by_size(sizes(body.velocity)), "m/s", 3) : nothing,
            with_unit(forces.back(), "N", 3), with_unit(most_by_size(forces), "N", 3)};
}

std::string draw_bodies(const RunResults& results) {
    if (results.bodies.empty()) return {};
    const bool warm = !results.bodies.front().mean.empty(), in_a_flow = !results.bodies.front().force.empty();
    std::vector<std::string> head = {"body"};
    if (warm)
        head.insert(head.end(), {"mean temperature, start → end [K]", "least … most [K]", "heat given off",
                                 "at most"});
    head.insert(head.end(), {"centre, at the start", "at the end", "speed at the end"});
    if (in_a_flow) head.insert(head.end(), {"at most", "force of the flow at the end", "at most"});
    head.emplace_back("volume");
    std::string html = "<h3>Bodies</h3><div class=\"wide\"><table>" + table_row("th", head);
    for (const BodyResult& body : results.bodies) {
        std::vector<std::string> cells = {escaped(body.name)};
        if (warm) cells.insert(cells.end(), {temperatures(body), extremes(body)});
        if (warm && passes(results, body.heat_from))
            cells.insert(cells.end(), {with_unit(body.given_off, "J"), with_unit(most_by_size(body.heat_from), "W")});
        else if (warm) cells.insert(cells.end(), {nothing, nothing});
        const double size = length_scale(body);
        cells.insert(cells.end(),
                     {place_with_unit(body.start_place, size), place_with_unit(body.place.back(), size),
                      with_unit(moves(body) ? norm(body.velocity.back()) : 0, "m/s", 3)});
        if (in_a_flow) std::ranges::copy(flow_cells(body), std::back_inserter(cells));
        cells.push_back(volume(body));
        html += table_row("td", cells);
    }
    const char* taken = warm ? "<p class=\"soft\">Heat given off: what is conducted through the surface into the "
                               "surroundings; negative: into the body. What the surface itself sets free or radiates "
                               "is not in it.</p>"
                             : "";
    const char* force =
        in_a_flow ? "<p class=\"soft\">Force of the flow: of pressure, with buoyancy, and of friction; "
                    "without the weight. Speeds are means over a step.</p>"
                  : "";
    const char* first =
        results.start_known ? "" : "<p class=\"soft\">For the start stands the end of the first step.</p>";
    return html + "</table></div>" + taken + force + first;
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
           brought("with material, as volumes change", energy.expansion) +
           row("stored at the end", with_unit(energy.end, "J", digits)) +
           row("error of the balance", error + ", " + share) + "</table>";
}

bool flows_through(const FlowResult& flow, const FaceResult& face) {
    return !is_rounding(most_by_size(face.out), flow.flux_size);
}

/// What flows through the faces; nothing of a closed box.
std::string draw_through_flow(const RunResults& results) {
    if (!results.flow) return {};
    std::string rows;
    for (const FaceResult& face : results.flow->faces) {
        if (!flows_through(*results.flow, face)) continue;
        rows += table_row("td", {spoken_face(face.name), with_unit(face.out.back(), "m^3/s"),
                                 with_unit(face.total, "m^3")});
    }
    if (rows.empty()) return {};
    return "<h3>Flow through faces of the box</h3><table>" +
           table_row("th", {"face", "volume that leaves, at the end", "in all (negative: comes in)"}) + rows +
           "</table>";
}

/// How near free bodies came to what they may touch, and what that did to them.
std::string draw_contacts(const RunResults& results) {
    if (results.contacts.empty()) return {};
    std::string rows;
    for (const BodyResult& body : results.bodies)
        if (!body.gap.empty())
            rows += table_row("td", {escaped(body.name), with_unit(*std::ranges::min_element(body.gap), "m"),
                                     with_unit(body.gap.back(), "m"),
                                     with_unit(most_by_size(sizes(body.contact_force)), "N", 3)});
    const auto first = std::ranges::find_if(results.contacts, [](double touches) { return touches > 0; });
    std::string touched = "Nothing touched.";
    if (first != results.contacts.end())
        touched = "The first touch is in the step that ends at " +
                  with_unit(results.time[static_cast<std::size_t>(first - results.contacts.begin())], "s") +
                  "; there are touches in " +
                  std::to_string(std::ranges::count_if(results.contacts, [](double touches) { return touches > 0; })) +
                  " of " + std::to_string(results.contacts.size()) + " steps.";
    return "<h3>Contacts</h3><table>" +
           table_row("th", {"body", "least gap to a wall or another", "at the end", "force of contacts, at most"}) + rows +
           "</table><p class=\"soft\">" + touched + " Their force is that of touches and of lubrication in narrow gaps.</p>";
}

/// Of what flows, what is missed; in a sound run nothing but rounding.
std::string draw_mass(const RunResults& results) {
    if (!results.flow) return {};
    const FlowResult& flow = *results.flow;
    std::string missed = with_unit(flow.mass_missed, "kg", 2);
    if (flow.mass && *flow.mass > 0) {
        const double share = flow.mass_missed / *flow.mass;
        missed = (is_rounding(share, 1) ? "none but rounding" : missed) + ", " + readable(share, 1) +
                 " of the mass";
    }
    return "<h3>Mass of what flows</h3><table>" +
           (flow.mass ? table_row("td", {"in the box, at the start", with_unit(*flow.mass, "kg")}) : "") +
           table_row("td", {"error of the balance, of all steps together", missed}) + "</table>";
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

/// Is it more than rounding along the axis, and in a flow more than what the mesh makes of zero?
bool moves_along(const BodyResult& body, int axis) {
    if (!body.force.empty()) {
        std::vector<Vec3> moved;
        for (const Vec3& place : body.place) moved.push_back(place - body.start_place);
        if (!std::ranges::count(notable_axes(moved), axis)) return false;
    }
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
    const auto speeds = [](const BodyResult& body) { return sizes(body.velocity); };
    return draw(results, "Speed" + whose(moving), "m/s", of_bodies(moving, speeds));
}

/// A line for each axis along which vectors have more than what the mesh makes of zero.
std::vector<Series> components(const std::vector<Vec3>& vectors) {
    std::vector<Series> series;
    for (const int axis : notable_axes(vectors)) {
        Series& s = series.emplace_back();
        s.name = std::string(1, "xyz"[axis]);
        for (const Vec3& vector : vectors) s.values.push_back(vector[axis]);
    }
    return series;
}

/// "Force on ball along z" and its line, or one for each axis that counts.
std::string draw_components(const RunResults& results, const std::string& what, const char* around,
                            const char* si, const std::vector<Vec3>& vectors) {
    std::vector<Series> axes = components(vectors);
    const std::string along = axes.size() == 1 ? around + axes.front().name : "";
    return draw(results, what + along, si, std::move(axes));
}

/// What the flow does to bodies: of a few their velocity, where it is not along one axis, force and spin; of
/// many the sizes.
std::string draw_flow_around_bodies(const RunResults& results) {
    const auto around = bodies_that(results, [](const BodyResult& body) { return !body.force.empty(); });
    const auto turning = bodies_that(results, [](const BodyResult& body) { return turns(body); });
    if (around.size() > own_charts)
        return draw(results, "Size of the force of the flow", "N",
                    of_bodies(around, [](const BodyResult& body) { return sizes(body.force); })) +
               draw(results, "Spin" + whose(turning), "rad/s",
                    of_bodies(turning, [](const BodyResult& body) { return sizes(body.spin); }));
    std::string html;
    for (const BodyResult* body : around) {
        if (moves(*body) && notable_axes(body->velocity).size() > 1)
            html += draw_components(results, "Velocity of " + body->name, " along ", "m/s", body->velocity);
        html += draw_components(results, "Force of the flow on " + body->name, " along ", "N", body->force);
        if (turns(*body))
            html += draw_components(results, "Spin of " + body->name, " about ", "rad/s", body->spin);
    }
    return html;
}

/// Of a few bodies that may touch something the gap and the force, of many the gap.
std::string draw_touching_bodies(const RunResults& results) {
    const auto touching = bodies_that(results, [](const BodyResult& body) { return !body.gap.empty(); });
    std::string html = draw(results, "Gap to what is nearest" + whose(touching), "m",
                            of_bodies(touching, [](const BodyResult& body) { return body.gap; }));
    for (const BodyResult* body : touching)
        if (touching.size() <= own_charts && most_by_size(sizes(body->contact_force)) > 0)
            html += draw_components(results, "Force of contacts on " + body->name, " along ", "N", body->contact_force);
    return html;
}

std::string draw_flow_through_faces(const RunResults& results) {
    std::vector<Series> faces;
    if (results.flow)
        for (const FaceResult& face : results.flow->faces)
            if (flows_through(*results.flow, face)) faces.push_back({spoken_face(face.name), face.out});
    const std::string through =
        faces.size() == 1 ? "Flow out through " + faces.front().name : "Flow out through faces";
    return draw(results, through, "m^3/s", std::move(faces));
}

/// Said where lines may be left out.
std::string left_out(const RunResults& results) {
    if (!results.flow) return {};
    return "<p class=\"soft\">Components and spins below " + readable(100 * notable_share) +
           " % of what they belong to are what the mesh makes of zero, and are not drawn.</p>";
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
                               draw_displacements(results) + draw_speeds(results) +
                               draw_flow_around_bodies(results) + draw_touching_bodies(results) + draw_flow_through_faces(results);
    const std::string content =
        draw_bodies(results) + draw_faces(results) + draw_through_flow(results) + draw_energy(results) +
        draw_mass(results) + draw_contacts(results) +
        (charts.empty() ? ""
                        : "<h3>Over time</h3>" + not_all_lines(results.bodies.size(), "bodies") +
                              left_out(results) + "<div class=\"charts\">" + charts + "</div>") +
        pictures;
    return content.empty() ? "" : "<section><h2>Results</h2>" + content + "</section>\n";
}

}  // namespace kropla
