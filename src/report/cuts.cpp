#include "report/cuts.h"

#include "io/xml.h"
#include "report/cut_frame.h"
#include "report/flow_cuts.h"
#include "report/surface_picture.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace kropla {
namespace {

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

/// The first field of the run, in one range of colours for all frames; empty without fields, or if it is of a
/// flow.
std::string field_rows(const std::vector<CutFrame>& frames, const Watch* watch) {
    if (frames.front().frame.fields.empty() || frames.front().frame.fields.front().name == pressure_name)
        return {};
    const std::string name = frames.front().frame.fields.front().name,
                      unit = frames.front().frame.fields.front().unit;
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const CutFrame& f : frames) {
        const NodalField* field = field_named(f, name);
        if (field == nullptr) return {};
        for (const CutPolygon& polygon : f.cut) {
            for (const CutCorner& corner : corners(polygon)) {
                least = std::min(least, value_at(corner, field->values));
                most = std::max(most, value_at(corner, field->values));
            }
        }
    }
    const ColourScale colours = scale_over(least, most);
    const auto draw = [&](const CutFrame& f, const CutWindow& window) {
        heed(watch);
        return draw_field(f.cut, field_named(f, name)->values, colours, window);
    };
    const std::string title = escaped(name + (unit.empty() ? "" : " [" + unit + "]"));
    const std::string heading = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0]))) + title.substr(1);
    return row(heading + ", cut", frames, whole, draw) + draw_colour_bar(title, colours);
}

/// Does a body of the run deform? By the plain form in which a run writes its case.
bool has_deforming_bodies(const RunFiles& run) {
    return run.case_text.find("\nkind = \"field\"\n") != std::string::npos ||
           run.case_text.find("\nkind = \"flow\"\n") != std::string::npos;
}

/// The bodies' surfaces in space, all frames at one scale.
std::string surface_row(const std::vector<CutFrame>& frames, const Watch* watch) {
    constexpr std::size_t most_triangles = 12000;  // in one picture: keeps the page below some megabytes
    std::vector<std::vector<SurfaceTriangle>> surfaces;
    std::vector<SurfaceTriangle> all;
    for (const CutFrame& f : frames) {
        const auto& here = surfaces.emplace_back(surface_triangles(f.frame.mesh));
        all.insert(all.end(), here.begin(), here.end());
        if (count_seen(here) > most_triangles)
            return "<p class=\"soft\">Surfaces of bodies are not drawn in space: they have too many triangles.</p>";
    }
    if (all.empty()) return {};
    const CutWindow window = extent_in_space(all);
    const auto draw = [&](const CutFrame& f, const CutWindow& seen) {
        heed(watch);
        return draw_surfaces(surfaces[static_cast<std::size_t>(&f - frames.data())], seen);
    };
    return row("Surfaces of the bodies, in space", frames, [&](const CutFrame&) { return window; }, draw);
}

}  // namespace

CutPictures draw_cuts(const RunFiles& run, const Watch* watch) {
    if (run.frames.empty()) return {};
    const std::vector<CutFrame> frames = read_cuts(run, watch);
    const char* axis = axis_names[static_cast<std::size_t>(axis_across_path(frames))];
    const auto cells = [&](const CutFrame& f, const CutWindow& window) {
        heed(watch);
        return draw_cells(f.cut, window);
    };
    std::string html = std::string("<p class=\"soft\">Cut: every cell that the plane across the ") + axis +
                       " axis through the first body's centre cuts.</p>";
    html += row("Whole domain", frames, whole, cells);
    if (frames.front().spot.radius > 0) html += row("Around the first body", frames, magnified, cells);
    if (has_deforming_bodies(run)) html = surface_row(frames, watch) + html;
    return {html, field_rows(frames, watch) + draw_flow_cuts(run, frames, watch)};
}

}  // namespace kropla
