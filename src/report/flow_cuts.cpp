#include "report/flow_cuts.h"

#include "report/hydrostatic.h"
#include "report/solids.h"
#include "report/units.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double arrows_across = 15;  // a picture

/// The cells of a cut that flow, and those that do not.
struct Parted {
    std::vector<CutPolygon> flowing, solid;
};

const Array<Vertex, Vec3>* velocity_of(const CutFrame& f) {
    const auto found = std::ranges::find(f.frame.vectors, velocity_name, &NodalVectorField::name);
    return found == f.frame.vectors.end() ? nullptr : &found->values;
}

bool flows(const CutFrame& f) {
    const auto* velocity = velocity_of(f);
    return velocity && field_named(f, pressure_name) &&
           std::ranges::any_of(*velocity, [](const Vec3& u) { return squared_norm(u) > 0; });
}

Parted parted(const CutFrame& f) {
    const std::vector<bool> solid = solid_regions(f.frame.mesh, field_named(f, pressure_name)->values);
    Parted parts;
    for (const CutPolygon& polygon : f.cut)
        (solid[static_cast<std::size_t>(polygon.region.value)] ? parts.solid : parts.flowing)
            .push_back(polygon);
    return parts;
}

/// Values per frame, and the range of what flows.
struct Shown {
    std::vector<Array<Vertex, double>> values;
    double least = std::numeric_limits<double>::infinity(), most = -least;
};

/// `value` of a frame and a vertex.
template <class Value>
Shown shown(std::span<const CutFrame> frames, const std::vector<Parted>& parts, Value value) {
    Shown all;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        Array<Vertex, double>& values = all.values.emplace_back(frames[i].frame.mesh.position.size());
        for (const Vertex v : values.indices()) values[v] = value(frames[i], v);
        for (const CutPolygon& polygon : parts[i].flowing)
            for (const CutCorner& corner : corners(polygon)) {
                all.least = std::min(all.least, value_at(corner, values));
                all.most = std::max(all.most, value_at(corner, values));
            }
    }
    return all;
}

/// In the unit that suits them: its name.
std::string scale(Shown& all, const char* si) {
    const ScaledUnit unit = unit_for(std::max(std::abs(all.least), std::abs(all.most)), si);
    for (auto& values : all.values)
        for (double& value : values) value *= unit.scale;
    all.least *= unit.scale;
    all.most *= unit.scale;
    return unit.name;
}

std::string speed_rows(std::span<const CutFrame> frames, const std::vector<Parted>& parts,
                       const Watch* watch) {
    Shown speed =
        shown(frames, parts, [](const CutFrame& f, Vertex v) { return norm((*velocity_of(f))[v]); });
    speed.least = 0;
    const double most = speed.most;
    const std::string title = "speed [" + scale(speed, "m/s") + "]";
    const ColourScale colours = scale_over(speed.least, speed.most, light_blues);
    const auto draw = [&](const CutFrame& f, const CutWindow& window) {
        heed(watch);
        const auto i = static_cast<std::size_t>(&f - frames.data());
        const ArrowOptions options{
            .spacing = (window.max.x - window.min.x) / arrows_across, .most = most, .window = window};
        return draw_flow(parts[i].flowing, speed.values[i], colours, window, parts[i].solid,
                         arrows(parts[i].flowing, parts[i].solid, f.plane, *velocity_of(f), options));
    };
    const bool has_body = frames.front().spot.radius > 0;
    return row("S" + title.substr(1) + ", cut", frames, whole, draw) +
           (has_body ? row("S" + title.substr(1) + ", around the first body", frames, magnified, draw) : "") +
           draw_colour_bar(title, colours) +
           "<p class=\"soft\">Arrows: the velocity within the plane of the cut. Their lengths go with the "
           "root of it, so that slow flow is seen too.</p>";
}

std::string pressure_rows(const RunFiles& run, std::span<const CutFrame> frames,
                          const std::vector<Parted>& parts, const Watch* watch) {
    const Hydrostatic at_rest = hydrostatic(run.case_text);
    Shown pressure = shown(frames, parts, [&](const CutFrame& f, Vertex v) {
        return field_named(f, pressure_name)->values[v] - pressure_at(at_rest, f.frame.mesh.position[v]);
    });
    const std::string unit = "[" + scale(pressure, "Pa") + "]";
    const std::string title = (is_there(at_rest) ? "pressure less that at rest " : "pressure ") + unit;
    const ColourScale colours = signed_scale(pressure.least, pressure.most);
    const auto draw = [&](const CutFrame& f, const CutWindow& window) {
        heed(watch);
        const auto i = static_cast<std::size_t>(&f - frames.data());
        return draw_flow(parts[i].flowing, pressure.values[i], colours, window, parts[i].solid, {});
    };
    const char* note = is_there(at_rest)
                           ? "<p class=\"soft\">Pressure less that at rest: without what the weight of what "
                             "flows makes, measured from half the height of the box.</p>"
                           : "";
    return row("P" + title.substr(1) + ", cut", frames, whole, draw) + draw_colour_bar(title, colours) + note;
}

}  // namespace

std::string draw_flow_cuts(const RunFiles& run, std::span<const CutFrame> frames, const Watch* watch) {
    while (!frames.empty() && !flows(frames.front())) frames = frames.subspan(1);
    if (frames.empty() || !std::ranges::all_of(frames, flows)) return {};
    std::vector<Parted> parts;
    for (const CutFrame& f : frames) parts.push_back(parted(f));
    return speed_rows(frames, parts, watch) + pressure_rows(run, frames, parts, watch);
}

}  // namespace kropla
