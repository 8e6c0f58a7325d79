#include "report/ending.h"

#include <kropla/io/vtk.h>
#include "report/picture.h"
#include "report/svg.h"

#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr std::size_t close_view = 150, wide_view = 3000;  // polygons seen

/// The middle of the vertices of the body that is nearest to the place; the place itself without bodies.
Vec3 middle_of_nearest_body(const Mesh& mesh, const Vec3& place) {
    double nearest = std::numeric_limits<double>::infinity();
    Region body = surroundings;
    const auto for_all_corners = [&](auto use) {
        for (const Tet t : mesh.tets.indices())
            for (int corner = 0; corner < 4 && alive(mesh, t); ++corner)
                use(mesh.region[t], mesh.position[mesh.tets[t][static_cast<std::size_t>(corner)]]);
    };
    for_all_corners([&](Region region, const Vec3& x) {
        if (region == surroundings || distance(x, place) >= nearest) return;
        nearest = distance(x, place);
        body = region;
    });
    if (body == surroundings) return place;
    Vec3 sum;
    int count = 0;
    for_all_corners([&](Region region, const Vec3& x) {
        if (region != body) return;
        sum += x;
        ++count;
    });
    return (1.0 / count) * sum;
}

/// The plane through the place that passes nearest to the middle of the body next to it; across y where all
/// do.
CutPlane plane_through(const Mesh& mesh, const Vec3& place) {
    const Vec3 away = middle_of_nearest_body(mesh, place) - place;
    int best = 1;
    for (const int axis : {0, 2})
        if (std::abs(away[axis]) < std::abs(away[best])) best = axis;
    return plane_across(best, place);
}

std::string view(const std::vector<CutPolygon>& cut, std::size_t most) {
    const CutWindow window = narrowed(extent(cut), cut, {0, 0}, most);
    return "<figure class=\"card\">" + draw_cells(cut, window, Point2{0, 0}) + "<figcaption class=\"soft\">" +
           readable((window.max.x - window.min.x) * 1e3, 3) + " × " +
           readable((window.max.y - window.min.y) * 1e3, 3) + " mm</figcaption></figure>";
}

}  // namespace

std::string draw_ending(const RunFiles& run) {
    if (!run.ending || !run.ending->place || !std::filesystem::exists(run.dir / ending_mesh_name)) return {};
    const Vec3& place = *run.ending->place;
    const Mesh mesh = read_vtu(run.dir / ending_mesh_name).mesh;
    const std::vector<CutPolygon> cut = cut_mesh(mesh, plane_through(mesh, place));
    if (cut.empty()) return {};  // a place out of the mesh
    const std::string at = readable(place.x, 5) + ", " + readable(place.y, 5) + ", " + readable(place.z, 5);
    return "<section><h2>Where it ended</h2><p class=\"soft\">The mesh as it was last, cut at (" + at +
           ") m; the ring is around the place.</p><div class=\"pictures\">" + view(cut, close_view) +
           view(cut, wide_view) + "</div></section>\n";
}

}  // namespace kropla
