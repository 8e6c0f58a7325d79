#include <kropla/adapt/refusal.h>

#include "adapt/constants.h"
#include "domain/approach.h"

#include <cmath>
#include <optional>

namespace kropla {
namespace {

std::string cell_words(const Trouble& trouble) {
    const std::string cell = trouble.cell.exists() ? "cell " + std::to_string(trouble.cell.value) : "a prism";
    return cell + " at " + place_words(trouble.place) + ' ' + trouble.fault;
}

std::string in_gap(const Domain& domain, const Approach& near, const Trouble& trouble) {
    if (near.gap == 0) return in_words(domain, near) + ": no room is left for the mesh";
    const double size = domain.size.surface,
                 would_do = size_for_gap(domain, near, doubtful_gap(trouble.floor));
    return in_words(domain, near) + ", " + written(near.gap / size) + " of size.surface = " + metres(size) +
           ": too narrow for the mesh; " +
           (would_do < size ? "at most " + metres(rounded_down(would_do)) + " would do"
                            : "a smaller one may do");
}

/// How thick a shape is, or how wide what it leaves open, at its narrowest near a place.
struct Narrow {
    double across = infinity;  // [m]
    bool inside = true;
    Vec3 at;
};
/// Seen from the place, and from the six as far from it as `reach` along the axes. Nothing that is not below `most`.
std::optional<Narrow> narrowest_near(const Shape& shape, const Vec3& place, double reach, double most) {
    std::optional<Narrow> found;
    for (int way = 0; way < 7; ++way) {
        Vec3 from = place;
        if (way > 0) from[(way - 1) / 2] += way % 2 == 0 ? reach : -reach;
        for (const bool inside : {true, false})
            if (const double across = neck_at(shape, from, inside, most); across < (found ? found->across : most))
                found = {across, inside, closest_point(shape, from)};
    }
    return found;
}

/// A body that is thinner there than the least size resolves, or leaves open less. Empty where it is not.
std::string in_thin_place(const Snapshot& at, const Body& body, std::size_t number, const Trouble& trouble) {
    const Shape& shape = at.shapes[number];
    const double least = least_size(at.size);
    if (surface_size(at, number, trouble.place) > least) return "";
    const auto thin = narrowest_near(shape, trouble.place, least, least / gap_share);
    if (!thin) return "";
    return named(body) + (thin->inside ? " is " + metres(thin->across) + " thick" : " leaves open " + metres(thin->across)) +
           " at " + place_words(thin->at) + ", " + written(thin->across / least) + " of size.least = " + metres(least) +
           ": too thin for the mesh; at most " + metres(rounded_down(gap_share * thin->across)) + " would do";
}

/// A neck of a body that deforms, or a notch, as narrow as a size or two. Empty where there is none.
std::string in_neck(const Snapshot& at, const Body& body, std::size_t number, const Trouble& trouble) {
    if (!body.deformation) return in_thin_place(at, body, number, trouble);
    const Shape& shape = at.shapes[number];
    const double size = surface_size(at, number, trouble.place);
    const auto neck = narrowest_near(shape, trouble.place, least_size(at.size), narrow_neck_in_sizes * size);
    if (!neck) return "";
    return named(body) + (neck->inside ? " has a neck, " : " has a notch, ") + metres(neck->across) + " across, at " +
           place_words(neck->at) + ", " + written(neck->across / size) + " of the size = " + metres(size) +
           " of its triangles: too narrow for the mesh; a smaller size may do";
}

std::string in_motion(const Domain& domain, std::size_t body, const Trouble& trouble) {
    const Body& moves = domain.bodies[body];
    const std::string help = moves.size ? "; a smaller size of the body, " + metres(*moves.size) + " now, or size.growth may help"
                                        : "; a smaller size.surface or size.growth may help";
    const std::string by_layer =
        moves.deformation && moves.layer ? "; the triangles under a layer stay, without one they would be adapted" : "";
    if (trouble.time == trouble.start) return "the mesh near " + named(moves) + " is not good enough" + help;
    const double way = moves.deformation
                           ? distance(trouble.place, moves.deformation(trouble.place, trouble.start, trouble.time))
                           : way_between(moves.shape, moves.motion(trouble.start), moves.motion(trouble.time));
    return "the mesh near " + named(moves) + " does not follow it, which moves by " + metres(way) + ", " +
           written(way / domain.size.surface) + " of size.surface, within " +
           time_words(trouble.time - trouble.start) + help + by_layer;
}

}  // namespace

Refusal explained(const Domain& domain, const Trouble& trouble, double advised_dt) {
    Refusal refusal{{}, trouble.cell, advised_dt, trouble.place, trouble.time, {}};
    const Snapshot at = snapshot(domain, trouble.time);
    refusal.near = approach_at(at, trouble.place, trouble.time);
    std::string what = "the mesh is not good enough";
    if (refusal.near) {
        const Approach& near = *refusal.near;
        const bool is_gap = (near.gap > 0 || !domain.bodies[near.body].shape.cut) &&  // what is cut meets the wall anyway
                            width_at(at, near, trouble.place) < narrow_in_sizes * target_size(at, trouble.place);
        refusal.in_gap = is_gap;
        what = is_gap ? in_gap(domain, near, trouble) : in_neck(at, domain.bodies[near.body], near.body, trouble);
        if (what.empty()) what = in_motion(domain, near.body, trouble);
    }
    refusal.why = "at t = " + time_words(trouble.time) + ' ' + what + " (" + cell_words(trouble) + ')';
    return refusal;
}

double time_until_gap(const Domain& domain, const Approach& approach, double start, double end,
                      double least) {
    if (gap_at(domain, approach, end) >= least) return end - start;
    if (gap_at(domain, approach, start) < least) return 0;
    double allowed = start, too_late = end;
    for (int halving = 0; halving < 50; ++halving) {
        const double middle = (allowed + too_late) / 2;
        (gap_at(domain, approach, middle) >= least ? allowed : too_late) = middle;
    }
    return allowed - start;
}

}  // namespace kropla
