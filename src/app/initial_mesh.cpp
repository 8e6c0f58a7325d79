#include "app/initial_mesh.h"

#include "base/error.h"
#include "generate/generate.h"
#include "mesh/quality.h"

#include <fmt/format.h>


namespace kropla {
namespace {

constexpr int path_samples_per_step = 8;  // a body may not slip through another between two looks

/// That the effort allowed was spent, if it was.
std::string spent_on(const Changes& changes) {
    if (changes.given_up == 0) return "";
    return fmt::format("; the effort allowed was spent: {} cells treated, {} cut out", changes.treated, changes.cut_out);
}

}  // namespace

AdaptOptions adapt_options(const Case& it, const Watch* watch) {
    return {.floor = it.quality.max_aspect_ratio, .seed = it.random.seed, .watch = watch};
}

void check_all_paths(const Case& it, const Watch* watch) {
    check_paths(it.domain, 0, it.time.end, path_samples_per_step * it.time.steps + 1, watch);
}

Mesh initial_mesh(const Case& it, const Watch* watch) {
    const AdaptOptions options = adapt_options(it, watch);
    const Snapshot at = snapshot(it.domain, 0);
    Mesh mesh = generate_mesh(it.domain, it.random.seed, watch);
    heed(watch, "improving cells", 0);
    Changes changes = improve(mesh, all_tets(mesh), at, options);
    changes += repair(mesh, all_tets(mesh), at, options);
    const QualitySummary quality = summarise_quality(mesh);
    if (quality.max_aspect_ratio <= it.quality.max_aspect_ratio) return in_spatial_order(mesh);
    const Vec3 place = centroid(mesh, quality.worst);
    throw FloorError(
        fmt::format("the initial mesh has a cell of aspect ratio {:.3g} at ({:.4g}, {:.4g}, {:.4g}) m, above "
                    "quality.max_aspect_ratio = {}{}; a smaller size.growth or size.far helps",
                    quality.max_aspect_ratio, place.x, place.y, place.z, it.quality.max_aspect_ratio,
                    spent_on(changes)));
}

}  // namespace kropla
