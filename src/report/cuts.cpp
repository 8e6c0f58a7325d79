#include "report/cuts.h"

#include <kropla/io/vtk.h>
#include <kropla/mesh/prisms.h>
#include "io/xml.h"
#include "report/picture.h"
#include "report/svg.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>

namespace kropla {
namespace {

constexpr std::size_t most_polygons = 12000;  // in one picture: keeps the page below some megabytes
constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

/// Where the first body is; without one, the middle of the mesh.
struct Spot {
    Vec3 centre;    // [m]
    double radius;  // [m] half the body's greatest extent; 0 without a body
};

/// A frame, ready to be drawn.
struct CutFrame {
    double time;
    Frame frame;
    Spot spot;
    std::vector<CutPolygon> cut;
};

struct Bounds3 {
    Vec3 min = {1, 1, 1}, max = {-1, -1, -1};  // min above max: empty
    void include(const Vec3& p) {
        const bool first = min.x > max.x;
        for (int axis = 0; axis < 3; ++axis) {
            min[axis] = first ? p[axis] : std::min(min[axis], p[axis]);
            max[axis] = first ? p[axis] : std::max(max[axis], p[axis]);
        }
    }
    [[nodiscard]] bool empty() const { return min.x > max.x; }
};

Spot spot_of(const Mesh& mesh) {
    Bounds3 body, all;
    const auto include = [&](Vertex v, Region region) {
        all.include(mesh.position[v]);
        if (region == Region(1)) body.include(mesh.position[v]);
    };
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4 && alive(mesh, t); ++corner)
            include(mesh.tets[t][static_cast<std::size_t>(corner)], mesh.region[t]);
    for (const Prism& prism : all_prisms(mesh))
        for (const Vertex v : prism_vertices(mesh, prism)) include(v, layer_of(mesh, prism.layer).region);
    if (body.empty()) return {0.5 * (all.min + all.max), 0};
    const Vec3 extent = body.max - body.min;
    return {0.5 * (body.min + body.max), 0.5 * std::max({extent.x, extent.y, extent.z})};
}

/// First, middle and last; fewer, if there are fewer.
std::vector<SeriesEntry> start_middle_end(const std::vector<SeriesEntry>& frames) {
    if (frames.size() <= 3) return frames;
    return {frames.front(), frames[(frames.size() - 1) / 2], frames.back()};
}

/// The axis along which the body moves least; y, unless another is clearly better.
int axis_across_path(const std::vector<CutFrame>& frames) {
    Bounds3 path;
    for (const CutFrame& f : frames) path.include(f.spot.centre);
    const Vec3 moved = path.max - path.min;
    const double clearly = 0.01 * norm(moved);
    int best = 1;
    for (const int axis : {0, 2}) {
        if (moved[axis] < moved[best] - clearly) best = axis;
    }
    return best;
}

std::vector<CutFrame> read_cuts(const RunFiles& run, const Watch* watch) {
    std::vector<CutFrame> frames;
    for (const SeriesEntry& entry : start_middle_end(run.frames)) {
        heed(watch);
        CutFrame f{.time = entry.time, .frame = read_vtu(run.dir / entry.file, watch), .spot = {}, .cut = {}};
        f.spot = spot_of(f.frame.mesh);
        frames.push_back(std::move(f));
    }
    const int axis = axis_across_path(frames);
    for (CutFrame& f : frames) {
        heed(watch);
        f.cut = cut_mesh(f.frame.mesh, plane_across(axis, f.spot.centre));
    }
    return frames;
}

/// Coordinates on the cut have their origin at the body's centre.
CutWindow whole(const CutFrame& f) { return narrowed(extent(f.cut), f.cut, {0, 0}, most_polygons); }
CutWindow magnified(const CutFrame& f) {
    return narrowed(around({0, 0}, 2 * f.spot.radius), f.cut, {0, 0}, most_polygons);
}

std::string caption(const CutFrame& f, const CutWindow& window) {
    return "<figcaption>t = " + readable_time(f.time) + "<span class=\"soft\"> · " +
           readable((window.max.x - window.min.x) * 1e3, 3) + " × " +
           readable((window.max.y - window.min.y) * 1e3, 3) + " mm</span></figcaption>";
}

/// A row of pictures, one per frame; `draw` makes the SVG of a frame in a window, `window` chooses it.
template <class Window, class Draw>
std::string row(const std::string& title, const std::vector<CutFrame>& frames, Window window, Draw draw) {
    std::string html = "<h3>" + title + "</h3><div class=\"pictures\">";
    for (const CutFrame& f : frames) {
        const CutWindow seen = window(f);
        html += "<figure class=\"card\">" + draw(f, seen) + caption(f, seen) + "</figure>";
    }
    return html + "</div>";
}

const NodalField* field_named(const CutFrame& f, const std::string& name) {
    const auto found = std::ranges::find(f.frame.fields, name, &NodalField::name);
    return found == f.frame.fields.end() ? nullptr : &*found;
}

/// The first field of the run, in one range of colours for all frames; empty without fields.
std::string field_rows(const std::vector<CutFrame>& frames, const Watch* watch) {
    if (frames.front().frame.fields.empty()) return {};
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
    if (!(least < most)) most = least + std::max(1e-6 * std::abs(least), 1e-12);
    const auto draw = [&](const CutFrame& f, const CutWindow& window) {
        heed(watch);
        return draw_field(f.cut, field_named(f, name)->values, least, most, window);
    };
    const std::string title = escaped(name + (unit.empty() ? "" : " [" + unit + "]"));
    const std::string heading = static_cast<char>(std::toupper(static_cast<unsigned char>(title[0]))) + title.substr(1);
    return row(heading + ", cut", frames, whole, draw) + draw_colour_bar(title, least, most);
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
    return {html, field_rows(frames, watch)};
}

}  // namespace kropla
