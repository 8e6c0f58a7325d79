#include "app/initial_mesh.h"

#include "adapt/adapt.h"
#include "base/error.h"
#include "generate/generate.h"
#include "mesh/quality.h"

#include <fmt/format.h>

namespace kropla {
namespace {

std::vector<Tet> all_cells(const Mesh& mesh) {
    std::vector<Tet> cells;
    for (const Tet t : mesh.tets.indices()) {
        if (alive(mesh, t)) cells.push_back(t);
    }
    return cells;
}

}  // namespace

Mesh initial_mesh(const Case& it) {
    const AdaptOptions options{.floor = it.quality.max_aspect_ratio, .seed = it.random.seed};
    const Snapshot at = snapshot(it.domain, 0);
    Mesh mesh = generate_mesh(it.domain, it.random.seed);
    improve(mesh, all_cells(mesh), at, options);
    repair(mesh, all_cells(mesh), at, options);
    const QualitySummary quality = summarise_quality(mesh);
    if (quality.max_aspect_ratio <= it.quality.max_aspect_ratio) return compact(mesh).mesh;
    const Vec3 place = centroid(mesh, quality.worst);
    throw FloorError(
        fmt::format("the initial mesh has a cell of aspect ratio {:.3g} at ({:.4g}, {:.4g}, {:.4g}) m, above "
                    "quality.max_aspect_ratio = {}; a smaller size.growth or size.far helps",
                    quality.max_aspect_ratio, place.x, place.y, place.z, it.quality.max_aspect_ratio));
}

}  // namespace kropla
