#include <kropla/step/initial_mesh.h>

#include "adapt/adapt_surface.h"
#include <kropla/adapt/refusal.h>
#include <kropla/domain/solids.h>
#include <kropla/generate/generate.h>
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>
#include <kropla/step/stuck.h>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <limits>
#include <vector>

namespace kropla {
namespace {

/// That the effort allowed was spent, if it was.
std::string spent_on(const Changes& changes) {
    if (changes.given_up == 0) return "";
    return "; the effort allowed was spent: " + std::to_string(changes.treated) + " cells treated, " +
           std::to_string(changes.cut_out) + " cut out";
}

struct Draft {
    Mesh mesh;
    Changes changes;
    QualitySummary quality;
};

/// Where cells are worse than they are to be beside smooth surfaces, triangles of surfaces without a layer are exchanged for
/// others, with the volume within kept, as far as that helps bad cells at them.
void help_surfaces(Draft& made, const Domain& domain, const Snapshot& at, const AdaptOptions& options) {
    constexpr double promised = 6;  // [-] R/r
    constexpr int rounds = 3;       // at most; chosen
    constexpr double gain = 0.95;   // [-] of the worst R/r: a round that leaves more is the last
    std::vector<SurfaceOf> surfaces;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body)
        if (const Body& of = domain.bodies[body]; !of.layer)
            surfaces.push_back({region_of_body(body), of.pinned, keep_edges(of).sharp});
    double worst_before = std::numeric_limits<double>::infinity();
    for (int round = 0; round < rounds; ++round) {
        const std::vector<Tet> all = all_tets(made.mesh);
        const double worst = worst_aspect_ratio(made.mesh, all);
        if (worst <= promised || worst > gain * worst_before) return;
        worst_before = worst;
        heed(options.watch, "improving surfaces", static_cast<double>(round) / rounds);
        Changes changes;
        for (const SurfaceOf& surface : surfaces) changes += improve_surface(made.mesh, surface, all, options);
        if (changes.vertices.empty()) return;
        std::vector<Tet> cells = cells_at(made.mesh, changes.vertices);
        std::ranges::copy_if(changes.cells, std::back_inserter(cells), [&](Tet t) { return alive(made.mesh, t); });
        changes += improve(made.mesh, cells, at, options);
        changes += repair(made.mesh, cells, at, options);
        made.changes += changes;
    }
}

Draft draft(const Domain& domain, std::uint64_t seed, const AdaptOptions& options) {
    const Snapshot at = snapshot(domain, 0);
    Draft made{generate_mesh(domain, seed, options.watch), {}, {}};
    heed(options.watch, "improving cells", 0);
    made.changes = improve(made.mesh, all_tets(made.mesh), at, options);
    made.changes += repair(made.mesh, all_tets(made.mesh), at, options);
    help_surfaces(made, domain, at, options);
    heed(options.watch);
    made.quality = summarise_quality(made.mesh);
    return made;
}

[[noreturn]] void give_up(const Domain& domain, Draft made, double floor) {
    const Vec3 place = centroid(made.mesh, made.quality.worst);
    char fault[80];
    std::snprintf(fault, sizeof fault, "has R/r %.4g, limit %g", made.quality.max_aspect_ratio, floor);
    const Refusal refusal = explained(domain, {fault, made.quality.worst, place, 0, 0, floor}, 0);
    throw StuckError("the initial mesh cannot be made: " + refusal.why + spent_on(made.changes), place,
                     std::move(made.mesh));
}

}  // namespace

Mesh initial_mesh(const Domain& domain, const AdaptOptions& options) {
    constexpr std::uint64_t least_drafts = 3, most_drafts = 8;  // by other random points
    constexpr int few_tets = 200'000;  // in all drafts: as long as it costs little, there may be more than the least
    int tets = 0;
    for (std::uint64_t i = 1;; ++i) {
        Draft made = draft(domain, options.seed + i - 1, options);
        if (made.quality.max_aspect_ratio <= options.floor) return in_spatial_order(made.mesh);
        tets += made.quality.tets;
        if (i == most_drafts || (i >= least_drafts && tets > few_tets)) give_up(domain, std::move(made), options.floor);
    }
}

Mesh initial_mesh(const Domain& domain, std::uint64_t seed) { return initial_mesh(domain, {.seed = seed}); }

}  // namespace kropla
