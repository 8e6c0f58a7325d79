#include "app/first_mesh.h"

#include "app/fault.h"
#include "app/step.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/quality.h>
#include <kropla/step/improve_mesh.h>
#include <kropla/step/initial_mesh.h>
#include <kropla/step/stuck.h>

#include <fmt/format.h>

namespace kropla {

Mesh first_mesh(const Case& given, const Watch* watch) {
    const AdaptOptions options = adapt_options(given, watch);
    if (!given.mesh) return initial_mesh(given.domain, options);
    Mesh mesh = *given.mesh->mesh;
    heed(watch, "improving cells", 0);
    (void)improve_mesh(mesh, options);
    const QualitySummary quality = summarise_quality(mesh);
    if (quality.max_aspect_ratio <= options.floor) return in_spatial_order(mesh);
    const Vec3 place = centroid(mesh, quality.worst);
    const std::string why = fmt::format(
        "domain.mesh = {}: a cell at {} has R/r {:.4g}, limit {:g}, and cannot be improved with the surfaces kept as they are",
        given.mesh->file, place_of(mesh, quality.worst), quality.max_aspect_ratio, options.floor);
    throw StuckError(why, place, std::move(mesh));
}

}  // namespace kropla
