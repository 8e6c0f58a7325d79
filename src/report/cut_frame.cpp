#include "report/cut_frame.h"

#include <kropla/mesh/prisms.h>
#include "report/svg.h"

#include <algorithm>
#include <array>

namespace kropla {
namespace {

constexpr std::size_t most_polygons = 12000;  // in one picture: keeps the page below some megabytes

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

}  // namespace

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

namespace {

/// Where the pressure is another within a body, at its surface, the body's cells get vertices of their own that have it.
Frame parted_at_liquids(Frame frame) {
    const auto within = std::ranges::find(frame.fields, "pressure_within", &NodalField::name);
    const auto outside = std::ranges::find(frame.fields, "pressure", &NodalField::name);
    if (within == frame.fields.end() || outside == frame.fields.end()) return frame;
    const Array<Vertex, double> inner = within->values, outer = outside->values;
    Array<Vertex, Vertex> copy(inner.size());
    Mesh& mesh = frame.mesh;
    for (Tet t : mesh.tets.indices()) {
        if (!alive(mesh, t) || mesh.region[t].value == 0) continue;
        for (Vertex& v : mesh.tets[t]) {
            if (inner[v] == outer[v]) continue;
            if (!copy[v].exists()) {
                copy[v] = Vertex(mesh.position.size());
                mesh.position.push_back(Vec3(mesh.position[v]));
                mesh.tet_at.push_back(t);
                mesh.layer_at.push_back(Layer{});
                for (NodalField& field : frame.fields) field.values.push_back(double(field.values[v]));
                for (NodalVectorField& field : frame.vectors) field.values.push_back(Vec3(field.values[v]));
                outside->values[copy[v]] = inner[v];
            }
            v = copy[v];
        }
    }
    return frame;
}

}  // namespace

std::vector<CutFrame> read_cuts(const RunFiles& run, const Watch* watch) {
    std::vector<CutFrame> frames;
    for (const SeriesEntry& entry : start_middle_end(run.frames)) {
        heed(watch);
        CutFrame f{.time = entry.time,
                   .frame = parted_at_liquids(read_vtu(run.dir / entry.file, watch)),
                   .spot = {},
                   .plane = {},
                   .cut = {}};
        f.spot = spot_of(f.frame.mesh);
        frames.push_back(std::move(f));
    }
    const int axis = axis_across_path(frames);
    for (CutFrame& f : frames) {
        heed(watch);
        f.plane = plane_across(axis, f.spot.centre);
        f.cut = cut_mesh(f.frame.mesh, f.plane);
    }
    return frames;
}

CutWindow whole(const CutFrame& f) { return narrowed(extent(f.cut), f.cut, {0, 0}, most_polygons); }
CutWindow magnified(const CutFrame& f) {
    return narrowed(around({0, 0}, 2 * f.spot.radius), f.cut, {0, 0}, most_polygons);
}

std::string caption(const CutFrame& f, const CutWindow& window) {
    return "<figcaption>t = " + readable_time(f.time) + "<span class=\"soft\"> · " +
           readable((window.max.x - window.min.x) * 1e3, 3) + " × " +
           readable((window.max.y - window.min.y) * 1e3, 3) + " mm</span></figcaption>";
}

const NodalField* field_named(const CutFrame& f, const std::string& name) {
    const auto found = std::ranges::find(f.frame.fields, name, &NodalField::name);
    return found == f.frame.fields.end() ? nullptr : &*found;
}

}  // namespace kropla
