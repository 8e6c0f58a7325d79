// [contact]: what happens when free bodies come nearer to something than the mesh can resolve.
#include "case/contact.h"

#include "domain/layer_room.h"
#include <kropla/domain/words.h>

#include <fmt/format.h>

#include <algorithm>

namespace kropla {
namespace {

constexpr double reach_in_sizes = 0.5;  // from this gap on, the mesh resolves the flow in it
// The gap by default, beside how far polyhedra stand out of their shapes: a quarter more than that in which a flat tet is as
// bad as the limit, 0.25 sizes for a limit of 10. By measurement (spheres of 1.3 to 5 sizes in radius that come to a
// wall and go along it) R/r is about 7 at most then; at 0.2 sizes it was up to 8.3, at 0.3 less than 6.
constexpr double above_limit = 1.25;

/// The least gap that the layers of prisms take [m]; none: 0.
double least_of_layers(const Case& given) {
    double least = 0;
    for (const Body& body : given.domain.bodies)
        if (body.layer && has_outside(*body.layer)) least = std::max(least, least_gap(*body.layer));
    return least;
}

/// How far the polyhedra of two bodies that may meet stand out, at most [m].
double most_stand_out(const Domain& domain) {
    double most = 0;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body)
        most = std::max(most, outward_shift(domain.bodies[body].shape, asked_size(domain, body)));
    return (domain.bodies.size() > 1 ? 2 : 1) * most;
}

double usual_gap(const Case& given) {
    const Domain& domain = given.domain;
    const bool layered = least_of_layers(given) > 0;
    const double room = doubtful_gap(given.quality.max_aspect_ratio) / (layered ? 1 - share_of_gap : 1);  // beside the prisms
    const double gap = std::max(above_limit * room * domain.size.surface, least_of_layers(given)) + most_stand_out(domain);
    return std::min(gap, reach_in_sizes * domain.size.surface);
}

}  // namespace

void read_contact(const CaseTable& file, Case& given) {
    if (!file.has("contact")) return;
    if (std::ranges::none_of(given.free, [](const auto& free) { return free.has_value(); }))
        file.refuse("contact", "needs a body with motion.kind = \"free\": contacts act on no other");
    for (std::size_t body = 0; body < given.domain.bodies.size(); ++body)
        if (given.domain.bodies[body].shape.surface)
            file.refuse("contact", fmt::format("is known between spheres and ellipsoids, and with faces of the box; {} is bounded by "
                                               "triangles, or reaches through a face", named(given.domain.bodies[body])));
    const CaseTable table = file.table("contact");
    table.allow({"lubrication", "restitution", "gap"});
    ContactOptions options{.gap = usual_gap(given), .reach = reach_in_sizes * given.domain.size.surface};
    if (table.has("lubrication")) options.lubrication = table.truth("lubrication");
    if (options.lubrication && !given.flow->options.regions[0]->viscosity.constant())
        table.refuse("lubrication", "needs flow.region.surroundings.viscosity to be a number; it depends on T, so it must be false");
    if (table.has("restitution")) options.restitution = table.number("restitution");
    if (!(options.restitution >= 0 && options.restitution <= 1)) table.refuse_value("restitution", "must be from 0 to 1");
    if (table.has("gap")) options.gap = table.length("gap");
    if (options.gap > options.reach)
        table.refuse_value("gap", fmt::format("must be at most half of size.surface, {:.4g} m", options.reach));
    if (const double least = least_of_layers(given); options.gap < least + (table.has("gap") ? 0 : most_stand_out(given.domain)))
        table.refuse("gap", fmt::format("{:.4g} m is less than layer.min_gap = {:.4g} m leaves; a smaller min_gap does, as "
                                        "gap may be half of size.surface, {:.4g} m", options.gap, least, options.reach));
    given.contact = options;
}

}  // namespace kropla
