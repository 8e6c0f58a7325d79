#include "app/initial_mesh.h"

#include "adapt/refusal.h"
#include "app/ending.h"
#include "generate/generate.h"
#include "mesh/quality.h"

#include <fmt/format.h>

namespace kropla {
namespace {

/// That the effort allowed was spent, if it was.
std::string spent_on(const Changes& changes) {
    if (changes.given_up == 0) return "";
    return fmt::format("; the effort allowed was spent: {} cells treated, {} cut out", changes.treated, changes.cut_out);
}

}  // namespace

AdaptOptions adapt_options(const Case& it, const Watch* watch) {
    return {.floor = it.quality.max_aspect_ratio, .seed = it.random.seed, .watch = watch};
}

Mesh initial_mesh(const Case& it, const Watch* watch) {
    const AdaptOptions options = adapt_options(it, watch);
    const Snapshot at = snapshot(it.domain, 0);
    Mesh mesh = generate_mesh(it.domain, it.random.seed, watch);
    heed(watch, "improving cells", 0);
    Changes changes = improve(mesh, all_tets(mesh), at, options);
    changes += repair(mesh, all_tets(mesh), at, options);
    heed(watch);
    const QualitySummary quality = summarise_quality(mesh);
    if (quality.max_aspect_ratio <= it.quality.max_aspect_ratio) return in_spatial_order(mesh);
    const Vec3 place = centroid(mesh, quality.worst);
    const std::string fault =
        fmt::format("has R/r {:.4g}, limit {}", quality.max_aspect_ratio, it.quality.max_aspect_ratio);
    const Refusal refusal =
        explained(it.domain, {fault, quality.worst, place, 0, 0, it.quality.max_aspect_ratio}, 0);
    throw StuckError("the initial mesh cannot be made: " + refusal.why + spent_on(changes), place, std::move(mesh));
}

}  // namespace kropla
